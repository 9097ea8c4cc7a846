#pragma once

#include <cstdint>
#include <optional>
#include <takt/core/cia402.hpp>
#include <takt/core/time.hpp>
#include <takt/twin/drive_traits.hpp>
#include <takt/twin/twin_params.hpp>

#include "homing.hpp"
#include "mailbox_server.hpp"
#include "motion_generator.hpp"
#include "motor.hpp"
#include "object_dictionary.hpp"
#include "position_scale.hpp"
#include "servo.hpp"

namespace takt::twin {

/// The objects of the drive profile that the simulated drive reads and writes.
struct DriveObjects {
    DriveObjects(ObjectDictionary& dictionary, const DriveTraits& traits);

    ObjectRef errorRegister, errorCode, controlWord, statusWord;
    ObjectRef quickStopOption, shutdownOption, disableOption;
    ObjectRef mode, modeDisplay;
    ObjectRef positionActual, positionDemand, velocityActual, torqueActual, followingError;
    ObjectRef followingWindow, followingTimeout;
    ObjectRef targetPosition, profileDeceleration, quickStopDeceleration;
    ObjectRef positiveTorque, negativeTorque;
    ObjectRef homeOffset, homingMethod, homingFast, homingSlow, homingAcceleration;
    ObjectRef homingCurrent, homingOffsetMode, homingOffsetSpeed;
    ObjectRef digitalInputs, panelCode;
};

/// A CiA 402 servo drive with its motor: state machine, cyclic synchronous position and homing
/// modes, supervision. It talks to the bus through its object dictionary only.
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
    /// rt. Process data stopped while the device was in OP.
    void communicationLost() noexcept;

    [[nodiscard]] std::uint32_t subSteps() const noexcept { return subSteps_; }
    [[nodiscard]] core::cia402::DriveState state() const noexcept { return state_; }
    [[nodiscard]] const Motor& motor() const noexcept { return motor_; }
    /// rt. An emergency that waits to be sent, taken out.
    std::optional<Emergency> takeEmergency() noexcept;

private:
    using State = core::cia402::DriveState;
    enum class Source : std::uint8_t { Hold, Interpolator, Generator };
    enum class Command : std::uint8_t {
        None,
        DisableVoltage,
        QuickStop,
        Shutdown,
        SwitchOn,
        Enable
    };
    enum class Stop : std::uint8_t { None, QuickStop, Shutdown, Disable };

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
    void resetFault() noexcept;
    [[nodiscard]] std::int64_t option(ObjectRef object, std::int16_t fixed) const noexcept;

    // drive.cpp: motion and supervision.
    void selectMode() noexcept;
    void stepMode(std::uint16_t controlWord) noexcept;
    void stepPosition(std::uint16_t controlWord) noexcept;
    void stepHoming(std::uint16_t controlWord) noexcept;
    void startHoming() noexcept;
    void takeHome() noexcept;
    void interpolateTo(double target) noexcept;
    void hold(double position) noexcept;
    void rampDown(double deceleration) noexcept;
    void nextDemand() noexcept;
    void superviseFollowing() noexcept;
    [[nodiscard]] double velocityTurns(std::int64_t value) const noexcept;
    [[nodiscard]] std::int64_t userPosition(double turns) const noexcept;
    [[nodiscard]] bool motorStands() const noexcept;

    // drive_report.cpp
    void report(bool outputsValid, bool dcLocked) noexcept;
    [[nodiscard]] std::uint16_t statusWord(bool outputsValid, bool dcLocked) const noexcept;
    [[nodiscard]] std::uint16_t modeBits() const noexcept;
    [[nodiscard]] std::uint16_t homingBits() const noexcept;

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
    bool faultInReaction_{false};
    bool resetWanted_{false};
    std::optional<Emergency> emergency_;

    std::int8_t activeMode_{0};
    Source source_{Source::Hold};
    Demand demand_;
    double interpolation_{0.0};   ///< turns per control step
    std::uint32_t stepsLeft_{0};  ///< of the interpolation
    double interpolationEnd_{0.0};
    std::int64_t target_{0};  ///< user counts, unwrapped
    std::int64_t zero_{0};    ///< increments at which the user position is 0
    bool homed_{false};
    bool blocked_{false};  ///< a limit switch holds the axis back
    bool halted_{false};
    double torque_{0.0};
    std::int64_t followingError_{0};  ///< user counts
    core::Duration followingTime_{0};
    bool followingFault_{false};
};

}  // namespace takt::twin
