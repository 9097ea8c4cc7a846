#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "grid.hpp"
#include "scenes.hpp"

namespace takt::planner::roadmap::test {
namespace {

using core::Distance;
using core::Position;
using core::Velocity;
using Values = std::vector<double>;
constexpr double Far = std::numeric_limits<double>::infinity();

/// Axes from 0 to 400.
std::vector<RouteAxis> axes(std::size_t count) {
    return {count, {Position{0.0}, Position{400.0}, Velocity{500.0}}};
}

KeepOutParams box(std::vector<std::pair<double, double>> spans) {
    KeepOutParams keepOut;
    for (std::size_t i = 0; i < spans.size(); ++i)
        keepOut.spans.push_back({i, Position{spans[i].first}, Position{spans[i].second}});
    return keepOut;
}

RouteAnswer plan(const Scene& scene) {
    return planRoute(scene.request(), Obstacles{scene.keepOuts});
}

/// Deepest sample of the answer's lines, one for each 0.05 mm.
double deepest(const Scene& scene, const RouteAnswer& answer) {
    double most = -Far;
    for (std::size_t i = 1; i < answer.points.size(); ++i) {
        const Values& from = answer.points[i - 1].position;
        const Values& to = answer.points[i].position;
        double longest = 0.0;
        for (std::size_t axis = 0; axis < from.size(); ++axis)
            longest = std::max(longest, std::abs(to[axis] - from[axis]));
        const int steps = std::max(1, static_cast<int>(longest / 0.05));
        Values point = from;
        for (int k = 0; k <= steps; ++k) {
            const double share = static_cast<double>(k) / steps;
            for (std::size_t axis = 0; axis < from.size(); ++axis)
                point[axis] = from[axis] + share * (to[axis] - from[axis]);
            most = std::max(most, depth(scene, point));
        }
    }
    return most;
}

TEST(Route, IsFoundAndNearTheShortestInTwoHundredScenes) {
    constexpr int Scenes = 200;
    constexpr int MostOpen = 20;
    int planned = 0;
    int open = 0;
    double worst = 0.0;
    double sum = 0.0;
    for (std::uint64_t seed = 1; planned < Scenes; ++seed) {
        const Scene scene = randomScene(seed, 2 + seed % 2);
        const bool straight = Obstacles{scene.keepOuts}.isFree(scene.start, scene.goal);
        if (straight && open == MostOpen) continue;
        const auto shortest = gridLength(scene, scene.axes.size() == 2 ? 2.5 : 10.0);
        if (!shortest) continue;
        ++planned;
        open += straight ? 1 : 0;
        const RouteAnswer answer = plan(scene);
        ASSERT_TRUE(answer.ok()) << "seed " << seed << ", fault " << static_cast<int>(answer.fault);
        EXPECT_EQ(answer.points.front().position, scene.start);
        EXPECT_EQ(answer.points.back().position, scene.goal);
        EXPECT_LE(deepest(scene, answer), 1e-9) << "seed " << seed;
        const double ratio = answer.length.count() / *shortest;
        EXPECT_LE(ratio, 1.3) << "seed " << seed;
        worst = std::max(worst, ratio);
        sum += ratio;
    }
    EXPECT_GE(planned - open, 150);
    std::printf(
        "%d scenes, %d with the straight line blocked; length to grid: mean %.3f, worst %.3f\n",
        planned, planned - open, sum / planned, worst);
}

TEST(Route, LeavesItsCornersRoomThatIsFree) {
    std::size_t corners = 0;
    std::size_t rounded = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const Scene scene = randomScene(seed, 2 + seed % 2);
        const RouteAnswer answer = plan(scene);
        for (std::size_t i = 1; i + 1 < answer.points.size(); ++i) {
            const Values& point = answer.points[i].position;
            const double cut = answer.points[i].corner.count();
            Values in = point;
            Values out = point;
            const auto towards = [&](Values& tangent, const Values& other) {
                double length = 0.0;
                for (std::size_t axis = 0; axis < point.size(); ++axis)
                    length += (other[axis] - point[axis]) * (other[axis] - point[axis]);
                length = std::sqrt(length);
                EXPECT_LE(cut, 0.5 * length * (1.0 + 1e-12));
                for (std::size_t axis = 0; axis < point.size(); ++axis)
                    tangent[axis] += cut / length * (other[axis] - point[axis]);
            };
            towards(in, answer.points[i - 1].position);
            towards(out, answer.points[i + 1].position);
            constexpr int Steps = 30;
            for (int k = 0; k <= Steps; ++k) {
                for (int j = 0; j <= Steps - k; ++j) {
                    Values sample = point;
                    for (std::size_t axis = 0; axis < point.size(); ++axis)
                        sample[axis] +=
                            (k * (in[axis] - point[axis]) + j * (out[axis] - point[axis])) / Steps;
                    ASSERT_LE(depth(scene, sample), 1e-9) << "seed " << seed << " corner " << i;
                }
            }
            ++corners;
            rounded += cut > 0.0 ? 1 : 0;
        }
        if (answer.ok()) {
            EXPECT_EQ(answer.points.front().corner.count(), 0.0);
            EXPECT_EQ(answer.points.back().corner.count(), 0.0);
        }
    }
    EXPECT_GT(corners, 100U);
    EXPECT_GT(rounded * 10, corners * 9) << rounded << " of " << corners;
}

std::string output(const std::string& command) {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe{popen(command.c_str(), "r"), pclose};
    std::string text;
    std::array<char, 4096> buffer{};
    while (pipe != nullptr) {
        const std::size_t got = fread(buffer.data(), 1, buffer.size(), pipe.get());
        if (got == 0) break;
        text.append(buffer.data(), got);
    }
    return text;
}

TEST(Route, IsTheSameInEveryProcessAndAfterOtherPlans) {
    const std::string forwards = output(ROADMAP_PRINT " forwards");
    const std::string backwards = output(ROADMAP_PRINT " backwards");
    EXPECT_GT(forwards.size(), 20000U);
    EXPECT_TRUE(forwards == backwards);
}

TEST(Route, DependsOnItsSeed) {
    Scene scene = randomScene(10, 2);
    const std::string first = textOf(plan(scene));
    EXPECT_EQ(textOf(plan(scene)), first);
    scene.seed = 77;
    EXPECT_NE(textOf(plan(scene)), first);
}

/// Start at (50, 50, …), goal at (350, 350, …).
Scene crossing(std::size_t count, std::vector<KeepOutParams> keepOuts) {
    return {axes(count), std::move(keepOuts), Values(count, 50.0), Values(count, 350.0), 5};
}

KeepOutParams tube(double x, double y, double radius) {
    KeepOutParams keepOut;
    keepOut.disc = KeepOutDisc{0, 1, Position{x}, Position{y}, Distance{radius}};
    return keepOut;
}

std::vector<Scene> unsolvableScenes() {
    const auto wall = [](std::size_t axis) {
        KeepOutParams keepOut;
        keepOut.spans.push_back({axis, Position{200.0}, Position{201.0}});
        return keepOut;
    };
    // Four boxes around the start, each overlapping its neighbours.
    const std::vector<KeepOutParams> pen{box({{-10, 100}, {90, 100}}), box({{90, 100}, {-10, 100}}),
                                         box({{-10, 100}, {-10, 10}}),
                                         box({{-10, 10}, {-10, 100}})};
    std::vector<KeepOutParams> fence;  // a row of overlapping discs from end to end
    for (int i = 0; i <= 20; ++i) fence.push_back(tube(20.0 * i, 400.0 - 20.0 * i, 15.0));
    std::vector<KeepOutParams> shell;  // six faces around the goal
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const double place : {300.0, 390.0}) {
            KeepOutParams face = box({{300, 400}, {300, 400}, {300, 400}});
            face.spans[axis] = {axis, Position{place}, Position{place + 5.0}};
            shell.push_back(face);
        }
    }
    // A door that is narrower than the tool.
    KeepOutParams leftDoor = box({{200, 210}, {-Far, 195}});
    KeepOutParams rightDoor = box({{200, 210}, {205, Far}});
    leftDoor.clearance = rightDoor.clearance = Distance{5.5};
    return {crossing(2, pen), crossing(2, fence), crossing(3, shell), crossing(3, {wall(2)}),
            crossing(2, {leftDoor, rightDoor})};
}

