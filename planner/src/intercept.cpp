#include "intercept.hpp"

#include <algorithm>
#include <cmath>
#include <takt/planner/profile_query.hpp>

#include "profile_builder.hpp"

namespace takt::planner::detail {

using core::Acceleration;
using core::Position;
using core::Seconds;
using core::Velocity;

namespace {

/// The search: from one duration to the next, and back to where it becomes possible.
constexpr double kStep = 2.0;
constexpr int kSteps = 24;
constexpr int kHalvings = 30;

/// Where the target is after `time`.
State predicted(const State& target, const Limits& limits, double time) noexcept {
    const double p = target.position.count();
    const double v = target.velocity.count();
    const double a = target.acceleration.count();
    // The acceleration has to go back to zero at full jerk before the limit is reached.
    const double swing = 0.5 * a * std::fabs(a) / limits.jerk.count();
    const double limit = (a > 0.0 ? limits.maxVelocity : limits.minVelocity).count();
    const double until = a != 0.0 ? std::max(0.0, (limit - v - swing) / a) : 0.0;
    if (time < until) {
        return {Position{p + time * (v + 0.5 * a * time)}, Velocity{v + a * time}, Acceleration{a}};
    }
    const double end = v + a * until;
    return {Position{p + until * (v + 0.5 * a * until) + end * (time - until)}, Velocity{end}, {}};
}

}  // namespace

core::Result<Profile, PlanError> interceptUniform(const State& from, const State& target,
                                                  const Limits& limits) noexcept {
    Limits left = limits;
    left.maxVelocity = limits.maxVelocity - target.velocity;
    left.minVelocity = limits.minVelocity - target.velocity;
    const State start{Position{(from.position - target.position).count()},
                      from.velocity - target.velocity, from.acceleration};
    const auto relative = plan(start, {TargetKind::State, {}}, left);
    if (!relative.ok()) return relative.error();
    Profile profile;
    ProfileBuilder::carried(relative.value(), target, profile);
    return profile;
}

core::Result<Profile, PlanError> interceptAccelerated(const State& from, const State& target,
                                                      const Limits& limits,
                                                      double shortest) noexcept {
    // Who has met the target can stay with it: what is possible in one duration is possible in all
    // longer ones.
    core::Result<Profile, PlanError> met = PlanError::NoSolution;
    const auto meets = [&](double time) {
        const Target meeting{TargetKind::State, predicted(target, limits, time)};
        const auto result = planLasting(from, meeting, limits, Seconds{time});
        if (result.ok()) met = result;
        return result.ok();
    };
    double lo = 0.0;
    double hi = shortest;
    for (int i = 0; i < kSteps && !meets(hi); ++i) {
        lo = hi;
        hi *= kStep;
    }
    for (int i = 0; i < kHalvings && met.ok(); ++i) {
        const double middle = 0.5 * (lo + hi);
        (meets(middle) ? hi : lo) = middle;
    }
    return met;
}

}  // namespace takt::planner::detail
