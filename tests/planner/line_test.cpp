#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <takt/planner/profile_query.hpp>
#include <takt/planner/trajectory.hpp>
#include <vector>

#include "problems.hpp"
#include "reachable.hpp"

// Straight lines: every state of the group stays on one line, and that costs no time that could be
// had otherwise.
namespace takt::planner {
namespace {

using core::Acceleration;
using core::Position;
using core::Seconds;
using core::Velocity;
using test::Case;
using test::judge;
using test::limits;
using test::Random;
using test::reachable;
using test::rest;
using test::state;

constexpr std::size_t kAxes = 3;

/// A problem along a line: what every axis has to do, and the scalar problem of the line itself.
struct Straight {
    std::array<double, kAxes> share;
    std::vector<AxisRequest> requests;
    Case scalar;
};

/// The limits of the line: s is as fast as every axis allows.
Limits together(const std::vector<AxisRequest>& requests, const std::array<double, kAxes>& share) {
    const double inf = std::numeric_limits<double>::infinity();
    std::array<double, 5> most{inf, inf, inf, inf, inf};
    for (std::size_t i = 0; i < kAxes; ++i) {
        const Limits& l = requests[i].limits;
        std::array<double, 5> own{l.maxVelocity.count(), -l.minVelocity.count(),
                                  l.maxAcceleration.count(), -l.minAcceleration.count(),
                                  l.jerk.count()};
        if (share[i] < 0) {
            std::swap(own[0], own[1]);
            std::swap(own[2], own[3]);
        }
        for (std::size_t k = 0; k < own.size(); ++k) {
            most[k] = std::min(most[k], own[k] / std::fabs(share[i]));
        }
    }
    return limits(most[0], -most[1], most[2], -most[3], most[4]);
}

AxisRequest along(const Case& scalar, double share, double origin, const Limits& limits) {
    const auto point = [&](const State& s) {
        return state(origin + s.position.count() * share, s.velocity.count() * share,
                     s.acceleration.count() * share);
    };
    return {point(scalar.from), {scalar.target.kind, point(scalar.target.state)}, limits, true, {}};
}

/// States anywhere within the limits of the line; all shares are powers of two, so that the axes'
/// numbers are exact multiples.
Straight onALine(Random& random) {
    for (;;) {
        Straight s;
        s.scalar = test::ordinary(random);
        s.scalar.from.position = Position{};
        if (random.chance(0.2)) s.scalar.from = state(0, 0, 0);
        for (std::size_t i = 0; i < kAxes; ++i) {
            s.share[i] = std::ldexp(random.chance(0.5) ? 1.0 : -1.0, -random.integer(0, 3));
            const Limits l =
                limits(random.uniform(0.5, 10), -random.uniform(0.5, 10), random.uniform(0.5, 10),
                       -random.uniform(0.5, 10), random.uniform(0.5, 50));
            s.requests.push_back(along(s.scalar, s.share[i], 0, l));
        }
        s.scalar.limits = together(s.requests, s.share);
        const State& from = s.scalar.from;
        const State& to = s.scalar.target.state;
        const bool viable = !findFault(from, s.scalar.target, s.scalar.limits) &&
                            !findFault(to, {TargetKind::State, from}, s.scalar.limits);
        if (viable) return s;
    }
}

core::Result<Seconds, InputFault> planAs(Trajectory& trajectory, Synchronisation how,
                                         const std::vector<AxisRequest>& requests) {
    Timing timing;
    timing.synchronisation = how;
    return trajectory.plan(requests, timing);
}

/// How far the axes are from the line through their starts, relative to the way.
double offLine(const Trajectory& trajectory, const std::vector<AxisRequest>& requests,
               const std::array<double, kAxes>& share) {
    std::array<State, kAxes> states{};
    double off = 0.0;
    for (int k = 0; k <= 40; ++k) {
        trajectory.sample(trajectory.duration() * (k / 40.0), states);
        const auto along = [&](std::size_t i) {
            return (states[i].position - requests[i].from.position).count() / share[i];
        };
        for (std::size_t i = 1; i < kAxes; ++i) off = std::max(off, std::fabs(along(i) - along(0)));
    }
    return off;
}

TEST(StraightLine, IsTakenExactlyWhereItsOptimumIsNotSlower) {
    Random random{61};
    int straight = 0;
    int bent = 0;
    for (int i = 0; i < 2000; ++i) {
        const Straight s = onALine(random);
        Trajectory trajectory{kAxes};
        const double line = planAs(trajectory, Synchronisation::Line, s.requests).value().count();
        ASSERT_TRUE(trajectory.isStraight()) << describe(s.scalar);
        // That this is the fastest straight motion is judged by independent code.
        ASSERT_TRUE(reachable(s.scalar, line * (1 + 1e-12L), 1e-11L)) << describe(s.scalar);
        for (int k = 1; k <= 20; ++k) {
            ASSERT_FALSE(reachable(s.scalar, line * (1 - 1e-7) * k / 20, 0)) << describe(s.scalar);
        }
        const double time = planAs(trajectory, Synchronisation::Time, s.requests).value().count();
        const double phase = planAs(trajectory, Synchronisation::Phase, s.requests).value().count();
        ASSERT_LE(phase, time * (1 + 1e-6)) << describe(s.scalar);
        ASSERT_EQ(trajectory.isStraight(), line <= time * (1 + 9e-7)) << describe(s.scalar);
        ++(trajectory.isStraight() ? straight : bent);
        if (trajectory.isStraight()) {
            ASSERT_LE(offLine(trajectory, s.requests, s.share), 1e-11 * (10 + line));
        }
        for (std::size_t k = 0; k < kAxes; ++k) {
            const AxisRequest& r = s.requests[k];
            ASSERT_EQ(judge({r.from, r.target, r.limits}, trajectory[k]), "");
        }
    }
    EXPECT_GT(straight, 300);
    EXPECT_GT(bent, 300);
}

TEST(StraightLine, IsTakenThereAndBackToTheSamePlace) {
    const std::array<double, kAxes> share{1, -0.5, 0.25};
    std::vector<AxisRequest> requests;
    requests.reserve(kAxes);
    Case scalar{state(0, 1, 0), rest(0), limits(2, 4, 40)};
    for (const double e : share) requests.push_back(along(scalar, e, 7, limits(2, 4, 40)));
    Trajectory trajectory{kAxes};
    ASSERT_TRUE(planAs(trajectory, Synchronisation::Phase, requests).ok());
    EXPECT_TRUE(trajectory.isStraight());
    EXPECT_LE(offLine(trajectory, requests, share), 1e-13);
    EXPECT_DOUBLE_EQ(trajectory.duration().count(),
                     plan(scalar.from, scalar.target, scalar.limits).value().duration().count());
}

TEST(StraightLine, IsKeptByAStop) {
    Random random{62};
    for (int i = 0; i < 500; ++i) {
        Straight s = onALine(random);
        for (AxisRequest& r : s.requests) r.target = {TargetKind::Velocity, state(0, 0, 0)};
        Trajectory trajectory{kAxes};
        const Seconds duration = planAs(trajectory, Synchronisation::Line, s.requests).value();
        if (duration == Seconds{}) continue;  // at rest
        ASSERT_TRUE(trajectory.isStraight());
        ASSERT_LE(offLine(trajectory, s.requests, s.share), 1e-11);
        for (std::size_t k = 0; k < kAxes; ++k) {
            const AxisRequest& r = s.requests[k];
            ASSERT_EQ(judge({r.from, r.target, r.limits}, trajectory[k]), "");
            ASSERT_EQ(sample(trajectory[k], duration).velocity.count(), 0.0);
        }
    }
}

TEST(StraightLine, IsKeptWhenPlannedAgainOnTheWayWithOtherLimits) {
    Random random{63};
    for (int i = 0; i < 1000; ++i) {
        const std::array<double, kAxes> share{1, random.uniform(-1, 1), random.uniform(-1, 1)};
        const Case scalar{state(0, 0, 0), rest(random.uniform(0.01, 500)), limits(1, 1, 1)};
        std::vector<AxisRequest> requests;
        requests.reserve(kAxes);
        for (const double e : share) {
            requests.push_back(along(scalar, e, random.uniform(-1e3, 1e3),
                                     limits(random.uniform(50, 500), random.uniform(500, 5e3),
                                            random.uniform(1e4, 1e5))));
        }
        Trajectory trajectory{kAxes};
        ASSERT_TRUE(planAs(trajectory, Synchronisation::Line, requests).ok());
        ASSERT_TRUE(trajectory.isStraight());
        std::array<State, kAxes> now{};
        // Up to the last thousandth: what is left of the way is mostly rounding then.
        trajectory.sample(trajectory.duration() * (0.999 * random.uniform()), now);
        for (std::size_t k = 0; k < kAxes; ++k) {
            requests[k].from = now[k];
            requests[k].limits.jerk = requests[k].limits.jerk * 1.5;
        }
        ASSERT_TRUE(planAs(trajectory, Synchronisation::Line, requests).ok());
        ASSERT_TRUE(trajectory.isStraight()) << i;
        std::array<State, kAxes> begin{};
        trajectory.sample(Seconds{}, begin);
        for (std::size_t k = 0; k < kAxes; ++k) {
            ASSERT_NEAR(begin[k].velocity.count(), now[k].velocity.count(), 1e-12 * 500);
            ASSERT_NEAR(begin[k].acceleration.count(), now[k].acceleration.count(), 1e-12 * 5e3);
        }
    }
}

TEST(StraightLine, IsNotDrawnThroughTheRoundingOfTheWay) {
    // The way of an ulp says nothing about a direction, and the velocities are not along it.
    const double p = 1000;
    const Limits l = limits(2, 4, 40);
    const std::vector<AxisRequest> requests{
        {state(p, 0.1, 0), rest(std::nextafter(p, 2 * p)), l},
        {state(p, 0.05, 0), rest(p), l},
    };
    Trajectory trajectory{2};
    ASSERT_TRUE(planAs(trajectory, Synchronisation::Line, requests).ok());
    std::array<State, 2> begin{};
    trajectory.sample(Seconds{}, begin);
    EXPECT_EQ(begin[0].velocity.count(), 0.1);
    EXPECT_EQ(begin[1].velocity.count(), 0.05);
}

TEST(StraightLine, OfSecondOrderIgnoresTheAccelerations) {
    const double inf = std::numeric_limits<double>::infinity();
    const std::vector<AxisRequest> requests{
        {state(0, 0, 0.3), rest(2), limits(1, 1, inf)},
        {state(0, 0, -0.7), rest(1), limits(1, 1, inf)},
    };
    Trajectory trajectory{2};
    EXPECT_DOUBLE_EQ(planAs(trajectory, Synchronisation::Line, requests).value().count(), 3.0);
    EXPECT_TRUE(trajectory.isStraight());
}

TEST(StraightLine, IsNotForTargetsOfDifferentKinds) {
    const std::vector<AxisRequest> requests{
        {state(0, 0.5, 0), rest(2), limits(1, 1, 1)},
        {state(0, 0.5, 0), {TargetKind::Velocity, state(0, 0, 0)}, limits(1, 1, 1)},
    };
    Trajectory trajectory{2};
    ASSERT_TRUE(planAs(trajectory, Synchronisation::Line, requests).ok());
    EXPECT_FALSE(trajectory.isStraight());
}

}  // namespace
}  // namespace takt::planner
