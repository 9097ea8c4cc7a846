#pragma once

#include "motor.hpp"

namespace takt::twin {

/// What the drive wants of its motor at one instant; turns of the motor shaft.
struct Demand {
    double position{0.0};
    double velocity{0.0};
    double acceleration{0.0};
};

/// What the torque must stay within and what is added to it; Nm.
struct TorqueBounds {
    double positive{0.0};  ///< at most this
    double negative{0.0};  ///< at least minus this
    double offset{0.0};    ///< feed-forward
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
    /// rt. The torque for the next step of the position loop.
    double torque(const Demand& demand, const Motor& motor, const TorqueBounds& bounds) noexcept;
    /// rt. The torque for the next step when a torque is demanded: that one, unless the motor would
    /// get faster than `speedLimit` (turns/s) in either direction.
    double limited(double wanted, double speedLimit, const Motor& motor,
                   const TorqueBounds& bounds) noexcept;

private:
    double bounded(double torque, const Motor& motor, const TorqueBounds& bounds) noexcept;
    [[nodiscard]] double disturbance(const Motor& motor) const noexcept;

    double step_;
    double torqueLimit_;
    double velocityGain_;  ///< 1/s
    double positionGain_;  ///< 1/s
    double perTorque_;
    double torque_{0.0};
    double lastVelocity_{0.0};
    double lastOffset_{0.0};
};

}  // namespace takt::twin
