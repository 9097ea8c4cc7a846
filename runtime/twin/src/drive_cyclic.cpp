// The modes in which the controller gives a set-point every cycle, and Profile torque.

#include <algorithm>
#include <cmath>

#include "drive.hpp"

namespace takt::twin {

namespace cia = core::cia402;
using core::cia402::Mode;

namespace {

constexpr double SecondsPerMinute = 60.0;
constexpr double PerMille = 1000.0;
constexpr double MillisecondsPerSecond = 1000.0;

}  // namespace

bool Drive::haltCyclic(std::uint16_t controlWord) noexcept {
    const bool halt = traits_.haltInCyclicModes && (controlWord & cia::Halt) != 0;
    if (halt && !halted_) rampDown(haltDeceleration());
    halted_ = halt;
    return halt;
}

Drive::SoftLimits Drive::softLimits() const noexcept {
    if (dictionary_.getUnsigned(objects_.softLimitsOn) == 0) return {};
    SoftLimits limits{true, dictionary_.getSigned(objects_.softLimitMinimum),
                      dictionary_.getSigned(objects_.softLimitMaximum)};
    if (limits.minimum >= limits.maximum) return {};
    const bool wired = motor_.params().negativeLimit || motor_.params().positiveLimit;
    if (wired && traits_.softLimitsYieldToSwitches) return {};
    if (homed_ && traits_.softLimitsLessHomeOffset) {
        const std::int64_t offset = dictionary_.getSigned(objects_.homeOffset);
        limits.minimum -= offset;
        limits.maximum -= offset;
    }
    // An axis that stands outside is not made to jump: it may move inwards only.
    const std::int64_t present = userPosition(demand_.position);
    limits.minimum = std::min(limits.minimum, present);
    limits.maximum = std::max(limits.maximum, present);
    return limits;
}

void Drive::stepPosition(std::uint16_t controlWord) noexcept {
    const auto received =
        static_cast<std::uint32_t>(dictionary_.getUnsigned(objects_.targetPosition));
    // 607Ah is a 32-bit window on an unbounded position: the nearest one is meant.
    target_ += static_cast<std::int32_t>(received - static_cast<std::uint32_t>(target_));
    if (haltCyclic(controlWord)) return;
    std::int64_t wanted = target_ + dictionary_.getSigned(objects_.positionOffset);
    const SoftLimits limits = softLimits();
    softLimited_ = limits.active && (wanted < limits.minimum || wanted > limits.maximum);
    if (softLimited_) wanted = std::clamp(wanted, limits.minimum, limits.maximum);
    const double target = turnsOf(wanted);
    blocked_ = limitAhead(target - demand_.position);
    interpolateTo(blocked_ ? demand_.position : target);
}

void Drive::interpolateTo(double target) noexcept {
    const double distance = target - demand_.position;
    const double velocity = distance / (stepSeconds_ * subSteps_);
    demand_.acceleration = (velocity - demand_.velocity) / (stepSeconds_ * subSteps_);
    demand_.velocity = velocity;
    interpolation_ = distance / subSteps_;
    interpolationEnd_ = target;
    stepsLeft_ = subSteps_;
    source_ = Source::Interpolator;
}

double Drive::speedWithinLimits(double velocity, double deceleration) noexcept {
    blocked_ = limitAhead(velocity);
    if (blocked_) return 0.0;
    const SoftLimits limits = softLimits();
    softLimited_ = false;
    if (!limits.active || velocity == 0.0) return velocity;
    // No faster than from where it can stop at the limit.
    const double end = turnsOf(velocity > 0.0 ? limits.maximum : limits.minimum);
    const double way = velocity > 0.0 ? end - motor_.position() : motor_.position() - end;
    const double allowed = way > 0.0 ? std::sqrt(2.0 * deceleration * way) : 0.0;
    softLimited_ = std::abs(velocity) > allowed;
    return std::clamp(velocity, -allowed, allowed);
}

void Drive::stepVelocity(std::uint16_t controlWord) noexcept {
    if (haltCyclic(controlWord)) return;
    const double limit = speedLimit(false);
    const double wanted = velocityTurns(dictionary_.getSigned(objects_.targetVelocity) +
                                        dictionary_.getSigned(objects_.velocityOffset));
    const double velocity =
        speedWithinLimits(std::clamp(wanted, -limit, limit), rate(objects_.profileDeceleration));
    const double change = velocity - demand_.velocity;
    demand_.acceleration = change / (stepSeconds_ * subSteps_);
    interpolation_ = change / subSteps_;
    interpolationEnd_ = velocity;
    stepsLeft_ = subSteps_;
    source_ = Source::Speed;
}

void Drive::stepTorque(std::uint16_t controlWord) noexcept {
    const bool cyclic = inMode(Mode::CyclicSynchronousTorque);
    const auto most = static_cast<std::int64_t>(dictionary_.getUnsigned(objects_.maxTorque));
    std::int64_t wanted = std::clamp(dictionary_.getSigned(objects_.targetTorque), -most, most);
    if (cyclic) wanted += dictionary_.getSigned(objects_.torqueOffset);
    halted_ = !cyclic && (controlWord & cia::Halt) != 0;
    if (halted_) wanted = 0;
    torqueTarget_ = static_cast<double>(wanted) / PerMille * traits_.ratedTorque;
    const auto slope = static_cast<double>(dictionary_.getUnsigned(objects_.torqueSlope));
    const double perSecond =
        slope == 0.0 || traits_.torqueSlopeIsTime ? 0.0 : slope / PerMille * traits_.ratedTorque;
    torqueStep_ = perSecond * stepSeconds_;
    if (slope != 0.0 && traits_.torqueSlopeIsTime) {
        torqueStep_ = traits_.ratedTorque / (slope / MillisecondsPerSecond) * stepSeconds_;
    }
    torqueSpeed_ = speedLimit(traits_.profileSpeedInTorque);
    const std::uint64_t own = dictionary_.getUnsigned(objects_.torqueModeSpeed);
    if (own != 0)
        torqueSpeed_ = std::min(torqueSpeed_, static_cast<double>(own) / SecondsPerMinute);
    source_ = Source::Torque;
}

}  // namespace takt::twin
