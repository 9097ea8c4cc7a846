#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "path_cases.hpp"

namespace takt::planner {
namespace {

using test::axisLimits;
using test::PathCase;
using test::Random;
using test::Trace;
using test::Use;

/// What the axes do when `next` takes over from `running` in a cycle.
Trace spliced(const PathMotion& running, std::uint64_t cycle, const PathMotion& next) {
    Trace trace;
    for (int k = 0; k < 3; ++k) trace.add(running.geometry, running.feed.at(0).s);
    for (std::uint64_t k = 0; k < cycle; ++k) trace.add(running.geometry, running.feed.at(k).s);
    const double shift = running.feed.at(cycle).s - next.feed.at(0).s;
    for (std::uint64_t k = 0; k <= next.feed.cycles() + 3; ++k)
        trace.add(next.geometry, next.feed.at(k).s, shift);
    return trace;
}

TEST(PathExtension, RoundsACornerThatWasPlannedAsAStop) {
    const std::vector<PathAxisLimits> limits(2, axisLimits(100.0, 2000.0, 50000.0));
    PathPlanner planner{{2, 2}, limits, core::Seconds{0.001}};
    const Transition corner{TransitionMode::CornerDeviation, core::Distance{0.1}};
    const auto laps = test::squareLaps({2, 2}, 20.0, 1, corner, 100.0);
    PathMotion running = planner.motion();
    PathMotion next = planner.motion();
    ASSERT_TRUE(planner.plan(std::span{laps}.first(1), running).ok());
    const std::uint64_t alone = running.feed.cycles();
    ASSERT_TRUE(planner.extend(running, 100, std::span{laps}.subspan(1, 1), next).ok());
    EXPECT_EQ(next.geometry.piece(1).isBlend(), true);
    EXPECT_LT(100 + next.feed.cycles(), 2 * alone);
    EXPECT_LE(test::useOf(spliced(running, 100, next), limits, 0.001).most(), 1.0 + 1e-6);
}

TEST(PathExtension, KeepsTheStopWhereTheNextElementComesTooLate) {
    const std::vector<PathAxisLimits> limits(2, axisLimits(100.0, 2000.0, 50000.0));
    PathPlanner planner{{2, 2}, limits, core::Seconds{0.001}};
    const Transition corner{TransitionMode::CornerDeviation, core::Distance{0.1}};
    const auto laps = test::squareLaps({2, 2}, 20.0, 1, corner, 100.0);
    PathMotion running = planner.motion();
    PathMotion next = planner.motion();
    ASSERT_TRUE(planner.plan(std::span{laps}.first(1), running).ok());
    const std::uint64_t late = running.feed.cycles() - 2;
    ASSERT_TRUE(planner.extend(running, late, std::span{laps}.subspan(1, 1), next).ok());
    EXPECT_LE(test::useOf(spliced(running, late, next), limits, 0.001).most(), 1.0 + 1e-6);
    EXPECT_EQ(next.geometry.elementCount(), 2U);
}

TEST(PathExtension, BeginsInTheStateOfTheRunningMotion) {
    const std::vector<PathAxisLimits> limits(2, axisLimits(100.0, 2000.0, 50000.0));
    PathPlanner planner{{2, 2}, limits, core::Seconds{0.001}};
    const Transition corner{TransitionMode::CornerDistance, core::Distance{2.0}};
    const auto laps = test::squareLaps({2, 2}, 20.0, 2, corner, 100.0);
    PathMotion running = planner.motion();
    PathMotion next = planner.motion();
    ASSERT_TRUE(planner.plan(std::span{laps}.first(4), running).ok());
    for (std::uint64_t k = 0; k < running.feed.cycles(); k += 37) {
        ASSERT_TRUE(planner.extend(running, k, std::span{laps}.subspan(4), next).ok());
        const FeedState before = running.feed.at(k);
        const FeedState after = next.feed.at(0);
        EXPECT_NEAR(after.s1, before.s1, 1e-9 * (1.0 + before.s1));
        EXPECT_NEAR(after.s2, before.s2, 1e-6);
        PathDerivatives a;
        PathDerivatives b;
        running.geometry.evaluate(before.s, a);
        next.geometry.evaluate(after.s, b);
        EXPECT_NEAR(a.q[0], b.q[0], 1e-12);
        EXPECT_NEAR(a.q[1], b.q[1], 1e-12);
    }
}

TEST(PathExtension, KeepsAllLimitsAtAnyTimeOnAnyPath) {
    int rounded = 0;
    int judged = 0;
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random{seed + 5000};
        const PathCase c = test::randomPath(random, 6);
        PathPlanner planner{c.space, c.limits, core::Seconds{c.cycle}};
        PathMotion running = planner.motion();
        PathMotion next = planner.motion();
        const std::span<const PathElement> all{c.elements};
        ASSERT_TRUE(planner.plan(all.first(3), running).ok());
        if (running.feed.cycles() > 50000) continue;
        const auto k = static_cast<std::uint64_t>(random.uniform() *
                                                  static_cast<double>(running.feed.cycles()));
        const auto result = planner.extend(running, k, all.subspan(3), next);
        ASSERT_TRUE(result.ok()) << describe(result.error());
        const Trace trace = spliced(running, k, next);
        const Use use = test::useOf(trace, c.limits, c.cycle);
        EXPECT_LE(use.most(), 1.0 + 1e-6) << "cycle " << k << " v " << use.velocity << " a "
                                          << use.acceleration << " j " << use.jerk;
        EXPECT_TRUE(use.monotone);
        EXPECT_EQ(next.feed.at(next.feed.cycles()).s, next.geometry.length());
        for (std::size_t i = 0; i < c.space.axes; ++i)
            EXPECT_EQ(trace.rows.back()[i], c.elements.back().to[i].count());
        ++judged;
        rounded += planner.effort().attempts > 0 ? 1 : 0;
    }
    EXPECT_GT(judged, 100);
    EXPECT_GT(rounded, 50);
}

TEST(PathExtension, FollowsALongPathInSmallWindows) {
    const std::vector<PathAxisLimits> limits(2, axisLimits(100.0, 2000.0, 50000.0));
    PathPlanner planner{{2, 2}, limits, core::Seconds{0.001}, 8};
    const Transition corner{TransitionMode::CornerDeviation, core::Distance{0.1}};
    const auto laps = test::squareLaps({2, 2}, 20.0, 5, corner, 100.0);
    const std::span<const PathElement> all{laps};
    PathMotion running = planner.motion();
    PathMotion next = planner.motion();
    ASSERT_TRUE(planner.plan(all.first(4), running).ok());
    Trace trace;
    std::size_t given = 4;
    double shift = 0.0;
    std::uint64_t cycles = 0;
    while (given < all.size()) {
        // The next element comes when the first of those that are known is left.
        std::uint64_t k = 0;
        while (k < running.feed.cycles() && running.geometry.elementAt(running.feed.at(k).s) < 1) {
            trace.add(running.geometry, running.feed.at(k).s, shift);
            ++k;
        }
        ASSERT_TRUE(planner.extend(running, k, all.subspan(given, 1), next).ok());
        shift += running.feed.at(k).s - next.feed.at(0).s;
        std::swap(running, next);
        ++given;
        cycles += k;
    }
    for (std::uint64_t k = 0; k <= running.feed.cycles() + 3; ++k)
        trace.add(running.geometry, running.feed.at(k).s, shift);
    cycles += running.feed.cycles();
    EXPECT_LE(test::useOf(trace, limits, 0.001).most(), 1.0 + 1e-6);
    EXPECT_LE(static_cast<double>(cycles) * 0.001, 5.4);
}

}  // namespace
}  // namespace takt::planner
