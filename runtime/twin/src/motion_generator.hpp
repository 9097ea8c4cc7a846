#pragma once

#include "servo.hpp"

namespace takt::twin {

/// The drive's own simple profile generator: ramps to a speed, or goes to a position, with one
/// acceleration. For homing moves and stops; the controller's profiles arrive ready-made.
class MotionGenerator {
public:
    /// rt. Takes over from a demand in motion.
    void begin(const Demand& from) noexcept;
    /// rt. Ramps to `velocity` (turns/s) with `acceleration` (turns/s²).
    void run(double velocity, double acceleration) noexcept;
    /// rt. Goes to `position` with at most `speed`.
    void moveTo(double position, double speed, double acceleration) noexcept;
    /// rt. One step of `seconds`. \return the demand after it
    const Demand& step(double seconds) noexcept;

    [[nodiscard]] const Demand& demand() const noexcept { return demand_; }
    /// Standing still, and at the target if there is one.
    [[nodiscard]] bool finished() const noexcept {
        return demand_.velocity == 0.0 && (toTarget_ ? demand_.position == target_ : speed_ == 0.0);
    }

private:
    Demand demand_;
    bool toTarget_{false};
    double target_{0.0};
    double speed_{0.0};
    double acceleration_{0.0};
};

}  // namespace takt::twin
