#include <algorithm>
#include <cmath>
#include <takt/planner/tracker.hpp>

#include "intercept.hpp"

namespace takt::planner {

using core::Acceleration;
using core::Seconds;
using core::Velocity;

namespace {

/// What rounding may add to a target on its limit, or to one that goes on as it did.
constexpr double kRounding = 1e-12;

bool isFinite(const State& s) noexcept {
    return std::isfinite(s.position.count()) && std::isfinite(s.velocity.count()) &&
           std::isfinite(s.acceleration.count());
}

/// The velocity nearest to the target's.
core::Result<Profile, PlanError> runAfter(const State& from, const State& target,
                                          const Limits& limits) noexcept {
    const Velocity velocity = std::clamp(target.velocity, limits.minVelocity, limits.maxVelocity);
    return plan(from, {TargetKind::Velocity, {from.position, velocity, {}}}, limits);
}

}  // namespace

void Tracker::reset(const State& state) noexcept {
    profile_ = Profile::holding(state);
    cyclesDone_ = 0.0;
    leadsToTarget_ = false;
    synchronous_ = false;
}

bool Tracker::isAsPredicted(const State& target) const noexcept {
    const double t = (cycle_ * cyclesDone_).count();
    const double v = target_.velocity.count();
    const double a = target_.acceleration.count();
    const double way = std::fabs(v) * t + 0.5 * std::fabs(a) * t * t;
    const double p = target_.position.count() + t * (v + 0.5 * a * t);
    return std::fabs(target.position.count() - p) <= kRounding * (std::fabs(p) + way) &&
           std::fabs(target.velocity.count() - (v + a * t)) <=
               kRounding * (std::fabs(v) + std::fabs(a) * t) &&
           std::fabs(target.acceleration.count() - a) <= kRounding * std::fabs(a);
}

/// Whether the target is within the limits in the next cycle too, and stays there if its
/// acceleration is then taken back.
bool Tracker::canBeFollowed(const State& target) const noexcept {
    const double a = target.acceleration.count();
    const double now = target.velocity.count();
    const double next = now + a * cycle_.count();
    const double swing = 0.5 * a * a / limits_.jerk.count();
    const double highest = std::max(now, next) + (a > 0.0 ? swing : 0.0);
    const double lowest = std::min(now, next) - (a < 0.0 ? swing : 0.0);
    const double slack = 1.0 + kRounding;
    return highest <= limits_.maxVelocity.count() * slack &&
           lowest >= limits_.minVelocity.count() * slack &&
           a <= limits_.maxAcceleration.count() * slack &&
           a >= limits_.minAcceleration.count() * slack;
}

std::optional<PlanError> Tracker::planAgain(const State& target) noexcept {
    const State now = sample(profile_, cycle_ * cyclesDone_);
    const bool follow = canBeFollowed(target);
    const bool uniform = !follow || target.acceleration == Acceleration{};
    auto result = uniform ? detail::interceptUniform(now, target, limits_)
                          : detail::interceptAccelerated(now, target, limits_, cycle_.count());
    leadsToTarget_ = follow && result.ok();
    if (!result.ok()) result = runAfter(now, target, limits_);
    if (!result.ok()) return result.error();
    profile_ = result.value();
    target_ = target;
    cyclesDone_ = 0.0;
    return std::nullopt;
}

std::optional<PlanError> Tracker::step(const State& target, State& set) noexcept {
    std::optional<PlanError> error;
    if (!isFinite(target)) {
        error = PlanError::NotFinite;
        leadsToTarget_ = false;
    } else if (!leadsToTarget_ || !isAsPredicted(target) || !canBeFollowed(target)) {
        error = planAgain(target);
    }
    cyclesDone_ += 1.0;
    const Seconds time = cycle_ * cyclesDone_;
    synchronous_ = leadsToTarget_ && time >= profile_.duration();
    set = sample(profile_, time);
    return error;
}

}  // namespace takt::planner
