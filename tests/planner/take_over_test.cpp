#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <takt/planner/take_over.hpp>

#include "problems.hpp"

namespace takt::planner {
namespace {

using core::Jerk;
using core::Seconds;
using test::limits;
using test::Random;
using test::state;

/// The farthest that a stop goes past the velocity limits, by looking at many instants of it.
double velocityExcess(const State& from, const Limits& l) {
    const Profile stop = planStop(from, l).value();
    double excess = 0.0;
    for (int k = 0; k <= 400; ++k) {
        const double v = sample(stop, stop.duration() * (k / 400.0)).velocity.count();
        excess = std::max({excess, v - l.maxVelocity.count(), l.minVelocity.count() - v});
    }
    return excess;
}

TEST(TakeOver, KeepsTheJerkThatIsEnough) {
    EXPECT_EQ(takeOverJerk(state(0, 1, 2), limits(2, 5, 4), Jerk{100}), Jerk{4});
    EXPECT_EQ(takeOverJerk(state(0, 1, 0), limits(1, 5, 4), Jerk{100}), Jerk{4});
    EXPECT_EQ(takeOverJerk(state(0, 1, -2), limits(1, 5, 4), Jerk{100}), Jerk{4});
}

TEST(TakeOver, RaisesTheJerkToWhatTheVelocityLimitLeaves) {
    // By hand: 2^2 / (2 * 8) = 0.25 of velocity are left.
    EXPECT_EQ(takeOverJerk(state(0, 1.75, 2), limits(2, 5, 4), Jerk{100}), Jerk{8});
    EXPECT_EQ(takeOverJerk(state(0, -1.75, -2), limits(2, 5, 4), Jerk{100}), Jerk{8});
}

TEST(TakeOver, NeverRaisesItPastTheHardest) {
    EXPECT_EQ(takeOverJerk(state(0, 2, 2), limits(2, 5, 4), Jerk{100}), Jerk{100});
    EXPECT_EQ(takeOverJerk(state(0, 3, 2), limits(2, 5, 4), Jerk{100}), Jerk{100});
    EXPECT_EQ(takeOverJerk(state(0, 2, 2), limits(2, 5, 200), Jerk{100}), Jerk{200});
}

TEST(TakeOver, HoldsTheVelocityLimitWithNoMoreJerkThanNeeded) {
    Random random{71};
    int raised = 0;
    for (int i = 0; i < 2000; ++i) {
        const double v = random.uniform(0.5, 5);
        Limits l = limits(v, v * -random.uniform(0.5, 2), 10, -random.uniform(5, 20), 0);
        const double gentle = random.uniform(1, 20);
        const State from =
            state(0, random.uniform(0.99 * l.minVelocity.count(), 0.99 * v), random.uniform(-5, 5));
        l.jerk = Jerk{gentle};
        l.jerk = takeOverJerk(from, l, Jerk{1e9});
        ASSERT_GE(l.jerk.count(), gentle);
        ASSERT_LE(velocityExcess(from, l), 1e-12 * v) << i;
        if (l.jerk.count() == gentle) continue;
        ++raised;
        l.jerk = l.jerk * 0.9;
        ASSERT_GT(velocityExcess(from, l), 0.0) << i;
    }
    EXPECT_GT(raised, 200);
}

}  // namespace
}  // namespace takt::planner
