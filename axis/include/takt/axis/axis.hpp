#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <takt/axis/axis_params.hpp>
#include <takt/axis/axis_port.hpp>
#include <takt/axis/axis_view.hpp>
#include <takt/axis/command.hpp>
#include <takt/axis/drive.hpp>
#include <takt/axis/following_error.hpp>
#include <takt/axis/motion.hpp>
#include <takt/axis/output_gate.hpp>
#include <takt/axis/scaling.hpp>
#include <takt/core/fixed_vector.hpp>
#include <takt/core/object_access.hpp>
#include <takt/core/process_image.hpp>
#include <takt/core/time.hpp>

namespace takt::axis {

/// One servo axis in user units: PLCopen state, command in control and queue, supervision,
/// trajectory, and the output gate, on top of a CiA 402 drive.
///
///     Axis x{params, cycle};
///     x.attach(image, bindings, objects);
///     every cycle:
///         x.readInputs(k);        // drive, actual values, supervision, state
///         x.openPort(port);       // … the program runs against its port …
///         x.takeCommands(port);   // only when the program finished in time
///         x.step();               // trajectory and output gate
///         x.writeOutputs();       // what leaves with the next frame
///
/// The axis owns execution: motion goes on whether or not a block is called. While the drive
/// follows, the set position is never taken from the actual one; it is when the drive is switched
/// on and after homing.
class Axis {
public:
    static constexpr std::size_t MaxQueue = 32;

    /// \throws std::invalid_argument when the scaling is not usable
    Axis(const AxisParams& params, core::Duration cycle);
    Axis(const Axis&) = delete;
    Axis& operator=(const Axis&) = delete;

    /// Before the first cycle. The slots of controlword, target, statusword and actual position
    /// must be present. `objects` may be null.
    void attach(core::DeviceImage image, const DriveBindings& bindings,
                core::ObjectAccess* objects);

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] const AxisTraits& traits() const noexcept { return traits_; }

    // The cycle, in this order (rt).
    void readInputs(core::CycleNumber cycle) noexcept;
    void openPort(AxisPort& port) const noexcept;
    void takeCommands(AxisPort& port) noexcept;
    void step() noexcept;
    /// rt. Before readInputs(), for each cycle the controller missed: the motion goes on, and its
    /// set-point is lost like one in a lost frame; the drive interpolates over it.
    void missCycle() noexcept;
    /// rt. Before readInputs(), for missed cycles in which the motion did not go on.
    void standFor(std::uint32_t cycles) noexcept { drive_.missCycles(cycles); }
    void writeOutputs() noexcept;

    // The daemon's requests (rt), between readInputs() and step().

    /// The program that moves this axis threw, failed or was abandoned: its commands go, the axis
    /// stops on its stop ramp and ends in Standstill.
    void stopByProgramLoss() noexcept;
    /// Controlled end: as MC_Power.Enable = FALSE.
    void requestPowerOff() noexcept;
    /// The drive stops by itself (CiA 402 quick stop) and is switched off.
    void quickStop() noexcept;
    /// The machine stop holds the axis: it stops on its stop ramp and is switched off then,
    /// whatever its power-off mode; motion and power are refused. To be called in every cycle of
    /// the stop.
    void machineStop() noexcept;
    /// The machine stop was reset. Power comes back only after Enable of MC_Power fell and rose.
    void releaseMachineStop() noexcept { view_.machineStop = false; }
    /// No motion: the set-point rests and no homing runs.
    [[nodiscard]] bool isStopped() const noexcept { return motion_.resting() && !drive_.homing(); }
    /// The motor is not energised.
    [[nodiscard]] bool isDisabled() const noexcept { return !drive_.energised(); }

    // A group's hold on the axis (rt), between readInputs() and step().

    /// An enabled group has the axis; only one at a time. \return false when another one has it
    [[nodiscard]] bool claim() noexcept;
    void unclaim() noexcept { claimed_ = false; }
    [[nodiscard]] bool claimed() const noexcept { return claimed_; }
    /// The group moves: SynchronizedMotion, and the axis goes where follow() says. Single-axis
    /// motion is refused; MC_Stop, MC_Power and errors change the state, and the axis still
    /// follows, so that it stops on the path. \pre Standstill
    void joinGroup() noexcept;
    /// The set state of this cycle; to be called in each while the axis is grouped.
    void follow(const planner::State& state) noexcept { led_ = state; }
    /// The group rests: back to Standstill, or the end of the stop that was asked for meanwhile.
    void leaveGroup() noexcept;
    /// The group failed: ErrorStop; the axis follows until the group rests.
    void failWithGroup() noexcept;
    /// Reset as by MC_Reset; see resetRunning().
    void resetWithGroup() noexcept;
    [[nodiscard]] bool resetRunning() const noexcept { return !resets_.empty(); }
    /// Why the last reset failed; None when it did not.
    [[nodiscard]] ErrorId resetError() const noexcept { return resetError_; }

