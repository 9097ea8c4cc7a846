#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <takt/planner/profile.hpp>

#include "problems.hpp"

namespace takt::planner {
namespace {

using core::Seconds;
using test::Case;
using test::limits;
using test::Random;
using test::rest;
using test::state;

double durationOf(const Case& c) {
    const auto result = plan(c.from, c.target, c.limits);
    EXPECT_TRUE(result.ok()) << describe(c);
    return result.ok() ? result.value().duration().count() : -1.0;
}

void solvesAll(Case (*make)(Random&), std::uint64_t seed, int count = 20000) {
    Random random{seed};
    for (int i = 0; i < count; ++i) {
        const Case c = make(random);
        const auto result = plan(c.from, c.target, c.limits);
        ASSERT_TRUE(result.ok()) << "case " << i << ": " << describe(c);
        ASSERT_EQ(judge(c, result.value()), "") << "case " << i << ": " << describe(c);
    }
}

TEST(OneAxis, SolvesOrdinaryProblemsWithinTheLimits) {
    solvesAll(test::ordinary, 1);
}
TEST(OneAxis, SolvesProblemsOfSixDecades) {
    solvesAll(test::wide, 2);
}
TEST(OneAxis, SolvesIntegerProblemsWithTies) {
    solvesAll(test::grid, 3);
}
TEST(OneAxis, BringsAStartOutsideTheLimitsBack) {
    solvesAll(test::outside, 4);
}

TEST(OneAxis, SolvesAMillionProblems) {
#ifdef NDEBUG
    constexpr int count = 500000;
#else
    constexpr int count = 10000;  // sanitizers and debuggers are slow
#endif
    solvesAll(test::ordinary, 101, count);
    solvesAll(test::wide, 102, count);
    solvesAll(test::saturated, 103, count);
    solvesAll(test::near, 104, count);
}

TEST(OneAxis, TakesTheTextbookTimeFromRestToRest) {
    // d/v + v/a + a/j when velocity and acceleration reach their limits
    EXPECT_DOUBLE_EQ(durationOf({state(0, 0, 0), rest(10), limits(2, 4, 20)}), 5.0 + 0.5 + 0.2);
    // four ramps of jerk: 4 cbrt(d/(2 j))
    EXPECT_NEAR(durationOf({state(0, 0, 0), rest(1), limits(100, 100, 4)}), 2.0, 1e-12);
}

TEST(OneAxis, TakesNoTimeToStayWhereItIs) {
    EXPECT_EQ(durationOf({state(3, 0, 0), rest(3), limits(1, 1, 1)}), 0.0);
}

TEST(OneAxis, EndsExactlyOnTheTarget) {
    Random random{5};
    for (int i = 0; i < 2000; ++i) {
        const Case c = test::ordinary(random);
        const auto result = plan(c.from, c.target, c.limits);
        ASSERT_TRUE(result.ok());
        const State end = sample(result.value(), result.value().duration());
        ASSERT_EQ(end.position, c.target.state.position);
        ASSERT_EQ(end.velocity, c.target.state.velocity);
        ASSERT_EQ(end.acceleration, c.target.state.acceleration);
    }
}

TEST(OneAxis, StaysAtATargetAtRest) {
    const auto result = plan(state(0, 0, 0), rest(1), limits(1, 1, 1));
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(sample(result.value(), Seconds{1e6}).position.count(), 1.0);
}

TEST(OneAxis, GoesOnWithTheTargetsVelocity) {
    const Target moving{TargetKind::State, state(1, 0.5, 0)};
    const auto result = plan(state(0, 0, 0), moving, limits(1, 1, 1));
    ASSERT_TRUE(result.ok());
    const Seconds later = result.value().duration() + Seconds{2};
    EXPECT_NEAR(sample(result.value(), later).position.count(), 2.0, 1e-12);
}

TEST(OneAxis, IsItsFirstStateBeforeItsBeginning) {
    const State from = state(1, 0.2, 0.1);
    const auto result = plan(from, rest(4), limits(1, 1, 1));
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(sample(result.value(), Seconds{-1}).position, from.position);
    EXPECT_EQ(sample(result.value(), Seconds{-1}).velocity, from.velocity);
}

TEST(OneAxis, SamplesWithoutAJump) {
    Random random{6};
    for (int i = 0; i < 200; ++i) {
        const Case c = test::ordinary(random);
        const Profile profile = plan(c.from, c.target, c.limits).value();
        const double duration = profile.duration().count();
        const double step = duration / 1000;
        const double fastest = 12.0 * step;  // velocities stay below 10
        State last = sample(profile, Seconds{0});
        for (int k = 1; k <= 1001; ++k) {
            const State now = sample(profile, Seconds{k * step});
            ASSERT_LE(std::fabs((now.position - last.position).count()), fastest);
            ASSERT_LE(std::fabs((now.velocity - last.velocity).count()), fastest);
            last = now;
        }
    }
}

TEST(OneAxis, KeepsTheRemainingTimeWhenPlannedAgainOnTheWay) {
    Random random{7};
    for (int i = 0; i < 5000; ++i) {
        const Case c = test::ordinary(random);
        const Profile profile = plan(c.from, c.target, c.limits).value();
        const double duration = profile.duration().count();
        const double t = duration * random.uniform();
        const Case rest{sample(profile, Seconds{t}), c.target, c.limits};
        ASSERT_NEAR(durationOf(rest), duration - t, 1e-9 * (1 + duration)) << describe(rest);
    }
}

TEST(OneAxis, GivesTheMirrorImageForTheMirrorImage) {
    Random random{8};
    for (int i = 0; i < 2000; ++i) {
        const Case c = test::ordinary(random);
        const auto& f = c.from;
        const auto& t = c.target.state;
        const auto& l = c.limits;
        const Case mirror{
            state(-f.position.count(), -f.velocity.count(), -f.acceleration.count()),
            {TargetKind::State,
             state(-t.position.count(), -t.velocity.count(), -t.acceleration.count())},
            limits(-l.minVelocity.count(), -l.maxVelocity.count(), -l.minAcceleration.count(),
                   -l.maxAcceleration.count(), l.jerk.count())};
        const double duration = durationOf(c);
        ASSERT_NEAR(durationOf(mirror), duration, 1e-11 * duration) << describe(c);
    }
}

TEST(OneAxis, IsFreeOfScale) {
    Random random{9};
    for (int i = 0; i < 2000; ++i) {
        const Case c = test::ordinary(random);
        const auto scaled = [&](const State& s) {
            return state(s.position.count() * 1e6, s.velocity.count() * 1e6,
                         s.acceleration.count() * 1e6);
        };
        const auto& l = c.limits;
        const Case counts{scaled(c.from),
                          {TargetKind::State, scaled(c.target.state)},
                          {l.maxVelocity * 1e6, l.minVelocity * 1e6, l.maxAcceleration * 1e6,
                           l.minAcceleration * 1e6, l.jerk * 1e6}};
        const double duration = durationOf(c);
        ASSERT_NEAR(durationOf(counts), duration, 1e-11 * duration) << describe(c);
    }
}

TEST(OneAxis, ReachesAVelocityWithinTheLimits) {
    Random random{10};
    for (int i = 0; i < 20000; ++i) {
        Case c = i % 2 == 0 ? test::ordinary(random) : test::outside(random);
        c.target.kind = TargetKind::Velocity;
        const auto result = plan(c.from, c.target, c.limits);
        ASSERT_TRUE(result.ok()) << describe(c);
        ASSERT_EQ(judge(c, result.value()), "") << describe(c);
    }
}

TEST(OneAxis, ChangesVelocityInTheTextbookTime) {
    const Target target{TargetKind::Velocity, state(0, 2, 0)};
    EXPECT_DOUBLE_EQ(durationOf({state(0, 0, 0), target, limits(5, 4, 20)}), 2.0 / 4 + 4.0 / 20);
}

TEST(OneAxis, StopsAtRest) {
    Random random{11};
    for (int i = 0; i < 5000; ++i) {
        const Case c = test::outside(random);
        const auto result = planStop(c.from, c.limits);
        ASSERT_TRUE(result.ok());
        const State end = sample(result.value(), Seconds{1e9});
        ASSERT_EQ(end.velocity.count(), 0.0);
        ASSERT_EQ(end.acceleration.count(), 0.0);
        ASSERT_EQ(end.position, result.value().end().position);
    }
}

TEST(OneAxis, RefusesWhatIsNotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    const Limits good = limits(1, 1, 1);
    EXPECT_EQ(plan(state(nan, 0, 0), rest(1), good).error(), PlanError::NotFinite);
    EXPECT_EQ(plan(state(0, inf, 0), rest(1), good).error(), PlanError::NotFinite);
    EXPECT_EQ(plan(state(0, 0, 0), rest(-inf), good).error(), PlanError::NotFinite);
    EXPECT_EQ(plan(state(0, 0, 0), rest(1), limits(nan, 1, 1)).error(), PlanError::NotFinite);
    EXPECT_EQ(planStop(state(0, 0, nan), good).error(), PlanError::NotFinite);
}

TEST(OneAxis, RefusesLimitsOfZeroOrWrongSign) {
    const State still = state(0, 0, 0);
    EXPECT_EQ(plan(still, rest(1), limits(0, 1, 1)).error(), PlanError::InvalidLimits);
    EXPECT_EQ(plan(still, rest(1), limits(1, 0.5, 1, -1, 1)).error(), PlanError::InvalidLimits);
    EXPECT_EQ(plan(still, rest(1), limits(1, -1, -1, -1, 1)).error(), PlanError::InvalidLimits);
    EXPECT_EQ(plan(still, rest(1), limits(1, -1, 1, 0, 1)).error(), PlanError::InvalidLimits);
    EXPECT_EQ(plan(still, rest(1), limits(1, 1, -1)).error(), PlanError::InvalidLimits);
}

TEST(OneAxis, RefusesATargetThatCannotBeKeptWithinTheLimits) {
    const auto to = [](double v, double a) { return Target{TargetKind::State, state(1, v, a)}; };
    const State still = state(0, 0, 0);
    EXPECT_EQ(plan(still, to(1.1, 0), limits(1, 1, 1)).error(), PlanError::TargetNotViable);
    EXPECT_EQ(plan(still, to(0, 1.1), limits(1, 1, 1)).error(), PlanError::TargetNotViable);
    EXPECT_EQ(plan(still, to(0.9, 0.5), limits(1, 1, 1)).error(), PlanError::TargetNotViable);
    EXPECT_TRUE(plan(still, to(0.875, 0.5), limits(1, 1, 1)).ok());
}

}  // namespace
}  // namespace takt::planner
