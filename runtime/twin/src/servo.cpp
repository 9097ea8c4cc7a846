#include "servo.hpp"

#include <algorithm>

namespace takt::twin {

namespace {

constexpr double LargestBandwidth = 900.0;  // rad/s of the velocity loop
constexpr double StepShare = 0.3;  // bandwidth · step that a sampled loop bears with margin
constexpr double LoopRatio = 4.0;  // velocity loop faster than position loop

}  // namespace

Servo::Servo(const Motor& motor, double stepSeconds, double torqueLimit) noexcept
    : step_{stepSeconds},
      torqueLimit_{torqueLimit},
      velocityGain_{std::min(LargestBandwidth, StepShare / stepSeconds)},
      positionGain_{velocityGain_ / LoopRatio},
      perTorque_{motor.accelerationPerTorque()} {}

void Servo::reset(const Motor& motor) noexcept {
    torque_ = motor.params().loadTorque;
    lastVelocity_ = motor.velocity();
    lastOffset_ = 0.0;
}

double Servo::disturbance(const Motor& motor) const noexcept {
    // What of the last torque did not accelerate the motor was friction and load: needed again.
    const double achieved = (motor.velocity() - lastVelocity_) / step_;
    return torque_ - achieved / perTorque_;
}

double Servo::bounded(double torque, const Motor& motor, const TorqueBounds& bounds) noexcept {
    const double upper = std::min(torqueLimit_, bounds.positive);
    const double lower = -std::min(torqueLimit_, bounds.negative);
    torque_ = std::clamp(torque, lower, upper);
    lastVelocity_ = motor.velocity();
    lastOffset_ = bounds.offset;
    return torque_;
}

double Servo::torque(const Demand& demand, const Motor& motor,
                     const TorqueBounds& bounds) noexcept {
    const double wantedVelocity =
        demand.velocity + positionGain_ * (demand.position - motor.position());
    const double wanted = demand.acceleration + velocityGain_ * (wantedVelocity - motor.velocity());
    // The observer keeps what was added before: only the change of the offset is new.
    const double load = disturbance(motor) + (bounds.offset - lastOffset_);
    return bounded(wanted / perTorque_ + load, motor, bounds);
}

double Servo::limited(double wanted, double speedLimit, const Motor& motor,
                      const TorqueBounds& bounds) noexcept {
    const double load = disturbance(motor);
    const auto holding = [&](double speed) {
        return velocityGain_ * (speed - motor.velocity()) / perTorque_ + load;
    };
    const double torque = std::clamp(wanted, holding(-speedLimit), holding(speedLimit));
    return bounded(torque, motor, bounds);
}

}  // namespace takt::twin
