#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <takt/planner/path_brake.hpp>

#include "path_cases.hpp"

namespace takt::planner {
namespace {

using test::axisLimits;
using test::PathCase;
using test::Random;
using test::Trace;
using test::Use;

struct Stop {
    Trace trace;
    std::uint64_t cycles{0};
    FeedState end;
    bool atRest{false};
};

/// Follows a motion up to a cycle, brakes, and rests for a few cycles.
Stop brakeAt(const PathMotion& motion, std::uint64_t cycle, std::span<const PathAxisLimits> limits,
             const PathFeed& path) {
    Stop stop;
    for (int k = 0; k < 3; ++k) stop.trace.add(motion.geometry, motion.feed.at(0).s);
    for (std::uint64_t k = 0; k <= cycle; ++k) stop.trace.add(motion.geometry, motion.feed.at(k).s);
    PathBrake brake;
    brake.start(motion, cycle, limits, path);
    while (!brake.isAtRest() && stop.cycles < motion.feed.cycles() + 10000) {
        stop.trace.add(motion.geometry, brake.step().s);
        ++stop.cycles;
    }
    stop.end = brake.state();
    stop.atRest = brake.isAtRest();
    for (int k = 0; k < 4; ++k) stop.trace.add(motion.geometry, stop.end.s);
    return stop;
}

class SquareBrake : public ::testing::Test {
protected:
    SquareBrake() {
        const Transition corner{TransitionMode::CornerDeviation, core::Distance{0.1}};
        const auto elements = test::squareLaps({2, 2}, 20.0, 1, corner, 100.0);
        planned_ = planner_.plan(elements, motion_).ok();
    }

