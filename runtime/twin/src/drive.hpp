#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <takt/core/cia402.hpp>
#include <takt/core/time.hpp>
#include <takt/twin/drive_traits.hpp>
#include <takt/twin/twin_params.hpp>

#include "drive_objects.hpp"
#include "homing.hpp"
#include "mailbox_server.hpp"
#include "motion_generator.hpp"
#include "motor.hpp"
#include "object_dictionary.hpp"
#include "position_scale.hpp"
#include "servo.hpp"
#include "set_points.hpp"
#include "touch_probe.hpp"

namespace takt::twin {

/// A CiA 402 servo drive with its motor: state machine, modes of operation, supervision. It talks
/// to the bus through its object dictionary only.
///
/// `advance` runs the control loop up to an instant; `cycle`, once per SYNC0, takes the new outputs
/// and leaves the inputs.
class Drive {
public:
    Drive(const TwinDeviceParams& params, const DriveTraits& traits, ObjectDictionary& dictionary,
          core::Duration cycle);
    Drive(const Drive&) = delete;
    Drive& operator=(const Drive&) = delete;

    /// rt. The period of `cycle` from now on; the control loop is tuned to it.
    void setCycle(core::Duration cycle) noexcept;
    /// rt. Runs `steps` fixed steps of control loop and motor.
    void advance(std::uint32_t steps) noexcept;
    /// rt. One cycle. `outputsValid`: the device is in OP. `dcLocked`: SYNC0 is running.
    void cycle(bool outputsValid, bool dcLocked) noexcept;
    /// rt. An alarm or warning of the drive's manual happens. \return the drive has such a one
    bool raiseAlarm(std::uint16_t number) noexcept;
    /// rt. The electronic gear as 6091h and 6092h have it now. \pre !powered()
    void takeGear() noexcept;
    /// rt. The drive's processor starts again; it was not in operation or is torn out of it.
    void restart() noexcept;
    /// rt. Process data stopped while the device was in OP.
    void communicationLost() noexcept;

    [[nodiscard]] bool powered() const noexcept { return powered_; }
    [[nodiscard]] std::uint32_t subSteps() const noexcept { return subSteps_; }
    [[nodiscard]] core::cia402::DriveState state() const noexcept { return state_; }
    [[nodiscard]] const Motor& motor() const noexcept { return motor_; }
    /// rt. An emergency that waits to be sent, taken out.
    std::optional<Emergency> takeEmergency() noexcept;

private:
    using State = core::cia402::DriveState;
    /// Where the demand comes from; Speed and Torque leave the position open.
    enum class Source : std::uint8_t { Hold, Interpolator, Generator, Speed, Torque };
    enum class Command : std::uint8_t {
        None,
        DisableVoltage,
        QuickStop,
        Shutdown,
        SwitchOn,
        Enable
    };
    enum class Stop : std::uint8_t { None, QuickStop, Shutdown, Disable, Fault };
    /// Positions in user counts that a target may not leave; `active` or none.
    struct SoftLimits {
        bool active{false};
        std::int64_t minimum{0};
        std::int64_t maximum{0};
    };

    // drive_states.cpp: IEC 61800-7-201 clause 6.
    [[nodiscard]] static Command decode(std::uint16_t controlWord) noexcept;
    void stepStates(std::uint16_t controlWord) noexcept;
    void stepEnabled(Command command) noexcept;
    void stepQuickStop(Command command) noexcept;
    void finishStop() noexcept;
    void beginStop(Stop stop) noexcept;
    void beginQuickStop() noexcept;
    void powerOn() noexcept;
    void powerOff(State next) noexcept;
    void fail(std::uint16_t code, std::uint16_t panel, std::uint8_t errorRegister) noexcept;
    void beginFaultStop(std::int64_t reaction) noexcept;
    void resetFault() noexcept;
    void clearWarning() noexcept;
    [[nodiscard]] std::int64_t option(ObjectRef object, std::int16_t fixed) const noexcept;

    // drive.cpp: demand, supervision.
    void selectMode(std::uint16_t controlWord) noexcept;
    void enterMode(bool bit4) noexcept;
    void stepMode(std::uint16_t controlWord) noexcept;
    void stepControl(const TorqueBounds& bounds) noexcept;
    void nextDemand() noexcept;
    void interpolate() noexcept;
    void hold(double position) noexcept;
    void rampDown(double deceleration) noexcept;
    void superviseFollowing() noexcept;
    void superviseTarget() noexcept;
    void superviseLoad() noexcept;
    [[nodiscard]] TorqueBounds torqueBounds() const noexcept;

    // drive_cyclic.cpp: CSP, CSV, CST and PT.
    void stepPosition(std::uint16_t controlWord) noexcept;
    void stepVelocity(std::uint16_t controlWord) noexcept;
    void stepTorque(std::uint16_t controlWord) noexcept;
    void interpolateTo(double target) noexcept;
    [[nodiscard]] bool haltCyclic(std::uint16_t controlWord) noexcept;
    [[nodiscard]] SoftLimits softLimits() const noexcept;
    [[nodiscard]] double speedWithinLimits(double velocity, double deceleration) noexcept;

