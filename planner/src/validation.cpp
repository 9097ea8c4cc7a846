#include <cmath>
#include <takt/planner/profile.hpp>

#include "problem.hpp"

namespace takt::planner {

namespace {

using detail::kClip;

struct Number {
    double value;
    InputField field;
};

std::optional<InputFault> checkStates(const State& from, const Target& target) noexcept {
    const Number numbers[] = {
        {from.position.count(), InputField::StartPosition},
        {from.velocity.count(), InputField::StartVelocity},
        {from.acceleration.count(), InputField::StartAcceleration},
        {target.state.position.count(), InputField::TargetPosition},
        {target.state.velocity.count(), InputField::TargetVelocity},
        {target.state.acceleration.count(), InputField::TargetAcceleration},
    };
    for (const Number& number : numbers) {
        if (!std::isfinite(number.value)) return InputFault{PlanError::NotFinite, number.field, 0};
    }
    return std::nullopt;
}

/// \param sign of the limit; `mayBeInfinite` if that switches it off
std::optional<InputFault> checkLimit(double value, double sign, bool mayBeInfinite,
                                     InputField field) noexcept {
    if (std::isnan(value)) return InputFault{PlanError::NotFinite, field, 0};
    if (!(value * sign > 0.0)) return InputFault{PlanError::InvalidLimits, field, 0};
    if (std::isinf(value) && !mayBeInfinite) return InputFault{PlanError::NotFinite, field, 0};
    return std::nullopt;
}

std::optional<InputFault> checkLimits(const Limits& limits, TargetKind kind) noexcept {
    const bool free = kind == TargetKind::Velocity;
    const bool second = std::isinf(limits.jerk.count());
    const bool first = second && std::isinf(limits.maxAcceleration.count()) &&
                       std::isinf(limits.minAcceleration.count());
    auto fault = checkLimit(limits.maxVelocity.count(), 1.0, free, InputField::MaxVelocity);
    if (!fault) fault = checkLimit(limits.minVelocity.count(), -1.0, free, InputField::MinVelocity);
    if (!fault) {
        fault = checkLimit(limits.maxAcceleration.count(), 1.0, first, InputField::MaxAcceleration);
    }
    if (!fault) {
        fault =
            checkLimit(limits.minAcceleration.count(), -1.0, first, InputField::MinAcceleration);
    }
    if (!fault) fault = checkLimit(limits.jerk.count(), 1.0, true, InputField::Jerk);
    return fault;
}

/// The target must be reachable within the limits and let them be kept afterwards.
std::optional<InputFault> checkTarget(const Target& target, const Limits& limits) noexcept {
    const auto refuse = [](InputField field) {
        return InputFault{PlanError::TargetNotViable, field, 0};
    };
    const double v = target.state.velocity.count();
    const double a = target.state.acceleration.count();
    const bool jerkLimited = std::isfinite(limits.jerk.count());
    if (jerkLimited && (a > limits.maxAcceleration.count() * (1.0 + kClip) ||
                        a < limits.minAcceleration.count() * (1.0 + kClip))) {
        return refuse(InputField::TargetAcceleration);
    }
    const double swing = jerkLimited ? 0.5 * a * a / limits.jerk.count() : 0.0;
    if (v + swing > limits.maxVelocity.count() * (1.0 + kClip) ||
        v - swing < limits.minVelocity.count() * (1.0 + kClip)) {
        return refuse(InputField::TargetVelocity);
    }
    return std::nullopt;
}

}  // namespace

std::optional<InputFault> findFault(const State& from, const Target& target,
                                    const Limits& limits) noexcept {
    auto fault = checkStates(from, target);
    if (!fault) fault = checkLimits(limits, target.kind);
    if (!fault) fault = checkTarget(target, limits);
    return fault;
}

}  // namespace takt::planner
