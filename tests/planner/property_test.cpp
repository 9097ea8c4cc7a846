#include <gtest/gtest.h>
#include <rapidcheck.h>
// rapidcheck's own header needs GoogleTest's before it
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <takt/planner/profile_query.hpp>
#include <takt/planner/trajectory.hpp>
#include <vector>

#include "problems.hpp"
#include "reachable.hpp"

// Every property takes a seed, which rapidcheck prints when it fails.
namespace takt::planner {
namespace {

using core::Seconds;
using test::Case;
using test::judge;
using test::Random;
using test::reachable;

/// The same problems in every run of the suite; RC_PARAMS in the environment asks for others, and
/// for more.
const int kParametersSet = setenv("RC_PARAMS", "seed=4711 max_success=500", 0);

Case anyCase(Random& random) {
    switch (random.integer(0, 3)) {
        case 0:
            return test::ordinary(random);
        case 1:
            return test::wide(random);
        case 2:
            return test::near(random);
        default:
            return test::saturated(random);
    }
}

double durationOf(const Case& c) {
    const auto result = plan(c.from, c.target, c.limits);
    RC_ASSERT(result.ok());
    return result.value().duration().count();
}

TEST(PlannerProperty, SeedsCanBeGivenFromOutside) {
    EXPECT_EQ(kParametersSet, 0);
}

RC_GTEST_PROP(PlannerProperty, AProfileKeepsItsLimitsAndReachesItsTarget, (std::uint64_t seed)) {
    Random random{seed};
    const Case c = random.chance(0.8) ? anyCase(random) : test::outside(random);
    const auto result = plan(c.from, c.target, c.limits);
    RC_ASSERT(result.ok());
    RC_ASSERT(judge(c, result.value()) == "");
}

RC_GTEST_PROP(PlannerProperty, TheDurationIsTheLeastPossible, (std::uint64_t seed)) {
    Random random{seed};
    const Case c = random.chance(0.7) ? test::ordinary(random) : test::saturated(random);
    const double least = durationOf(c);
    RC_ASSERT(reachable(c, least * (1 + 1e-12L), 1e-11L));
    for (int i = 0; i < 40; ++i) {
        RC_ASSERT(!reachable(c, least * (1 - 1e-6) * (i + 0.5 * random.uniform() + 0.5) / 40, 0));
    }
    RC_ASSERT(!reachable(c, least * (1 - 1e-7), 0));
}

RC_GTEST_PROP(PlannerProperty, EveryDurationOfTheIntervalsIsPossibleAndNoOther,
              (std::uint64_t seed)) {
    Random random{seed};
    const Case c = random.chance(0.7) ? test::ordinary(random) : test::saturated(random);
    const auto intervals = possibleDurations(c.from, c.target, c.limits).value();
    RC_ASSERT(!intervals.empty());
    const double last = intervals.back().from.count();
    for (int i = 0; i < 40; ++i) {
        const double duration = 1.5 * last * random.uniform() + 1e-9;
        bool inside = false;
        bool close = false;
        for (const auto& interval : intervals) {
            inside =
                inside || (duration >= interval.from.count() && duration <= interval.to.count());
            close = close || std::fabs(duration - interval.from.count()) < 1e-6 * last ||
                    std::fabs(duration - interval.to.count()) < 1e-6 * last;
        }
        if (close) continue;
        RC_ASSERT(reachable(c, duration, 0) == inside);
        const auto profile = planLasting(c.from, c.target, c.limits, Seconds{duration});
        RC_ASSERT(profile.ok() == inside);
        if (inside) {
            RC_ASSERT(judge(c, profile.value()) == "");
            RC_ASSERT(std::fabs(profile.value().duration().count() - duration) <= 1e-12 * duration);
        }
    }
}

RC_GTEST_PROP(PlannerProperty, TimeReversedItTakesAsLong, (std::uint64_t seed)) {
    Random random{seed};
    const Case c = anyCase(random);
    const auto& f = c.from;
    const auto& t = c.target.state;
    const Case reversed{
        test::state(t.position.count(), -t.velocity.count(), t.acceleration.count()),
        {TargetKind::State,
         test::state(f.position.count(), -f.velocity.count(), f.acceleration.count())},
        {-c.limits.minVelocity, -c.limits.maxVelocity, c.limits.maxAcceleration,
         c.limits.minAcceleration, c.limits.jerk}};
    const double duration = durationOf(c);
    RC_ASSERT(std::fabs(durationOf(reversed) - duration) <= 1e-9 * duration);
}

RC_GTEST_PROP(PlannerProperty, LargerLimitsNeverTakeLonger, (std::uint64_t seed)) {
    Random random{seed};
    const Case c = random.chance(0.5) ? test::ordinary(random) : test::wide(random);
    Case larger = c;
    larger.limits = {
        c.limits.maxVelocity * random.uniform(1, 2), c.limits.minVelocity * random.uniform(1, 2),
        c.limits.maxAcceleration * random.uniform(1, 2),
        c.limits.minAcceleration * random.uniform(1, 2), c.limits.jerk * random.uniform(1, 2)};
    RC_ASSERT(durationOf(larger) <= durationOf(c) * (1 + 1e-11));
}

RC_GTEST_PROP(PlannerProperty, ADetourIsNeverShorter, (std::uint64_t seed)) {
    Random random{seed};
    const Case c = test::ordinary(random);
    Case first = c;
    first.target = test::ordinary(random).target;
    const double swing =
        std::pow(first.target.state.acceleration.count(), 2) / (2 * c.limits.jerk.count());
    RC_PRE(!findFault(first.from, first.target, first.limits).has_value() && swing >= 0);
    const Case second{first.target.state, c.target, c.limits};
    RC_ASSERT(durationOf(c) <= (durationOf(first) + durationOf(second)) * (1 + 1e-11));
}

RC_GTEST_PROP(PlannerProperty, PlannedAgainOnTheWayItTakesTheRest, (std::uint64_t seed)) {
    Random random{seed};
    const Case c = test::ordinary(random);
    const Profile profile = plan(c.from, c.target, c.limits).value();
    const double duration = profile.duration().count();
    const double t = duration * random.uniform();
    const Case rest{sample(profile, Seconds{t}), c.target, c.limits};
    RC_ASSERT(std::fabs(durationOf(rest) - (duration - t)) <= 1e-9 * (1 + duration));
}

std::vector<AxisRequest> requestsOf(Random& random, std::size_t axes) {
    std::vector<AxisRequest> requests;
    for (std::size_t i = 0; i < axes; ++i) {
        const Case c = random.chance(0.7) ? test::ordinary(random) : test::saturated(random);
        requests.push_back({c.from, c.target, c.limits});
    }
    return requests;
}

RC_GTEST_PROP(PlannerProperty, AxesArriveTogetherWhateverTheirOrder, (std::uint64_t seed)) {
    Random random{seed};
    std::vector<AxisRequest> requests = requestsOf(random, 5);
    requests.push_back(requests.front());  // a twin of the first
    Trajectory trajectory{requests.size()};
    const auto duration = trajectory.plan(requests, {});
    RC_ASSERT(duration.ok());
    for (std::size_t i = 0; i < requests.size(); ++i) {
        RC_ASSERT(trajectory[i].duration() == duration.value());
        RC_ASSERT(
            judge({requests[i].from, requests[i].target, requests[i].limits}, trajectory[i]) == "");
    }
    for (int k = 0; k <= 10; ++k) {
        const Seconds t = duration.value() * (k / 10.0);
        RC_ASSERT(sample(trajectory[0], t).position ==
                  sample(trajectory[requests.size() - 1], t).position);
    }
    std::reverse(requests.begin(), requests.end());
    Trajectory other{requests.size()};
    const double again = other.plan(requests, {}).value().count();
    RC_ASSERT(std::fabs(again - duration.value().count()) <= 1e-12 * again);
}

RC_GTEST_PROP(PlannerProperty, DurationsInWholeCyclesAreTheLeastPossible, (std::uint64_t seed)) {
    Random random{seed};
    const std::vector<AxisRequest> requests = requestsOf(random, 3);
    Timing timing;
    timing.cycle = Seconds{0.05};
    Trajectory trajectory{requests.size()};
    const double duration = trajectory.plan(requests, timing).value().count();
    const double cycles = duration / 0.05;
    RC_ASSERT(std::fabs(cycles - std::round(cycles)) < 1e-9);
    for (int k = 1; k <= 20 && duration - 0.05 * k > 0; ++k) {
        const double earlier = duration - 0.05 * k;
        bool all = true;
        for (const auto& r : requests) {
            all = all && reachable({r.from, r.target, r.limits}, earlier * (1 - 1e-9L), 0);
        }
        RC_ASSERT(!all);
    }
}

RC_GTEST_PROP(PlannerProperty, FirstTimesAndExtremesAgreeWithSamples, (std::uint64_t seed)) {
    Random random{seed};
    const Case c = random.chance(0.7) ? test::ordinary(random) : test::outside(random);
    const Profile profile = plan(c.from, c.target, c.limits).value();
    const double duration = profile.duration().count();
    const PositionExtremes e = extremesOf(profile);
    const double scale = std::fabs(e.lowest.count()) + std::fabs(e.highest.count());
    for (int k = 0; k <= 50; ++k) {
        const double t = duration * k / 50;
        const State s = sample(profile, Seconds{t});
        RC_ASSERT(s.position.count() >= e.lowest.count() - 1e-12 * scale);
        RC_ASSERT(s.position.count() <= e.highest.count() + 1e-12 * scale);
        const auto first = firstTimeAt(profile, s.position);
        RC_ASSERT(first.has_value());
        RC_ASSERT(first->count() <= t + 1e-6 * duration);
        RC_ASSERT(std::fabs(sample(profile, *first).position.count() - s.position.count()) <=
                  1e-11 * scale);
    }
    RC_ASSERT(!firstTimeAt(profile, e.highest + core::Distance{scale + 1}).has_value());
}

}  // namespace
}  // namespace takt::planner
