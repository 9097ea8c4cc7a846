#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <takt/planner/cyclic.hpp>
#include <takt/planner/position_range.hpp>
#include <takt/planner/profile_query.hpp>
#include <takt/planner/trajectory.hpp>
#include <vector>

#include "problems.hpp"

namespace takt::planner {
namespace {

using core::Position;
using core::Seconds;
using test::Case;
using test::limits;
using test::Random;
using test::rest;
using test::state;

const double kInf = std::numeric_limits<double>::infinity();

std::vector<AxisRequest> twoAxes() {
    return {{state(0, 0, 0), rest(10), limits(1, 1, 1)},
            {state(0, 0, 0), rest(1), limits(1, 1, 1)}};
}

TEST(Trajectory, WithoutSynchronisationEveryAxisIsAsFastAsItCan) {
    Trajectory trajectory{2};
    Timing timing;
    timing.synchronisation = Synchronisation::None;
    ASSERT_TRUE(trajectory.plan(twoAxes(), timing).ok());
    EXPECT_DOUBLE_EQ(trajectory[0].duration().count(), 12.0);
    EXPECT_NEAR(trajectory[1].duration().count(), 4 * std::cbrt(0.5), 1e-12);
    EXPECT_EQ(trajectory.duration(), trajectory[0].duration());
}

TEST(Trajectory, IfNecessaryOnlyMovingTargetsAreSynchronised) {
    auto requests = twoAxes();
    requests.push_back({state(0, 0, 0), {TargetKind::State, state(1, 0.5, 0)}, limits(1, 1, 1)});
    Trajectory trajectory{3};
    Timing timing;
    timing.synchronisation = Synchronisation::TimeIfNecessary;
    ASSERT_TRUE(trajectory.plan(requests, timing).ok());
    EXPECT_LT(trajectory[1].duration().count(), 4.0);
    EXPECT_GE(trajectory[2].duration().count(), 12.0);
}

TEST(Trajectory, AxesThatNeedNotWaitTakeWholeCyclesToo) {
    Trajectory trajectory{2};
    Timing timing;
    timing.synchronisation = Synchronisation::TimeIfNecessary;
    timing.cycle = Seconds{0.1};
    ASSERT_TRUE(trajectory.plan(twoAxes(), timing).ok());
    const double cycles = trajectory[1].duration().count() / 0.1;  // of 3.17 s
    EXPECT_NEAR(cycles, 32, 1e-9);
}

TEST(Trajectory, LeavesAnAxisThatIsNotEnabledWhereItIs) {
    auto requests = twoAxes();
    requests[0].enabled = false;
    requests[0].target = rest(std::nan(""));
    Trajectory trajectory{2};
    ASSERT_TRUE(trajectory.plan(requests, {}).ok());
    EXPECT_LT(trajectory.duration().count(), 4.0);
    std::vector<State> states(2);
    trajectory.sample(Seconds{1}, states);
    EXPECT_EQ(states[0].position.count(), 0.0);
}

TEST(Trajectory, TakesNoLessThanTheMinimumDuration) {
    Trajectory trajectory{2};
    Timing timing;
    timing.minDuration = Seconds{20};
    EXPECT_EQ(trajectory.plan(twoAxes(), timing).value().count(), 20.0);
}

TEST(Trajectory, NamesTheValueThatItRefusesAndStaysAsItWas) {
    Trajectory trajectory{2};
    ASSERT_TRUE(trajectory.plan(twoAxes(), {}).ok());
    auto requests = twoAxes();
    requests[1].limits.minAcceleration = core::Acceleration{0};
    const auto refused = trajectory.plan(requests, {});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().error, PlanError::InvalidLimits);
    EXPECT_EQ(refused.error().field, InputField::MinAcceleration);
    EXPECT_EQ(refused.error().axis, 1);
    EXPECT_DOUBLE_EQ(trajectory.duration().count(), 12.0);
    EXPECT_EQ(trajectory[1].end().position.count(), 1.0);
}

TEST(Trajectory, KeepsToAStraightLineInMillimetresFarFromTheOrigin) {
    Random random{21};
    for (int i = 0; i < 500; ++i) {
        const double e[3] = {1.0, random.uniform(-1, 1), random.uniform(-1, 1)};
        const double way = random.uniform(10, 1000);
        const double v0 = random.uniform(-50, 50);
        std::vector<AxisRequest> requests;
        for (const double share : e) {
            const double p0 = random.uniform(-5e3, 5e3);
            requests.push_back({state(p0, v0 * share, 0), rest(p0 + way * share),
                                limits(random.uniform(100, 500), 2000, random.uniform(1e4, 1e5))});
        }
        Timing timing;
        timing.synchronisation = Synchronisation::Line;
        Trajectory trajectory{3};
        ASSERT_TRUE(trajectory.plan(requests, timing).ok());
        ASSERT_TRUE(trajectory.isStraight());
        std::vector<State> states(3);
        for (int k = 0; k <= 20; ++k) {
            trajectory.sample(trajectory.duration() * (k / 20.0), states);
            const double s = (states[0].position - requests[0].from.position).count();
            for (std::size_t a = 1; a < 3; ++a) {
                const double offset = (states[a].position - requests[a].from.position).count();
                ASSERT_NEAR(offset, s * e[a], 1e-11 * 5e3);
            }
        }
    }
}

TEST(Trajectory, SaysWhenThereIsNoStraightLine) {
    auto requests = twoAxes();
    requests[1].from.velocity = core::Velocity{0.3};
    Timing timing;
    timing.synchronisation = Synchronisation::Line;
    Trajectory trajectory{2};
    ASSERT_TRUE(trajectory.plan(requests, timing).ok());
    EXPECT_FALSE(trajectory.isStraight());
}

TEST(Trajectory, IsFastestOnTheLineUnlessAnotherWayIsFaster) {
    auto requests = twoAxes();
    requests[1].limits = limits(0.11, 100, 1000);  // a tenth of the way, with little to spare
    requests[0].limits = limits(1, 1, 1000);
    Timing timing;
    timing.synchronisation = Synchronisation::Phase;
    Trajectory trajectory{2};
    ASSERT_TRUE(trajectory.plan(requests, timing).ok());
    EXPECT_TRUE(trajectory.isStraight());
    requests[1].limits = limits(0.095, 100, 1000);  // must not keep up with its share
    requests[1].target = rest(0.9);
    ASSERT_TRUE(trajectory.plan(requests, timing).ok());
    const double duration = trajectory.duration().count();
    timing.synchronisation = Synchronisation::Time;
    ASSERT_TRUE(trajectory.plan(requests, timing).ok());
    EXPECT_LE(duration, trajectory.duration().count() * (1 + 1e-9));
}

TEST(Orders, WithoutAJerkLimitTheMotionIsATrapezoid) {
    const auto result = plan(state(0, 0, 0), rest(10), limits(2, 1, kInf));
    ASSERT_TRUE(result.ok());
    EXPECT_DOUBLE_EQ(result.value().duration().count(), 10.0 / 2 + 2.0 / 1);
    EXPECT_DOUBLE_EQ(sample(result.value(), Seconds{1}).position.count(), 0.5);
}

TEST(Orders, WithoutAnAccelerationLimitTheMotionIsALine) {
    const auto result = plan(state(1, 0, 0), rest(-3), limits(2, kInf, kInf));
    ASSERT_TRUE(result.ok());
    EXPECT_DOUBLE_EQ(result.value().duration().count(), 2.0);
    EXPECT_DOUBLE_EQ(sample(result.value(), Seconds{1}).position.count(), -1.0);
    EXPECT_DOUBLE_EQ(sample(result.value(), Seconds{1}).velocity.count(), -2.0);
    EXPECT_EQ(sample(result.value(), Seconds{2}).velocity.count(), 0.0);
}

TEST(Orders, SecondOrderIsTheLimitOfThirdOrder) {
    Random random{22};
    for (int i = 0; i < 2000; ++i) {
        Case c = test::ordinary(random);
        c.from.acceleration = core::Acceleration{0};
        c.target.state.acceleration = core::Acceleration{0};
        c.limits.jerk = core::Jerk{kInf};
        const double second = plan(c.from, c.target, c.limits).value().duration().count();
        c.limits.jerk = core::Jerk{1e9};
        const double third = plan(c.from, c.target, c.limits).value().duration().count();
        ASSERT_NEAR(second, third, 1e-3 * (1 + second)) << describe(c);
        ASSERT_LE(second, third * (1 + 1e-9));
    }
}

TEST(CyclicGenerator, ReachesTheGoalWithoutPlanningAgain) {
    CyclicGenerator generator{1, Seconds{0.01}};
    const std::vector<State> start{state(0, 0, 0)};
    generator.reset(start);
    const std::vector<Goal> goals{{rest(1), limits(1, 1, 1)}};
    std::vector<State> states(1);
    double last = 0.0;
    int cycles = 0;
    while (!generator.isDone() || cycles == 0) {
        ASSERT_FALSE(generator.step(goals, {}, states).has_value());
        ASSERT_GT(generator.time().count(), last);
        last = generator.time().count();
        ASSERT_LT(++cycles, 1000);
    }
    EXPECT_EQ(states[0].position.count(), 1.0);
    EXPECT_EQ(cycles, static_cast<int>(std::ceil(4 * std::cbrt(0.5) / 0.01)));
}

TEST(CyclicGenerator, ChangesTheGoalOnTheWayWithoutAJump) {
    CyclicGenerator generator{1, Seconds{0.01}};
    const std::vector<State> start{state(0, 0, 0)};
    generator.reset(start);
    std::vector<Goal> goals{{rest(1), limits(1, 1, 1)}};
    std::vector<State> states(1);
    double a = 0.0;
    for (int i = 0; i < 2000; ++i) {
        if (i % 70 == 50) goals[0].target = rest(i % 3);
        ASSERT_FALSE(generator.step(goals, {}, states).has_value());
        ASSERT_LE(std::fabs(states[0].acceleration.count() - a), 0.01 * (1 + 1e-9));
        a = states[0].acceleration.count();
    }
}

TEST(CyclicGenerator, GoesOnWhenAGoalIsRefused) {
    CyclicGenerator generator{1, Seconds{0.1}};
    const std::vector<State> start{state(0, 0, 0)};
    generator.reset(start);
    std::vector<Goal> goals{{rest(1), limits(1, 1, 1)}};
    std::vector<State> states(1);
    ASSERT_FALSE(generator.step(goals, {}, states).has_value());
    goals[0].target = rest(std::nan(""));
    const auto fault = generator.step(goals, {}, states);
    ASSERT_TRUE(fault.has_value());
    EXPECT_EQ(fault->field, InputField::TargetPosition);
    EXPECT_EQ(states[0].position, sample(generator.trajectory()[0], Seconds{0.2}).position);
}

TEST(PositionRange, IsNeverLeftWhereThatCanBeAvoided) {
    Random random{23};
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
        Case c = test::ordinary(random);
        c.target.state.velocity = {};
        c.target.state.acceleration = {};
        const double a = c.from.position.count();
        const double b = c.target.state.position.count();
        const PositionRange range{Position{std::min(a, b) - random.uniform(0, 3)},
                                  Position{std::max(a, b) + random.uniform(0, 3)}};
        const auto result = planWithin(c.from, c.target, c.limits, range);
        if (!result.ok()) {
            ASSERT_EQ(result.error(), PlanError::OutOfRange);
            const auto stop = extremesOf(planStop(c.from, c.limits).value());
            ASSERT_TRUE(stop.lowest < range.lowest || stop.highest > range.highest) << describe(c);
            ++refused;
            continue;
        }
        ASSERT_EQ(test::judge(c, result.value()), "") << describe(c);
        const auto extremes = extremesOf(result.value());
        ASSERT_GE(extremes.lowest.count(), range.lowest.count() - 1e-12 * 10);
        ASSERT_LE(extremes.highest.count(), range.highest.count() + 1e-12 * 10);
    }
    EXPECT_LT(refused, 1500);
}

TEST(PositionRange, RefusesATargetOutsideIt) {
    const PositionRange range{Position{0}, Position{1}};
    const auto result = planWithin(state(0.5, 0, 0), rest(2), limits(1, 1, 1), range);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error(), PlanError::OutOfRange);
}

}  // namespace
}  // namespace takt::planner
