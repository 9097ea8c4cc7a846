#include "motor.hpp"

namespace takt::twin {

namespace {

constexpr double TwoPi = 6.283185307179586;
constexpr double BrakeTorque = 3.0;       // Nm, on top of the friction
constexpr double SmallestInertia = 1e-7;  // kg·m²

double magnitude(double value) noexcept {
    return value < 0.0 ? -value : value;
}

}  // namespace

Motor::Motor(const MechanicsParams& params) noexcept
    : params_{params},
      perTorque_{1.0 /
                 ((params.inertia > SmallestInertia ? params.inertia : SmallestInertia) * TwoPi)},
      hasBrake_{magnitude(params.loadTorque) > params.friction},
      position_{params.startTurns} {}

void Motor::step(double torque, bool braked, double seconds) noexcept {
    const double drive = torque - params_.loadTorque;
    const double friction = params_.friction + (braked ? BrakeTorque : 0.0);
    if (velocity_ == 0.0) {
        // Standing: only what exceeds the friction moves it.
        if (magnitude(drive) <= friction) return;
        velocity_ = (drive > 0.0 ? drive - friction : drive + friction) * perTorque_ * seconds;
    } else {
        const double against = velocity_ > 0.0 ? friction : -friction;
        const double next = velocity_ + (drive - against) * perTorque_ * seconds;
        // Friction stops the motor but never turns it round.
        const bool crosses = (velocity_ > 0.0) != (next > 0.0);
        velocity_ = crosses && magnitude(drive) <= friction ? 0.0 : next;
    }
    position_ += velocity_ * seconds;
    meetHardStops();
}

void Motor::meetHardStops() noexcept {
    if (params_.hardStopPositive && position_ >= *params_.hardStopPositive && velocity_ > 0.0) {
        position_ = *params_.hardStopPositive;
        velocity_ = 0.0;
    }
    if (params_.hardStopNegative && position_ <= *params_.hardStopNegative && velocity_ < 0.0) {
        position_ = *params_.hardStopNegative;
        velocity_ = 0.0;
    }
}

}  // namespace takt::twin
