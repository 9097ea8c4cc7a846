#pragma once

#include <cstdint>
#include <takt/axis/axis_params.hpp>
#include <takt/core/cia402.hpp>
#include <takt/core/object_access.hpp>
#include <takt/core/process_image.hpp>
#include <takt/core/time.hpp>

namespace takt::axis {

/// How the drive is to be taken out of Operation enabled.
enum class SwitchOff : std::uint8_t {
    Orderly,    ///< disable operation, then shutdown: the brake closes before the torque goes
    Immediate,  ///< disable voltage
    QuickStop,  ///< the drive stops by itself (605Ah), then switches off
};

enum class HomingOutcome : std::uint8_t {
    None,
    Running,
    Done,
    DriveError,
    TimedOut,
    Cancelled,
    ModeFailed
};

/// What the drive said this cycle.
struct DriveInputs {
    std::int64_t counts{0};  ///< unfolded; bridged with the last step while inputs are lost
    std::int64_t step{
        0};  ///< change of the drive's own position in a cycle; kept while inputs are lost
    std::uint16_t statusword{0};
    std::uint16_t errorCode{0};  ///< 603Fh
    std::uint32_t digitalInputs{0};
    std::int8_t modeDisplay{0};
    bool seen{false};   ///< inputs were valid at least once
    bool fresh{false};  ///< inputs are of this cycle
};

/// A CiA 402 drive (IEC 61800-7-201) behind a process image: decoding, power sequence, fault reset,
/// change of mode, the drive's own homing, quick stop. It knows counts only and nothing of motion.
///
///     drive.attach(image, bindings, objects);
///     each cycle: drive.readInputs(); … switchOn(), setTarget(), home(), … ; drive.writeOutputs();
///
/// Requests may be repeated every cycle. Time-outs are counted in cycles.
class Drive {
public:
    Drive(const AxisParams& params, core::Duration cycle);

    /// `objects` may be null when everything needed is mapped. Without 6060h in the process data
    /// the mode is written through `objects`.
    void attach(core::DeviceImage image, const DriveBindings& bindings,
                core::ObjectAccess* objects);

    /// rt. Decodes the inputs and steps homing, mode change and reset.
    void readInputs() noexcept;
    /// rt. The controller missed cycles just before this one, without frame and inputs.
    void missCycles(std::uint32_t count) noexcept { unseen_ += count; }
    /// rt. Encodes controlword, mode and target.
    void writeOutputs() noexcept;

    // Requests (rt).
    void switchOn() noexcept;
    void switchOff(SwitchOff how) noexcept;
    /// Starts the fault reset when the drive is in Fault; see resetRunning() and resetTimedOut().
    void resetFault() noexcept;
    /// Runs the drive's homing procedure in mode 6 and comes back to CSP. \pre following()
    void home() noexcept;
    /// Stops a running homing; the drive comes to rest and back to CSP.
    void cancelHoming() noexcept;
    void setTarget(std::int64_t counts) noexcept { target_ = counts; }

