#include "validation.hpp"

#include <cmath>

#include "problem.hpp"

namespace takt::planner::detail {

namespace {

bool isFinite(const State& state) noexcept {
    return std::isfinite(state.position.count()) && std::isfinite(state.velocity.count()) &&
           std::isfinite(state.acceleration.count());
}

bool validLimits(const Limits& limits) noexcept {
    return limits.maxVelocity.count() > 0.0 && limits.minVelocity.count() < 0.0 &&
           limits.maxAcceleration.count() > 0.0 && limits.minAcceleration.count() < 0.0 &&
           limits.jerk.count() > 0.0;
}

/// The target must be reachable within the limits and let them be kept afterwards.
bool viable(const Target& target, const Limits& limits) noexcept {
    const double v = target.state.velocity.count();
    const double a = target.state.acceleration.count();
    if (a > limits.maxAcceleration.count() * (1.0 + kClip)) return false;
    if (a < limits.minAcceleration.count() * (1.0 + kClip)) return false;
    const double swing = 0.5 * a * a / limits.jerk.count();
    return v + swing <= limits.maxVelocity.count() * (1.0 + kClip) &&
           v - swing >= limits.minVelocity.count() * (1.0 + kClip);
}

}  // namespace

std::optional<PlanError> findError(const State& from, const Target& target,
                                   const Limits& limits) noexcept {
    const bool finite =
        isFinite(from) && isFinite(target.state) && !std::isnan(limits.maxVelocity.count()) &&
        !std::isnan(limits.minVelocity.count()) && std::isfinite(limits.maxAcceleration.count()) &&
        std::isfinite(limits.minAcceleration.count()) && std::isfinite(limits.jerk.count());
    if (!finite) return PlanError::NotFinite;
    if (!validLimits(limits)) return PlanError::InvalidLimits;
    if (!viable(target, limits)) return PlanError::TargetNotViable;
    return std::nullopt;
}

}  // namespace takt::planner::detail