TEST(Route, IsRefusedWithinTheIterationsWhereThereIsNone) {
    const std::vector<Scene> scenes = unsolvableScenes();
    ASSERT_EQ(scenes.size(), 5U);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const RouteAnswer answer = plan(scenes[i]);
        EXPECT_EQ(answer.fault, RouteFault::NoRoute) << i;
        EXPECT_LE(answer.iterations, RouteEffort{}.iterations) << i;
        EXPECT_TRUE(answer.points.empty()) << i;
    }
}

TEST(Route, IsFoundThroughADoorThatIsWideEnough) {
    Scene scene = unsolvableScenes().back();
    for (KeepOutParams& door : scene.keepOuts) door.clearance = Distance{3.0};
    const RouteAnswer answer = plan(scene);
    EXPECT_TRUE(answer.ok());
    EXPECT_LE(deepest(scene, answer), 1e-9);
}

TEST(Route, SaysInWhichKeepOutTheStartLies) {
    Scene scene = crossing(2, {box({{100, 150}, {100, 150}}), box({{45, 55}, {45, 55}})});
    const RouteAnswer answer = plan(scene);
    EXPECT_EQ(answer.fault, RouteFault::StartInKeepOut);
    EXPECT_EQ(answer.which, 1U);
}

TEST(Route, SaysInWhichKeepOutTheGoalLies) {
    Scene scene = crossing(2, {box({{340, 360}, {340, 360}}), box({{100, 150}, {100, 150}})});
    const RouteAnswer answer = plan(scene);
    EXPECT_EQ(answer.fault, RouteFault::GoalInKeepOut);
    EXPECT_EQ(answer.which, 0U);
}