    // Answers (rt).
    [[nodiscard]] const DriveInputs& inputs() const noexcept { return inputs_; }
    [[nodiscard]] const core::DeviceHealth& health() const noexcept { return *image_.health; }
    [[nodiscard]] bool attached() const noexcept { return image_.health != nullptr; }
    [[nodiscard]] core::cia402::DriveState state() const noexcept { return state_; }
    /// Operation enabled in CSP: the motor follows the targets.
    [[nodiscard]] bool following() const noexcept {
        return state_ == core::cia402::DriveState::OperationEnabled &&
               homing_ == HomingStep::Idle && modeReached_;
    }
    /// In Operation enabled by request, whatever the mode.
    [[nodiscard]] bool on() const noexcept {
        return wantOn_ && !mustLeave_ && state_ == core::cia402::DriveState::OperationEnabled;
    }
    /// Switched on by request and following.
    [[nodiscard]] bool enabled() const noexcept { return on() && following(); }
    /// The motor is energised, whoever controls it.
    [[nodiscard]] bool energised() const noexcept;
    [[nodiscard]] bool fault() const noexcept {
        return state_ == core::cia402::DriveState::Fault ||
               state_ == core::cia402::DriveState::FaultReactionActive;
    }
    [[nodiscard]] bool enableTimedOut() const noexcept { return enableCycles_ > enableLimit_; }
    [[nodiscard]] bool resetRunning() const noexcept { return reset_ != ResetStep::Idle; }
    [[nodiscard]] bool resetTimedOut() const noexcept { return resetTimedOut_; }
    void forgetReset() noexcept { resetTimedOut_ = false; }
    /// Mode 6 is (or is being) entered, used or left.
    [[nodiscard]] bool homing() const noexcept { return homing_ != HomingStep::Idle; }
    /// Outcome of the last home(); Running until the drive is back in CSP.
    [[nodiscard]] HomingOutcome homingOutcome() const noexcept { return outcome_; }
    /// The drive has not come back to CSP after homing: it has to be stopped.
    [[nodiscard]] bool stuckInHoming() const noexcept { return stuck_; }
    [[nodiscard]] std::uint16_t controlword() const noexcept { return controlword_; }
    [[nodiscard]] std::int32_t target() const noexcept {
        return static_cast<std::int32_t>(static_cast<std::uint64_t>(target_));
    }

private:
    enum class ResetStep : std::uint8_t { Idle, Low, High };
    enum class HomingStep : std::uint8_t { Idle, EnterMode, Armed, Running, Settle, Leave };
    enum class ModeWrite : std::uint8_t { Idle, Pending, Done };

    void decode() noexcept;
    void takeCounts(std::int32_t raw) noexcept;
    void stepEnable() noexcept;
    void stepReset() noexcept;
    void stepQuickStop() noexcept;
    void requestMode(core::cia402::Mode mode) noexcept;
    void stepMode() noexcept;
    void writeMode() noexcept;
    void readErrorCode() noexcept;
    void stepHoming() noexcept;
    void watchHoming() noexcept;
    void settleHoming() noexcept;
    void leaveHoming() noexcept;
    void endHoming(HomingOutcome outcome, HomingStep next) noexcept;
    void abandonHoming() noexcept;
    [[nodiscard]] std::uint16_t nextControlword() const noexcept;
    [[nodiscard]] std::uint16_t offControlword() const noexcept;
    [[nodiscard]] std::uint16_t homingBits() const noexcept;

    core::DeviceImage image_{};
    DriveBindings bindings_{};
    core::ObjectAccess* objects_{nullptr};

    DriveInputs inputs_{};
    std::int64_t confirmed_{0};  ///< counts of the last fresh inputs
    std::int64_t target_{0};
    core::cia402::DriveState state_{core::cia402::DriveState::NotReadyToSwitchOn};
    core::cia402::Mode mode_{core::cia402::Mode::CyclicSynchronousPosition};
    ModeWrite modeWrite_{ModeWrite::Idle};
    bool modeReached_{false};
    std::uint32_t modeCycles_{0};
    bool errorCodeAsked_{false};

    std::uint16_t controlword_{0};
    bool wantOn_{false};
    bool mustLeave_{false};  ///< still enabled from before: first the old order has to arrive
    SwitchOff offHow_{SwitchOff::Orderly};
    std::uint32_t enableCycles_{0};
    std::uint32_t enableLimit_;

    ResetStep reset_{ResetStep::Idle};
    bool resetTimedOut_{false};
    std::uint32_t resetCycles_{0};
    std::uint32_t resetLimit_;

    HomingStep homing_{HomingStep::Idle};
    HomingOutcome outcome_{HomingOutcome::None};
    HomingOutcome ending_{HomingOutcome::None};
    bool seenClean_{false};
    bool stuck_{false};
    std::uint32_t homingCycles_{0};
    std::uint32_t unseen_{0};  ///< cycles since the inputs were of their cycle
    std::uint32_t stepCycles_{0};
    std::uint32_t stillCycles_{0};      ///< of the homing's end
    std::uint32_t quickStopCycles_{0};  ///< at rest in Quick stop active
    std::uint32_t homingLimit_;
    std::uint32_t staleLimit_;
    std::int64_t stillStep_;
};

}  // namespace takt::axis