    std::vector<PathAxisLimits> limits_{2, axisLimits(100.0, 2000.0, 50000.0)};
    PathPlanner planner_{{2, 2}, limits_, core::Seconds{0.001}};
    PathMotion motion_{planner_.motion()};
    bool planned_{false};
};

TEST_F(SquareBrake, KeepsTheAxisLimitsWhereverItBegins) {
    ASSERT_TRUE(planned_);
    // In the corners, where little room is left, a jerk may be exceeded by a few per cent.
    std::vector<double> worst;
    for (std::uint64_t k = 0; k <= motion_.feed.cycles(); k += 3) {
        const Stop stop = brakeAt(motion_, k, limits_, {});
        ASSERT_TRUE(stop.atRest) << "cycle " << k;
        const Use use = test::useOf(stop.trace, limits_, 0.001);
        worst.push_back(use.most());
        EXPECT_LE(use.most(), 1.1) << "cycle " << k << ": v " << use.velocity << " a "
                                   << use.acceleration << " j " << use.jerk;
        EXPECT_TRUE(use.monotone) << "cycle " << k;
        EXPECT_EQ(stop.end.s1, 0.0);
    }
    std::sort(worst.begin(), worst.end());
    EXPECT_LE(worst[worst.size() * 95 / 100], 1.02);
}

TEST_F(SquareBrake, TakesAboutAsLongAsASeparateStopFromFullSpeedOnALine) {
    ASSERT_TRUE(planned_);
    // In the middle of the first side the speed is near its greatest and nothing is in the way.
    std::uint64_t fast = 0;
    for (std::uint64_t k = 0; k < 250; ++k) {
        if (motion_.feed.at(k).s1 > motion_.feed.at(fast).s1) fast = k;
    }
    const FeedState at = motion_.feed.at(fast);
    const auto best =
        planStop({core::Position{}, core::Velocity{at.s1}, core::Acceleration{at.s2}},
                 {core::Velocity{200.0}, core::Velocity{-200.0}, core::Acceleration{2000.0},
                  core::Acceleration{-2000.0}, core::Jerk{50000.0}});
    ASSERT_TRUE(best.ok());
    const Stop stop = brakeAt(motion_, fast, limits_, {});
    EXPECT_LE(0.001 * static_cast<double>(stop.cycles),
              1.15 * best.value().duration().count() + 0.004);
}

TEST_F(SquareBrake, ObeysALowerDecelerationWhereThePlanDoesNotNeedMore) {
    ASSERT_TRUE(planned_);
    PathFeed gentle;
    gentle.deceleration = core::Acceleration{500.0};
    PathBrake brake;
    brake.start(motion_, 60, limits_, gentle);
    double before = motion_.feed.at(60).s1;
    double most = 0.0;
    while (!brake.isAtRest() && brake.state().s < 15.0) {
        const FeedState now = brake.step();
        most = std::max(most, (before - now.s1) / 0.001);
        before = now.s1;
    }
    EXPECT_TRUE(brake.isAtRest());
    EXPECT_GT(most, 400.0);
    EXPECT_LE(most, 510.0);
}

TEST_F(SquareBrake, DoesNothingAtRest) {
    ASSERT_TRUE(planned_);
    PathBrake brake;
    brake.start(motion_, motion_.feed.cycles(), limits_, {});
    EXPECT_TRUE(brake.isAtRest());
    EXPECT_EQ(brake.step().s, motion_.geometry.length());
}

TEST(PathBrake, StopsAnyPathAtAnyTimeWithinItsLimits) {
    // Where a path turns sharply the brake may exceed a jerk, seldom and by a part of it.
    std::vector<double> worst;
    for (std::uint64_t seed = 1; seed <= 120; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random{seed};
        const PathCase c = test::randomPath(random, 5);
        PathPlanner planner{c.space, c.limits, core::Seconds{c.cycle}};
        PathMotion motion = planner.motion();
        ASSERT_TRUE(planner.plan(c.elements, motion).ok());
        if (motion.feed.cycles() > 60000) continue;
        for (int n = 0; n < 6; ++n) {
            const auto cycle = static_cast<std::uint64_t>(
                random.uniform() * static_cast<double>(motion.feed.cycles()));
            const Stop stop = brakeAt(motion, cycle, c.limits, {});
            ASSERT_TRUE(stop.atRest) << "cycle " << cycle;
            const Use use = test::useOf(stop.trace, c.limits, c.cycle);
            EXPECT_LE(use.most(), 1.35) << "cycle " << cycle << ": v " << use.velocity << " a "
                                        << use.acceleration << " j " << use.jerk;
            EXPECT_TRUE(use.monotone) << "cycle " << cycle;
            worst.push_back(use.most());
            const double late = c.cycle * (static_cast<double>(cycle + stop.cycles) -
                                           static_cast<double>(motion.feed.cycles()));
            EXPECT_LE(late, 0.05) << "cycle " << cycle;
            EXPECT_LE(stop.end.s, motion.geometry.length()) << "cycle " << cycle;
        }
    }
    std::sort(worst.begin(), worst.end());
    ASSERT_GT(worst.size(), 500U);
    EXPECT_LE(worst[worst.size() * 95 / 100], 1.02);
}

TEST(PathBrake, DoesNotPassAStopThatThePlanMakes) {
    const std::vector<PathAxisLimits> limits(2, axisLimits(100.0, 2000.0, 50000.0));
    PathPlanner planner{{2, 2}, limits, core::Seconds{0.001}};
    PathMotion motion = planner.motion();
    const auto elements = test::squareLaps({2, 2}, 20.0, 1, {}, 100.0);
    ASSERT_TRUE(planner.plan(elements, motion).ok());
    PathFeed feeble;
    feeble.deceleration = core::Acceleration{1.0};
    for (std::uint64_t k = 1; k < 280; k += 10) {
        const Stop stop = brakeAt(motion, k, limits, feeble);
        EXPECT_TRUE(stop.atRest);
        EXPECT_LE(stop.end.s, 20.0) << "cycle " << k;
    }
}

}  // namespace
}  // namespace takt::planner