TEST(Route, SaysWhichAxisIsOutsideItsLimits) {
    Scene scene = crossing(3, {});
    scene.start[2] = -0.1;
    EXPECT_EQ(plan(scene).fault, RouteFault::StartOutsideLimits);
    EXPECT_EQ(plan(scene).which, 2U);
    scene.start[2] = 0.0;
    scene.goal[1] = 400.1;
    EXPECT_EQ(plan(scene).fault, RouteFault::GoalOutsideLimits);
    EXPECT_EQ(plan(scene).which, 1U);
}

TEST(Route, RefusesRequestsThatMakeNoSense) {
    const auto fault = [](auto change) {
        Scene scene = crossing(2, {box({{100, 150}, {100, 150}})});
        change(scene);
        return plan(scene).fault;
    };
    EXPECT_EQ(fault([](Scene&) {}), RouteFault::None);
    EXPECT_EQ(fault([](Scene& s) { s.goal.push_back(1.0); }), RouteFault::BadRequest);
    EXPECT_EQ(fault([](Scene& s) { s.start[0] = std::nan(""); }), RouteFault::BadRequest);
    EXPECT_EQ(fault([](Scene& s) { s.axes[0].velocity = Velocity{0.0}; }), RouteFault::BadRequest);
    EXPECT_EQ(fault([](Scene& s) { s.axes[1].high = Position{Far}; }), RouteFault::BadRequest);
    EXPECT_EQ(fault([](Scene& s) { s.keepOuts[0].spans[1].axis = 2; }), RouteFault::BadRequest);
}

TEST(Route, IsTheStraightLineWhereThatIsFree) {
    const RouteAnswer answer = plan(crossing(3, {box({{100, 150}, {200, 250}, {0, 400}})}));
    ASSERT_TRUE(answer.ok());
    EXPECT_EQ(answer.points.size(), 2U);
    EXPECT_EQ(answer.iterations, 0U);
}

TEST(Route, GoesAroundOnTheSideOfTheFasterAxis) {
    // Around the box by the first axis the way is longer but, at its speed, shorter in time.
    Scene scene{axes(2), {box({{100, 300}, {150, 250}})}, {200.0, 50.0}, {200.0, 350.0}, 5};
    scene.keepOuts.push_back(box({{100, 190}, {249, 260}}));
    scene.axes[0].velocity = Velocity{2000.0};
    scene.axes[1].velocity = Velocity{100.0};
    const RouteAnswer answer = plan(scene);
    ASSERT_TRUE(answer.ok());
    EXPECT_NEAR(answer.length.count(), 3.0, 0.03);  // 300 units of the slow axis
}

TEST(Route, LetsAxesWithoutKeepOutsFollow) {
    Scene scene = crossing(4, {box({{150, 250}, {150, 250}})});
    scene.goal = {350.0, 350.0, 90.0, 20.0};
    const RouteAnswer answer = plan(scene);
    ASSERT_TRUE(answer.ok());
    ASSERT_GT(answer.points.size(), 2U);
    for (std::size_t i = 1; i < answer.points.size(); ++i) {
        EXPECT_GT(answer.points[i].position[2], answer.points[i - 1].position[2]);
        EXPECT_LT(answer.points[i].position[3], answer.points[i - 1].position[3]);
    }
    EXPECT_EQ(answer.points.back().position, scene.goal);
}

TEST(Route, StopsAtCornersWithoutRounding) {
    const Scene scene = crossing(2, {box({{150, 250}, {150, 250}})});
    RouteRequest request = scene.request();
    request.rounding = Distance{0.0};
    const RouteAnswer answer = planRoute(request, Obstacles{scene.keepOuts});
    ASSERT_TRUE(answer.ok());
    for (const RoutePoint& point : answer.points) EXPECT_EQ(point.corner.count(), 0.0);
}

}  // namespace
}  // namespace takt::planner::roadmap::test
