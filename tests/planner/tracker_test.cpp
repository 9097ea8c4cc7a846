#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <takt/planner/tracker.hpp>

#include "problems.hpp"
#include "reachable.hpp"

namespace takt::planner {
namespace {

using core::Seconds;
using test::Case;
using test::limits;
using test::Random;
using test::reachable;
using test::rest;
using test::state;

constexpr double kCycle = 0.001;

TEST(Tracker, CatchesUpWithARunningMasterAndStaysWithIt) {
    Tracker tracker{limits(2, 4, 40), Seconds{0.001}};
    tracker.reset(state(0, 0, 0));
    int synchronousAt = 0;
    for (int i = 0; i < 5000; ++i) {
        const double t = i * 0.001;
        State set;
        ASSERT_EQ(tracker.step(state(1 + t, 1, 0), set), std::nullopt);
        if (tracker.isSynchronous() && synchronousAt == 0) synchronousAt = i;
        if (synchronousAt != 0) {
            ASSERT_NEAR(set.position.count(), 1 + t + 0.001, 1e-11);
            ASSERT_NEAR(set.velocity.count(), 1, 1e-11);
        }
    }
    // By hand, relative to the master: from -1 at -1 to rest, at most +1 faster.
    EXPECT_GT(synchronousAt, 1500);
    EXPECT_LT(synchronousAt, 2500);
}

TEST(Tracker, FollowsAnAcceleratingMasterWithinItsLimits) {
    Tracker tracker{limits(3, 5, 60), Seconds{0.001}};
    tracker.reset(state(0, 0, 0));
    double a = 0.0;
    for (int i = 0; i < 8000; ++i) {
        const double t = i * 0.001;
        const double w = 1.5;
        State set;
        ASSERT_EQ(tracker.step(
                      state(std::sin(w * t), w * std::cos(w * t), -w * w * std::sin(w * t)), set),
                  std::nullopt);
        ASSERT_LE(std::fabs(set.acceleration.count() - a), 0.06 * (1 + 1e-6)) << i;
        ASSERT_LE(std::fabs(set.velocity.count()), 3 * (1 + 1e-9));
        a = set.acceleration.count();
        if (t < 3) continue;
        // The master's jerk is not known to it.
        ASSERT_NEAR(set.position.count(), std::sin(w * (t + 0.001)), 1e-8);
    }
}

TEST(Tracker, GoesOnAsItDidWhenItsMasterIsNotANumber) {
    Tracker tracker{limits(3, 5, 60), Seconds{kCycle}};
    Tracker other = tracker;
    tracker.reset(state(0, 0, 0));
    other.reset(state(0, 0, 0));
    State set;
    State expected;
    for (int k = 0; k < 300; ++k) {
        const State master = state(1 + k * kCycle, 1, 0);
        ASSERT_EQ(other.step(master, expected), std::nullopt);
        const bool lost = k == 200;
        const auto error = tracker.step(lost ? state(std::nan(""), 1, 0) : master, set);
        ASSERT_EQ(error.has_value(), lost);
        ASSERT_NEAR(set.position.count(), expected.position.count(), 1e-12);
    }
}

/// The state a cycle later, at constant acceleration.
State cycleLater(const State& s) {
    const double v = s.velocity.count();
    const double a = s.acceleration.count();
    return state(s.position.count() + kCycle * (v + 0.5 * a * kCycle), v + a * kCycle, a);
}

TEST(Tracker, CatchesUpInTheLeastTime) {
    Random random{51};
    for (int i = 0; i < 300; ++i) {
        const Limits l = limits(random.uniform(1, 3), random.uniform(2, 8), random.uniform(5, 80));
        const double speed = random.uniform(-0.9, 0.9) * l.maxVelocity.count();
        const double distance = random.uniform(-2, 2);
        const double v0 = random.uniform(-0.5, 0.5) * l.maxVelocity.count();
        Tracker tracker{l, Seconds{kCycle}};
        tracker.reset(state(0, v0, 0));
        State master = state(distance, speed, 0);
        int cycles = 0;
        do {
            State set;
            ASSERT_EQ(tracker.step(master, set), std::nullopt);
            master = cycleLater(master);
            ASSERT_LT(++cycles, 60000);
        } while (!tracker.isSynchronous());
        // Seen from the master: to rest beside it, with what it leaves of the velocities.
        const Case relative{
            state(-distance, v0 - speed, 0), rest(0),
            limits(l.maxVelocity.count() - speed, l.minVelocity.count() - speed,
                   l.maxAcceleration.count(), l.minAcceleration.count(), l.jerk.count())};
        const double duration = cycles * kCycle;
        bool possible = false;
        for (int k = 0; k <= 50 && !possible; ++k) {
            possible = reachable(relative, duration - kCycle * k / 50, 1e-9);
        }
        ASSERT_TRUE(possible) << i;
        for (int k = 1; k <= 10; ++k) {
            const double earlier = (duration - kCycle) * (1 - 1e-6) * k / 10;
            ASSERT_FALSE(earlier > 0 && reachable(relative, earlier, 0)) << i;
        }
    }
}

/// A master that changes its acceleration from time to time and may well be too fast.
TEST(Tracker, KeepsItsLimitsAndSaysSynchronousOnlyWhereItIs) {
    Random random{52};
    int synchronous = 0;
    for (int i = 0; i < 40; ++i) {
        const Limits l = limits(2, 6, 60);
        Tracker tracker{l, Seconds{kCycle}};
        tracker.reset(state(0, 0, 0));
        State master = state(random.uniform(-1, 1), random.uniform(-3, 3), 0);
        double before = 0.0;
        for (int k = 0; k < 6000; ++k) {
            if (k % 500 == 0) {
                const double v = master.velocity.count();
                const double a = std::fabs(v) > 2 ? -2 * v / std::fabs(v) : random.uniform(-3, 3);
                master.acceleration = core::Acceleration{random.chance(0.4) ? 0.0 : a};
            }
            State set;
            ASSERT_EQ(tracker.step(master, set), std::nullopt);
            master = cycleLater(master);
            const double a = set.acceleration.count();
            ASSERT_LE(std::fabs(set.velocity.count()), 2 * (1 + 1e-9)) << i << " " << k;
            ASSERT_LE(std::fabs(a), 6 * (1 + 1e-9));
            ASSERT_LE(std::fabs(a - before), 60 * kCycle * (1 + 1e-6)) << i << " " << k;
            before = a;
            if (!tracker.isSynchronous()) continue;
            ++synchronous;
            ASSERT_NEAR(set.position.count(), master.position.count(), 1e-9);
            ASSERT_NEAR(set.velocity.count(), master.velocity.count(), 1e-9);
        }
    }
    EXPECT_GT(synchronous, 20000);
}

TEST(Tracker, RunsAfterAMasterThatIsTooFastAndCatchesUpWhenItSlowsDown) {
    Tracker tracker{limits(2, 4, 40), Seconds{kCycle}};
    tracker.reset(state(0, 0, 0));
    State master = state(0, 0, 1);  // past 2 after two seconds, back below after six
    for (int k = 0; k < 20000; ++k) {
        if (k == 4000) master.acceleration = core::Acceleration{-1};
        if (k == 7000) master.acceleration = core::Acceleration{0};
        State set;
        ASSERT_EQ(tracker.step(master, set), std::nullopt);
        master = cycleLater(master);
        ASSERT_LE(set.velocity.count(), 2 * (1 + 1e-12)) << k;
        if (k == 1900) {
            EXPECT_TRUE(tracker.isSynchronous());
        }
        if (k > 2000 && k < 6000) {
            ASSERT_FALSE(tracker.isSynchronous()) << k;
        }
    }
    EXPECT_TRUE(tracker.isSynchronous());
}

}  // namespace
}  // namespace takt::planner