    // What is to be seen (rt).
    [[nodiscard]] AxisState state() const noexcept { return view_.state; }
    [[nodiscard]] const AxisView& view() const noexcept { return view_; }
    [[nodiscard]] const ErrorRecord& error() const noexcept { return view_.error; }
    [[nodiscard]] AxisStatus status() const noexcept;
    [[nodiscard]] const Scaling& scaling() const noexcept { return scaling_; }
    /// 60FDh, 0 when not mapped.
    [[nodiscard]] std::uint32_t digitalInputs() const noexcept {
        return drive_.inputs().digitalInputs;
    }

private:
    friend struct AxisTestAccess;

    /// Reactions to an axis error in ascending severity; a stronger one replaces a weaker one only.
    enum class Reaction : std::uint8_t { None, Ramp, DriveStop, Off };
    using Numbers = std::array<double, 3>;

    // axis.cpp: the cycle
    void updateActual() noexcept;
    void standAtActual() noexcept;
    void updateHoming() noexcept;
    void updateMotion() noexcept;
    void updateDiscrete() noexcept;
    void updateContinuous() noexcept;
    void updateStopping() noexcept;
    [[nodiscard]] bool inPosition() noexcept;
    void advance() noexcept;
    void refuse(ErrorId error, Numbers numbers) noexcept;
    void brakeByGate() noexcept;
    [[nodiscard]] std::optional<core::Position> softLimitPassed(core::Position next) const noexcept;
    void publishSet() noexcept;

    // axis_commands.cpp: commands
    void execute(const Command& command) noexcept;
    void executeStop(const Command& command) noexcept;
    void executePowerOff(const Command& command) noexcept;
    void executeReset(const Command& command) noexcept;
    void executeMotion(const Command& command) noexcept;
    void control(const Command& command) noexcept;
    void planActive() noexcept;
    void activateNext() noexcept;
    void completeActive(CommandStatus outcome) noexcept;
    void brake(CommandKind kind) noexcept;
    void endAll(CommandStatus outcome) noexcept;
    void enterStandstill() noexcept;
    void report(CommandId id, CommandStatus status) noexcept { events_.report(id, status); }

    // axis_supervision.cpp: errors, power, reset
    void supervise() noexcept;
    void superviseBus() noexcept;
    void superviseDrive() noexcept;
    void superviseMotion() noexcept;
    void superviseErrorStop(bool wasPowered) noexcept;
    void updatePower() noexcept;
    void updateReset() noexcept;
    [[nodiscard]] ErrorId resetObstacle() const noexcept;
    void finishReset(ErrorId error) noexcept;
    void applyPower() noexcept;
    void raise(ErrorId id, Numbers numbers, Reaction reaction) noexcept;
    void react(Reaction reaction) noexcept;
    /// Power is on and no error is pending.
    [[nodiscard]] bool live() const noexcept {
        return view_.state != AxisState::Disabled && view_.state != AxisState::ErrorStop;
    }

    std::string name_;
    Scaling scaling_;
    AxisTraits traits_;
    Drive drive_;
    Motion motion_;
    OutputGate gate_;
    FollowingError followingError_;

    AxisView view_{};
    Command active_{};
    core::FixedVector<Command, MaxQueue> queue_{};
    bool planPending_{false};
    bool homingRunning_{false};
    bool powerBlocked_{false};   ///< off until the reset, whatever MC_Power asks
    bool dropAfterRamp_{false};  ///< the drive is stopped once the set-points rest
    bool emergency_{false};      ///< no profile: the gate's ramp stops the axis
    Reaction reaction_{Reaction::None};
    core::Distance lag_{};
    core::Velocity actualVelocity_{};

    planner::State led_{};  ///< set state of this cycle while a group drives the axis
    bool claimed_{false};
    ErrorId resetError_{ErrorId::None};
    core::FixedVector<CommandId, 8> resets_{};
    std::uint32_t resetCycles_{0};

    CommandEvents events_;

    double cycleSeconds_;
    std::uint32_t lostCycles_;
    std::uint32_t resetLimit_;
    core::Distance inPositionWindow_;
    std::uint32_t inPositionCycles_;
    std::uint32_t inPositionSince_{0};
    std::int64_t jumpCounts_;  ///< no encoder moves farther in one cycle
    double enableTimeout_;
};

}  // namespace takt::axis
