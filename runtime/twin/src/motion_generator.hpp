#pragma once

#include "servo.hpp"

namespace takt::twin {

/// How fast a motion may be; turns and seconds.
struct MotionLimits {
    double speed{0.0};
    double acceleration{0.0};
    double deceleration{0.0};
};

/// The drive's own simple profile generator: ramps to a speed, or goes to a position, with constant
/// acceleration and deceleration. For homing, stops and the profile modes; in the cyclic modes the
/// controller's profiles arrive ready-made.
class MotionGenerator {
public:
    /// rt. Takes over from a demand in motion.
    void begin(const Demand& from) noexcept;
    /// rt. Ramps to `velocity` (turns/s) with `acceleration` (turns/s²) up and down.
    void run(double velocity, double acceleration) noexcept {
        run(velocity, acceleration, acceleration);
    }
    /// rt. The same with a ramp of its own towards standstill.
    void run(double velocity, double acceleration, double deceleration) noexcept;
    /// rt. Goes to `position` with at most `speed`.
    void moveTo(double position, double speed, double acceleration) noexcept {
        moveTo(position, {speed, acceleration, acceleration});
    }
    /// rt. The same, going through `position` with up to `endSpeed` instead of stopping there.
    void moveTo(double position, const MotionLimits& limits, double endSpeed = 0.0) noexcept;
    /// rt. One step of `seconds`. \return the demand after it
    const Demand& step(double seconds) noexcept;

    [[nodiscard]] const Demand& demand() const noexcept { return demand_; }
    /// Standing still, and at the target if there is one.
    [[nodiscard]] bool finished() const noexcept {
        return demand_.velocity == 0.0 && (toTarget_ ? demand_.position == target_ : speed_ == 0.0);
    }
    /// The target has been passed through with speed.
    [[nodiscard]] bool passed() const noexcept { return passed_; }

private:
    [[nodiscard]] double wanted(double seconds) const noexcept;

    Demand demand_;
    bool toTarget_{false};
    bool passed_{false};
    double target_{0.0};
    double speed_{0.0};
    double endSpeed_{0.0};
    double acceleration_{0.0};
    double deceleration_{0.0};
};

}  // namespace takt::twin
