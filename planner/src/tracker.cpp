#include <algorithm>
#include <cmath>
#include <takt/planner/profile_query.hpp>
#include <takt/planner/tracker.hpp>

namespace takt::planner {

using core::Acceleration;
using core::Position;
using core::Seconds;
using core::Velocity;

namespace {

constexpr int kDoublings = 24;
constexpr int kHalvings = 30;

/// Where the target is after `time`, with its acceleration until it reaches what the follower can
/// do.
State predicted(const State& target, const Limits& limits, double time) noexcept {
    const double v =
        std::clamp(target.velocity.count(), limits.minVelocity.count(), limits.maxVelocity.count());
    const double a = std::clamp(target.acceleration.count(), limits.minAcceleration.count(),
                                limits.maxAcceleration.count());
    // The acceleration has to go back to zero at full jerk before the limit is reached.
    const double swing = 0.5 * a * std::fabs(a) / limits.jerk.count();
    const double room =
        a > 0.0 ? limits.maxVelocity.count() - v - swing : limits.minVelocity.count() - v - swing;
    const double until = a != 0.0 ? std::max(0.0, room / a) : 0.0;
    const double p = target.position.count();
    if (time < until) {
        return {Position{p + time * (v + 0.5 * a * time)}, Velocity{v + a * time}, Acceleration{a}};
    }
    const double end = v + a * until;
    return {Position{p + until * (v + 0.5 * a * until) + end * (time - until)}, Velocity{end}, {}};
}

}  // namespace

void Tracker::reset(const State& state) noexcept {
    profile_ = Profile::holding(state);
    cyclesDone_ = 0.0;
    planned_ = false;
    synchronous_ = false;
}

bool Tracker::isAsPredicted(const State& target) const noexcept {
    if (!planned_) return false;
    const double t = (cycle_ * cyclesDone_).count();
    const double v = target_.velocity.count();
    const double a = target_.acceleration.count();
    const double way = std::fabs(v) * t + 0.5 * std::fabs(a) * t * t;
    const double p = target_.position.count() + t * (v + 0.5 * a * t);
    return std::fabs(target.position.count() - p) <= 1e-12 * (std::fabs(p) + way) &&
           std::fabs(target.velocity.count() - (v + a * t)) <=
               1e-12 * (std::fabs(v) + std::fabs(a) * t) &&
           std::fabs(target.acceleration.count() - a) <= 1e-12 * std::fabs(a);
}

core::Result<Profile, PlanError> Tracker::intercept(const State& from,
                                                    const State& target) const noexcept {
    // The first T in which the place where the target then is can be reached: below it the fastest
    // way takes longer.
    const auto late = [&](double time) {
        const auto result =
            plan(from, {TargetKind::State, predicted(target, limits_, time)}, limits_);
        return !result.ok() || result.value().duration().count() > time;
    };
    if (!late(0.0)) return plan(from, {TargetKind::State, target}, limits_);
    double hi = cycle_.count();
    double lo = 0.0;
    for (int i = 0; i < kDoublings && late(hi); ++i) {
        lo = hi;
        hi *= 2.0;
    }
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (lo + hi);
        (late(middle) ? lo : hi) = middle;
    }
    const Target meeting{TargetKind::State, predicted(target, limits_, hi)};
    const auto exact = planLasting(from, meeting, limits_, Seconds{hi});
    return exact.ok() ? exact : plan(from, meeting, limits_);
}

core::Result<State, PlanError> Tracker::step(const State& target) noexcept {
    if (!std::isfinite(target.position.count()) || !std::isfinite(target.velocity.count()) ||
        !std::isfinite(target.acceleration.count())) {
        return PlanError::NotFinite;
    }
    if (!isAsPredicted(target)) {
        const State now = sample(profile_, cycle_ * cyclesDone_);
        const auto result = intercept(now, target);
        if (!result.ok()) return result.error();
        profile_ = result.value();
        target_ = target;
        cyclesDone_ = 0.0;
        planned_ = true;
    }
    cyclesDone_ += 1.0;
    const Seconds time = cycle_ * cyclesDone_;
    synchronous_ = time >= profile_.duration();
    return sample(profile_, time);
}

}  // namespace takt::planner
