#pragma once

#include "motor.hpp"

namespace takt::twin {

/// What the drive wants of its motor at one instant; turns of the motor shaft.
struct Demand {
    double position{0.0};
    double velocity{0.0};
    double acceleration{0.0};
};

/// The position and velocity loop of a tuned servo drive: feed-forward of velocity and
/// acceleration, and an observer that learns friction and load from the difference between torque
/// and acceleration, so that nothing winds up at the torque limit.
class Servo {
public:
    /// `stepSeconds`: the fixed step of the loop. `torqueLimit` in Nm.
    Servo(const Motor& motor, double stepSeconds, double torqueLimit) noexcept;

    /// rt. The power stage was switched on: the observer starts from the load that a brake has
    /// held.
    void reset(const Motor& motor) noexcept;
    /// rt. The torque for the next step. `positiveLimit`, `negativeLimit`: further limits in Nm.
    double torque(const Demand& demand, const Motor& motor, double positiveLimit,
                  double negativeLimit) noexcept;

private:
    double step_;
    double torqueLimit_;
    double velocityGain_;  ///< 1/s
    double positionGain_;  ///< 1/s
    double perTorque_;
    double torque_{0.0};
    double lastVelocity_{0.0};
};

}  // namespace takt::twin
