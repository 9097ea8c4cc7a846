#pragma once

#include <takt/twin/twin_params.hpp>

namespace takt::twin {

/// A motor with what hangs on it: one rotating mass with Coulomb friction and a constant load,
/// between hard stops if there are any. Turns of the motor shaft.
class Motor {
public:
    explicit Motor(const MechanicsParams& params) noexcept;

    /// rt. One step of `seconds` under `torque` (Nm). `braked`: the holding brake is engaged.
    void step(double torque, bool braked, double seconds) noexcept;

    [[nodiscard]] double position() const noexcept { return position_; }  ///< turns
    [[nodiscard]] double velocity() const noexcept { return velocity_; }  ///< turns/s
    /// Turns/s² that one Nm gives.
    [[nodiscard]] double accelerationPerTorque() const noexcept { return perTorque_; }
    /// The load would move the unpowered motor, so a machine builder has fitted a holding brake.
    [[nodiscard]] bool hasBrake() const noexcept { return hasBrake_; }
    [[nodiscard]] bool atRest() const noexcept { return velocity_ == 0.0; }

    [[nodiscard]] bool homeSwitch() const noexcept { return active(params_.homeSwitch); }
    [[nodiscard]] bool negativeLimit() const noexcept { return active(params_.negativeLimit); }
    [[nodiscard]] bool positiveLimit() const noexcept { return active(params_.positiveLimit); }
    [[nodiscard]] const MechanicsParams& params() const noexcept { return params_; }

private:
    [[nodiscard]] bool active(const std::optional<SwitchParams>& zone) const noexcept {
        return zone && position_ >= zone->fromTurns && position_ <= zone->toTurns;
    }
    void meetHardStops() noexcept;

    MechanicsParams params_;
    double perTorque_;
    bool hasBrake_;
    double position_;
    double velocity_{0.0};
};

}  // namespace takt::twin