    // drive_profile.cpp: PP, PV and homing.
    void stepProfilePosition(std::uint16_t controlWord) noexcept;
    void takeSetPoint(std::uint16_t controlWord) noexcept;
    void startSetPoint() noexcept;
    void stepProfileVelocity(std::uint16_t controlWord) noexcept;
    void stepHoming(std::uint16_t controlWord) noexcept;
    void startHoming() noexcept;
    void takeHome() noexcept;

    // drive_inputs.cpp: limit and home inputs, touch probes.
    void readInputs() noexcept;
    [[nodiscard]] bool virtualInput(std::uint16_t function) const noexcept;
    [[nodiscard]] std::uint32_t digitalInputs() const noexcept;
    [[nodiscard]] ProbeSignals probeSignals(double before) const noexcept;
    void reportProbes() noexcept;
    /// Microseconds since power-up, what the time stamps count.
    [[nodiscard]] std::uint32_t probeTime() const noexcept {
        return static_cast<std::uint32_t>(sinceStart_.count() / 1000);
    }
    [[nodiscard]] bool positiveLimit() const noexcept {
        return motor_.positiveLimit() || forced_.positive;
    }
    [[nodiscard]] bool negativeLimit() const noexcept {
        return motor_.negativeLimit() || forced_.negative;
    }

    // drive_units.cpp
    [[nodiscard]] double velocityTurns(std::int64_t value) const noexcept;
    [[nodiscard]] double rate(ObjectRef object) const noexcept;
    [[nodiscard]] double speedLimit(bool profile) const noexcept;
    [[nodiscard]] double haltDeceleration() const noexcept;
    [[nodiscard]] double turnsOf(std::int64_t counts) const noexcept;
    [[nodiscard]] std::int64_t userPosition(double turns) const noexcept;
    [[nodiscard]] bool limitAhead(double velocity) const noexcept;
    [[nodiscard]] bool motorStands() const noexcept;
    [[nodiscard]] bool inMode(core::cia402::Mode mode) const noexcept {
        return activeMode_ == static_cast<std::int8_t>(mode);
    }

    // drive_report.cpp
    void report(bool outputsValid, bool dcLocked) noexcept;
    [[nodiscard]] std::uint16_t statusWord(bool outputsValid, bool dcLocked) const noexcept;
    [[nodiscard]] std::uint16_t modeBits() const noexcept;
    [[nodiscard]] std::uint16_t homingBits() const noexcept;
    [[nodiscard]] std::uint16_t positionBits() const noexcept;
    [[nodiscard]] std::uint16_t profileBits() const noexcept;
    [[nodiscard]] std::uint16_t velocityBits() const noexcept;

    const DriveTraits& traits_;
    ObjectDictionary& dictionary_;
    DriveObjects objects_;
    PositionScale scale_;
    Motor motor_;
    core::Duration cycleTime_;
    std::uint32_t subSteps_;
    double stepSeconds_;
    Servo servo_;
    MotionGenerator generator_;
    Homing homing_;

    State state_{State::NotReadyToSwitchOn};
    core::Duration sinceStart_{0};
    core::Duration enabling_{-1};  ///< time since Enable operation was seen; negative = not
    bool powered_{false};
    Stop stop_{Stop::None};
    bool quickStopStays_{false};
    std::uint16_t lastControl_{0};
    bool resettable_{true};
    std::uint16_t warning_{0};  ///< number on the display, 0 = none
    bool overloaded_{false};    ///< its warning has been given
    double load_{0.0};          ///< 1 = what the motor bears for ever
    std::optional<Emergency> emergency_;

    std::int8_t activeMode_{0};
    Source source_{Source::Hold};
    Demand demand_;
    double interpolation_{0.0};   ///< turns per control step
    std::uint32_t stepsLeft_{0};  ///< of the interpolation
    double interpolationEnd_{0.0};
    std::int64_t target_{0};  ///< user counts, unwrapped
    std::int64_t zero_{0};    ///< increments at which the user position is 0
    bool gearValid_{true};
    bool homed_{false};
    bool blocked_{false};  ///< a limit switch holds the axis back
    bool halted_{false};
    bool softLimited_{false};  ///< a software limit does
    SetPoints setPoints_;
    TouchProbe probe_;
    HomingSignals forced_;              ///< by virtual inputs
    std::array<bool, 2> probeInput_{};  ///< virtual inputs of the probes
    double torque_{0.0};
    double torqueTarget_{0.0};        ///< Nm, of the torque modes
    double torqueDemand_{0.0};        ///< Nm, on its slope to the target
    double torqueStep_{0.0};          ///< Nm per control step, 0 = at once
    double torqueSpeed_{0.0};         ///< turns/s, not to be exceeded in the torque modes
    std::int64_t followingError_{0};  ///< user counts
    core::Duration reachedTime_{0};   ///< time within the target window
    bool reached_{false};
    core::Duration followingTime_{0};
    bool followingFault_{false};
};

}  // namespace takt::twin
