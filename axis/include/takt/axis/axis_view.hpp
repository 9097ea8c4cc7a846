#pragma once

#include <cstdint>
#include <takt/axis/axis_params.hpp>
#include <takt/axis/command.hpp>
#include <takt/axis/error.hpp>
#include <takt/axis/scaling.hpp>
#include <takt/core/time.hpp>
#include <takt/core/units.hpp>

namespace takt::axis {

/// The eight states of the PLCopen single-axis diagram.
enum class AxisState : std::uint8_t {
    Disabled,
    Standstill,
    Homing,
    DiscreteMotion,
    ContinuousMotion,
    SynchronizedMotion,
    Stopping,
    ErrorStop,
};

/// "Disabled", "Standstill", … as in the standard.
[[nodiscard]] const char* name(AxisState state) noexcept;

/// What never changes while an axis lives.
struct AxisTraits {
    LimitParams limits;
    core::Distance period{};       ///< modulo period, 0 = linear
    core::Distance resolution{};   ///< size of one count
    core::Distance maxPosition{};  ///< no position is farther from 0
    std::uint32_t queueDepth{8};
    PowerOffMode powerOff{PowerOffMode::Ramp};
};

/// What a program may see of an axis, and what a new command is judged by. Positions are unfolded;
/// `folded` gives what a modulo axis reports.
struct AxisView {
    core::CycleNumber cycle{0};
    const AxisTraits* traits{nullptr};
    CommandId active{CommandId::None};  ///< the command in control
    AxisState state{AxisState::Disabled};
    bool powerRequested{false};
    bool powered{false};  ///< the drive is in Operation enabled and follows the set-points
    bool homed{false};
    bool inputsValid{false};  ///< actual values are of this cycle, or bridged over a tolerated loss
    bool atRest{true};        ///< set velocity and acceleration are zero
    bool inVelocity{false};   ///< the MoveVelocity in control has reached its velocity
    bool stopDone{false};     ///< Stopping at velocity zero
    bool stopReleased{true};  ///< Stopping ends with velocity zero
    bool movedBackward{false};    ///< direction of the last motion
    bool grouped{false};          ///< its group moves it
    bool machineStop{false};      ///< the machine stop holds the axis: no motion, no power
    bool needsEnableEdge{false};  ///< since a machine stop: power only after Enable fell
    std::uint8_t queued{0};
    core::Position set{};
    core::Velocity setVelocity{};
    core::Position actual{};
    core::Position commandedPosition{};
    ErrorRecord error{};

    [[nodiscard]] core::Position folded(core::Position position) const noexcept {
        return core::Position{Scaling::foldInto(position.count(), traits->period.count())};
    }
    /// A command is in control or braking is under way: a buffered command has to wait.
    [[nodiscard]] bool inMotion() const noexcept {
        return state == AxisState::DiscreteMotion || state == AxisState::ContinuousMotion ||
               state == AxisState::SynchronizedMotion || state == AxisState::Homing;
    }
};

/// One axis in one cycle, for traces, tables and the status snapshot. Positions are unfolded.
struct AxisStatus {
    AxisState state{AxisState::Disabled};
    core::Position set{};
    core::Velocity setVelocity{};
    core::Acceleration setAcceleration{};
    std::int32_t target{0};  ///< counts, as sent to the drive
    core::Position actual{};
    core::Velocity actualVelocity{};
    core::Distance lag{};  ///< set minus actual, compensated for the way of data
    std::uint16_t controlword{0};
    std::uint16_t statusword{0};
    std::int8_t mode{0};  ///< 6061h
    ErrorId error{ErrorId::None};
    std::uint16_t driveError{0};
    bool powered{false};
    bool homed{false};
    core::Position commandedPosition{};
};

}  // namespace takt::axis
