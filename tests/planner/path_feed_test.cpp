#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "path_cases.hpp"

namespace takt::planner {
namespace {

using test::axisLimits;
using test::PathCase;
using test::Random;
using test::Use;

const std::vector<PathAxisLimits> kSquareLimits(2, axisLimits(100.0, 2000.0, 50000.0));

TEST(PathFeed, RunsFourLapsOfARoundedSquareInTime) {
    PathPlanner planner{{2, 2}, kSquareLimits, core::Seconds{0.001}};
    PathMotion motion = planner.motion();
    const Transition corner{TransitionMode::CornerDeviation, core::Distance{0.1}};
    ASSERT_TRUE(planner.plan(test::squareLaps({2, 2}, 20.0, 4, corner, 100.0), motion).ok());
    RecordProperty("seconds", std::to_string(motion.feed.duration()));
    // Stopping at every corner takes 4.64 s; about 4.05 s is possible.
    EXPECT_LE(motion.feed.duration(), 4.15);
    EXPECT_LE(test::useOf(test::traceOf(motion), kSquareLimits, 0.001).most(), 1.0 + 1e-6);
}

TEST(PathFeed, StopsAtEveryCornerIfAskedTo) {
    PathPlanner planner{{2, 2}, kSquareLimits, core::Seconds{0.001}};
    PathMotion motion = planner.motion();
    ASSERT_TRUE(planner.plan(test::squareLaps({2, 2}, 20.0, 1, {}, 100.0), motion).ok());
    // d/v + v/a + a/j for each side, and a little for what is kept back of the limits.
    EXPECT_NEAR(motion.feed.duration(), 4 * (0.2 + 0.05 + 0.04), 4 * 0.002);
    EXPECT_EQ(motion.feed.at(motion.feed.cycles()).s, 80.0);
}

TEST(PathFeed, KeepsAllLimitsOnAnyPath) {
    double logarithms = 0.0;
    double worst = 0.0;
    constexpr int kPaths = 300;
    for (std::uint64_t seed = 1; seed <= kPaths; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random{seed};
        const PathCase c = test::randomPath(random, random.integer(1, 10));
        PathPlanner planner{c.space, c.limits, core::Seconds{c.cycle}};
        PathMotion motion = planner.motion();
        const auto result = planner.plan(c.elements, motion);
        ASSERT_TRUE(result.ok()) << describe(result.error());
        const FeedState end = motion.feed.at(motion.feed.cycles());
        EXPECT_EQ(end.s, motion.geometry.length());
        EXPECT_EQ(end.s1, 0.0);
        EXPECT_EQ(end.s2, 0.0);
        if (motion.feed.cycles() > 200000) continue;
        const Use use = test::useOf(test::traceOf(motion), c.limits, c.cycle);
        EXPECT_LE(use.most(), 1.0 + 1e-6)
            << "v " << use.velocity << " a " << use.acceleration << " j " << use.jerk;
        EXPECT_TRUE(use.monotone);
        worst = std::max(worst, use.most());
        logarithms += std::log(use.most());
    }
    RecordProperty("greatest use", std::to_string(worst));
    // Every path is limited by something nearly everywhere in time.
    EXPECT_GT(std::exp(logarithms / kPaths), 0.99);
}

TEST(PathFeed, IsNotFarFromTheBoundWithoutJerkLimits) {
    PathPlanner planner{{2, 2}, kSquareLimits, core::Seconds{0.001}};
    PathMotion motion = planner.motion();
    const Transition corner{TransitionMode::CornerDistance, core::Distance{5.0}};
    ASSERT_TRUE(planner.plan(test::squareLaps({2, 2}, 20.0, 2, corner, 100.0), motion).ok());
    const double ratio =
        motion.feed.duration() / test::secondOrderTime(motion.geometry, kSquareLimits);
    RecordProperty("T/T2", std::to_string(ratio));
    EXPECT_GT(ratio, 1.0);
    EXPECT_LT(ratio, 1.15);
}

TEST(PathFeed, DoesNotDependOnHowALineIsDivided) {
    const PathSpace space{2, 2};
    const auto plan = [&](int parts) {
        PathPlanner planner{space, kSquareLimits, core::Seconds{0.001}, 1000};
        PathMotion motion = planner.motion();
        std::vector<PathElement> elements;
        PathPoint from = test::point({0.0, 0.0});
        for (int k = 1; k <= parts; ++k) {
            const double x = 30.0 * k / parts;
            const PathPoint to = test::point({x, 0.7 * x});
            PathElement e = line(space, from, to).value();
            e.transition.mode = TransitionMode::Exact;
            elements.push_back(e);
            from = to;
        }
        EXPECT_TRUE(planner.plan(elements, motion).ok());
        return motion.feed.duration();
    };
    EXPECT_NEAR(plan(1000), plan(1), 1e-6);
}

TEST(PathFeed, IsTheSameEveryTime) {
    Random random{7};
    const PathCase c = test::randomPath(random, 8);
    PathPlanner first{c.space, c.limits, core::Seconds{c.cycle}};
    PathPlanner second{c.space, c.limits, core::Seconds{c.cycle}};
    PathMotion a = first.motion();
    PathMotion b = second.motion();
    ASSERT_TRUE(first.plan(c.elements, a).ok());
    ASSERT_TRUE(second.plan(c.elements, a).ok());
    ASSERT_TRUE(second.plan(c.elements, b).ok());
    ASSERT_EQ(a.feed.cycles(), b.feed.cycles());
    for (std::uint64_t k = 0; k <= a.feed.cycles(); ++k) {
        const FeedState x = a.feed.at(k);
        const FeedState y = b.feed.at(k);
        ASSERT_EQ(std::memcmp(&x, &y, sizeof x), 0) << "cycle " << k;
    }
}

TEST(PathFeed, KeepsThePathVelocityOfATransition) {
    PathPlanner planner{{2, 2}, kSquareLimits, core::Seconds{0.001}};
    PathMotion motion = planner.motion();
    const Transition corner{TransitionMode::CornerDistance, core::Distance{5.0},
                            core::Velocity{10.0}};
    ASSERT_TRUE(planner.plan(test::squareLaps({2, 2}, 20.0, 1, corner, 100.0), motion).ok());
    for (std::uint64_t k = 0; k < motion.feed.cycles(); ++k) {
        const FeedState state = motion.feed.at(k);
        if (motion.geometry.piece(motion.geometry.pieceAt(state.s)).isBlend()) {
            EXPECT_LE(state.s1, 10.0 * (1.0 + 1e-6));
        }
    }
}

TEST(PathFeed, RefusesLimitsThatAreNone) {
    auto limits = kSquareLimits;
    limits[1].jerk = core::Jerk{0.0};
    PathPlanner planner{{2, 2}, limits, core::Seconds{0.001}};
    PathMotion motion = planner.motion();
    EXPECT_EQ(planner.plan(test::squareLaps({2, 2}, 20.0, 1, {}, 100.0), motion).error(),
              PathError::InvalidLimits);
}

}  // namespace
}  // namespace takt::planner
