#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <takt/planner/waypoints.hpp>
#include <vector>

#include "problems.hpp"

namespace takt::planner {
namespace {

using core::Position;
using core::Seconds;
using test::limits;
using test::Random;
using test::rest;
using test::state;

std::vector<Position> positions(std::initializer_list<double> numbers) {
    std::vector<Position> result;
    for (const double number : numbers) result.emplace_back(number);
    return result;
}

TEST(Waypoints, OnAStraightLineCostNothing) {
    const std::vector<State> from{state(0, 0, 0), state(0, 0, 0)};
    const std::vector<Limits> both{limits(1, 2, 10), limits(1, 2, 10)};
    WaypointTrajectory path{2, 8};
    const auto points = positions({0.3, 0.15, 1, 0.5, 1.2, 0.6, 2, 1, 2.6, 1.3, 4, 2});
    const auto duration = path.plan(from, points, both);
    ASSERT_TRUE(duration.ok());
    const double direct = plan(from[0], rest(4), both[0]).value().duration().count();
    EXPECT_GE(duration.value().count(), direct * (1 - 1e-9));
    EXPECT_LE(duration.value().count(), direct * 1.02);
}

TEST(Waypoints, ArePassedInOrderAndWithinTheLimits) {
    Random random{31};
    for (int run = 0; run < 20; ++run) {
        const std::size_t axes = 3;
        std::vector<State> from(axes);
        std::vector<Limits> all;
        for (std::size_t i = 0; i < axes; ++i) {
            all.push_back(
                limits(random.uniform(0.5, 2), random.uniform(1, 5), random.uniform(5, 50)));
        }
        std::vector<Position> points;
        for (std::size_t i = 0; i < 6 * axes; ++i) points.emplace_back(random.uniform(-2, 2));
        WaypointTrajectory path{axes, 6};
        ASSERT_TRUE(path.plan(from, points, all).ok());
        std::vector<State> states(axes);
        for (std::size_t p = 0; p < 6; ++p) {
            path.sample(path.passing(p), states);
            for (std::size_t i = 0; i < axes; ++i) {
                ASSERT_NEAR(states[i].position.count(), points[p * axes + i].count(), 1e-11);
            }
        }
        std::vector<State> last(axes);
        path.sample(Seconds{0}, last);
        const int samples = static_cast<int>(path.duration().count() / 0.001) + 10;
        for (int k = 1; k < samples; ++k) {
            path.sample(Seconds{k * 0.001}, states);
            for (std::size_t i = 0; i < axes; ++i) {
                const double jump = (states[i].acceleration - last[i].acceleration).count();
                ASSERT_LE(std::fabs(jump), all[i].jerk.count() * 0.001 * (1 + 1e-6));
                ASSERT_LE(std::fabs(states[i].velocity.count()),
                          all[i].maxVelocity.count() * (1 + 1e-9));
                ASSERT_LE(std::fabs(states[i].acceleration.count()),
                          all[i].maxAcceleration.count() * (1 + 1e-9));
            }
            last = states;
        }
    }
}

TEST(Waypoints, AreFasterThanStopping) {
    const std::vector<State> from(2);
    const std::vector<Limits> both{limits(1, 2, 20), limits(1, 2, 20)};
    const auto points = positions({1, 0.2, 2, 1, 3, 1.2, 4, 2});
    WaypointTrajectory path{2, 4};
    ASSERT_TRUE(path.plan(from, points, both).ok());
    double stopping = 0.0;
    std::vector<double> at{0, 0};
    for (std::size_t p = 0; p < 4; ++p) {
        double leg = 0.0;
        for (std::size_t i = 0; i < 2; ++i) {
            const double to = points[2 * p + i].count();
            leg = std::max(leg,
                           plan(state(at[i], 0, 0), rest(to), both[i]).value().duration().count());
            at[i] = to;
        }
        stopping += leg;
    }
    EXPECT_LT(path.duration().count(), 0.75 * stopping);
    std::vector<State> states(2);
    path.sample(path.passing(1), states);
    EXPECT_GT(std::fabs(states[0].velocity.count()), 0.3);
}

/// The least duration by way of any state of a grid in the point between; a leg that is not
/// possible takes for ever.
double bestOfAGrid(const State& from, double between, double to, const Limits& l) {
    constexpr int kSteps = 40;
    const auto leg = [&](const State& a, const State& b) {
        const auto profile = planner::plan(a, {TargetKind::State, b}, l);
        return profile.ok() ? profile.value().duration().count() : 1e9;
    };
    double best = 1e9;
    for (int i = -kSteps; i <= kSteps; ++i) {
        for (int k = -kSteps; k <= kSteps; ++k) {
            const State point = state(between, l.maxVelocity.count() * i / kSteps,
                                      l.maxAcceleration.count() * k / kSteps);
            const double in = leg(from, point);
            if (in < best) best = std::min(best, in + leg(point, state(to, 0, 0)));
        }
    }
    return best;
}

TEST(Waypoints, AreNearTheBestThatAGridOfStatesFinds) {
    Random random{33};
    for (int i = 0; i < 30; ++i) {
        const Limits l =
            limits(random.uniform(0.5, 3), random.uniform(1, 10), random.uniform(5, 80));
        const double between = random.uniform(-2, 2);
        const double to = random.uniform(-2, 2);
        const std::vector<State> from(1);
        const std::vector<Limits> one{l};
        WaypointTrajectory path{1, 2};
        const double duration = path.plan(from, positions({between, to}), one).value().count();
        ASSERT_LE(duration, 1.01 * bestOfAGrid(from[0], between, to, l)) << i;
    }
}

TEST(Waypoints, GiveTheSameMotionForTheSameRequest) {
    const std::vector<State> from(1);
    const std::vector<Limits> one{limits(1, 2, 20)};
    const auto points = positions({1, 0.5, 3});
    WaypointTrajectory a{1, 3};
    WaypointTrajectory b{1, 3};
    EXPECT_EQ(a.plan(from, points, one).value(), b.plan(from, points, one).value());
    EXPECT_EQ(a.plan(from, points, one).value(), b.duration());
}

TEST(Waypoints, NameAPointThatIsNotANumberAndKeepTheOldMotion) {
    const std::vector<State> from(2);
    const std::vector<Limits> both{limits(1, 2, 20), limits(1, 2, 20)};
    WaypointTrajectory path{2, 2};
    const double before = path.plan(from, positions({1, 1, 2, 2}), both).value().count();
    const auto refused = path.plan(from, positions({1, 1, 2, std::nan("")}), both);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().field, InputField::Waypoint);
    EXPECT_EQ(refused.error().axis, 1);
    EXPECT_EQ(path.duration().count(), before);
}

}  // namespace
}  // namespace takt::planner
