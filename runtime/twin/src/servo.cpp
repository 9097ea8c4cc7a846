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
}

double Servo::torque(const Demand& demand, const Motor& motor, double positiveLimit,
                     double negativeLimit) noexcept {
    const double velocity = motor.velocity();
    const double achieved = (velocity - lastVelocity_) / step_;
    // What of the last torque did not accelerate the motor was friction and load: needed again.
    const double disturbance = torque_ - achieved / perTorque_;
    const double wantedVelocity =
        demand.velocity + positionGain_ * (demand.position - motor.position());
    const double wanted = demand.acceleration + velocityGain_ * (wantedVelocity - velocity);
    const double upper = std::min(torqueLimit_, positiveLimit);
    const double lower = -std::min(torqueLimit_, negativeLimit);
    torque_ = std::clamp(wanted / perTorque_ + disturbance, lower, upper);
    lastVelocity_ = velocity;
    return torque_;
}

}  // namespace takt::twin
