#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <takt/planner/roadmap/route_trial.hpp>

#include "scenes.hpp"

namespace takt::planner::roadmap::test {
namespace {

using core::Acceleration;
using core::Jerk;
using core::Position;
using core::Seconds;
using core::Velocity;

std::vector<PathAxisLimits> limitsOf(const Scene& scene) {
    std::vector<PathAxisLimits> limits;
    for (const RouteAxis& axis : scene.axes)
        limits.push_back({axis.velocity, Acceleration{5000.0}, Jerk{100000.0}});
    return limits;
}

TrialRequest trialOf(const Scene& scene, std::span<const PathAxisLimits> limits) {
    TrialRequest request;
    request.space = {scene.axes.size(), std::min<std::size_t>(scene.axes.size(), 3)};
    request.limits = limits;
    return request;
}

TEST(RouteMotion, TouchesNoKeepOutInAnyCycleOfTwoHundredScenes) {
    double deepest = -std::numeric_limits<double>::infinity();
    double seconds = 0.0;
    int bent = 0;
    int moved = 0;
    for (std::uint64_t seed = 1; moved < 200; ++seed) {
        const Scene scene = randomScene(seed, 2 + seed % 2);
        const Obstacles obstacles{scene.keepOuts};
        const RouteAnswer route = planRoute(scene.request(), obstacles);
        if (!route.ok()) continue;
        const auto limits = limitsOf(scene);
        const TrialRequest request = trialOf(scene, limits);
        const TrialResult trial = tryRoute(route, request, obstacles);
        ASSERT_EQ(trial.fault, TrialFault::None) << "seed " << seed;
        // The same motion again, judged by the definition of the keep-outs.
        const auto elements = elementsOf(route, request.space, request.feed);
        PathPlanner planner{request.space, limits, request.cycle, elements.size()};
        PathMotion motion = planner.motion();
        const auto cycles = planner.plan(elements, motion);
        ASSERT_TRUE(cycles.ok());
        PathDerivatives at;
        std::vector<double> point(scene.axes.size());
        for (std::uint64_t k = 0; k <= cycles.value(); ++k) {
            motion.geometry.evaluate(motion.feed.at(k).s, at);
            std::copy_n(at.q.begin(), point.size(), point.begin());
            deepest = std::max(deepest, depth(scene, point));
        }
        for (std::size_t axis = 0; axis < point.size(); ++axis)
            EXPECT_NEAR(point[axis], scene.goal[axis], 1e-9);
        EXPECT_DOUBLE_EQ(trial.duration.count(), static_cast<double>(cycles.value()) * 1e-3);
        ++moved;
        bent += route.points.size() > 2 ? 1 : 0;
        seconds += trial.duration.count();
    }
    EXPECT_LE(deepest, 1e-9);
    EXPECT_GE(bent, 100);
    std::printf("%d motions, %d of them around something, %.1f s in all, deepest %.3g\n", moved,
                bent, seconds, deepest);
}

TEST(RouteMotion, IsFoundToCollideWhereARouteLeadsThrough) {
    Scene scene = randomScene(1, 2);
    scene.keepOuts.resize(1);
    scene.keepOuts[0] = {};
    scene.keepOuts[0].spans = {{0, Position{190.0}, Position{210.0}}};
    RouteAnswer route;
    route.points = {{{100.0, 50.0}, {}}, {{300.0, 50.0}, {}}};
    const auto limits = limitsOf(scene);
    const TrialResult trial = tryRoute(route, trialOf(scene, limits), Obstacles{scene.keepOuts});
    EXPECT_EQ(trial.fault, TrialFault::Collision);
    EXPECT_EQ(trial.keepOut, 0U);
}

TEST(RouteMotion, TakesNoTimeWhereThereIsNoWay) {
    const Scene scene = randomScene(1, 2);
    RouteAnswer route;
    route.points = {{{100.0, 50.0}, {}}, {{100.0, 50.0}, {}}};
    const auto limits = limitsOf(scene);
    const TrialResult trial = tryRoute(route, trialOf(scene, limits), Obstacles{});
    EXPECT_EQ(trial.fault, TrialFault::None);
    EXPECT_EQ(trial.duration.count(), 0.0);
}

TEST(RouteMotion, IsFasterRoundItsCornersThanWithStops) {
    double rounded = 0.0;
    double stopping = 0.0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const Scene scene = randomScene(seed, 2 + seed % 2);
        const Obstacles obstacles{scene.keepOuts};
        RouteAnswer route = planRoute(scene.request(), obstacles);
        if (!route.ok() || route.points.size() < 3) continue;
        const auto limits = limitsOf(scene);
        rounded += tryRoute(route, trialOf(scene, limits), obstacles).duration.count();
        for (RoutePoint& point : route.points) point.corner = {};
        stopping += tryRoute(route, trialOf(scene, limits), obstacles).duration.count();
    }
    EXPECT_GT(rounded, 0.0);
    EXPECT_LT(rounded, 0.9 * stopping);
}

}  // namespace
}  // namespace takt::planner::roadmap::test
