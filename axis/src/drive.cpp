#include <bit>
#include <takt/axis/drive.hpp>
#include <takt/axis/scaling.hpp>

#include "cycles.hpp"

namespace takt::axis {

namespace cia = core::cia402;
using cia::DriveState;

namespace {

/// Entries on byte boundaries, which is nearly all of them, go without bit shuffling.
bool onBytes(core::PdoSlot slot) noexcept {
    return slot.bitOffset % 8 == 0;
}

std::uint32_t load(std::span<const std::uint8_t> image, core::PdoSlot slot) noexcept {
    const std::uint8_t* const p = image.data() + slot.bitOffset / 8;
    if (onBytes(slot)) {
        if (slot.bitLength == 16) return static_cast<std::uint32_t>(p[0] | (p[1] << 8));
        if (slot.bitLength == 8) return p[0];
        if (slot.bitLength == 32) {
            return std::uint32_t{p[0]} | (std::uint32_t{p[1]} << 8) | (std::uint32_t{p[2]} << 16) |
                   (std::uint32_t{p[3]} << 24);
        }
    }
    return core::readUnsigned(image, slot);
}

void store(std::span<std::uint8_t> image, core::PdoSlot slot, std::uint32_t value) noexcept {
    std::uint8_t* const p = image.data() + slot.bitOffset / 8;
    const auto byte = [value](unsigned shift) { return static_cast<std::uint8_t>(value >> shift); };
    if (onBytes(slot) && slot.bitLength == 16) {
        p[0] = byte(0);
        p[1] = byte(8);
    } else if (onBytes(slot) && slot.bitLength == 8) {
        p[0] = byte(0);
    } else if (onBytes(slot) && slot.bitLength == 32) {
        p[0] = byte(0);
        p[1] = byte(8);
        p[2] = byte(16);
        p[3] = byte(24);
    } else {
        core::write(image, slot, value);
    }
}

/// Below this step per cycle a drive that ends its homing counts as standing: a thousandth of the
/// axis' velocity limit, at least two counts of encoder noise.
std::int64_t stillStep(const AxisParams& params, core::Duration cycle) {
    const Scaling scaling{params.scaling};
    const double seconds = std::chrono::duration<double>(cycle).count();
    const double counts = params.limits.velocity.count() / scaling.resolution().count() * seconds;
    return counts * 1e-3 > 2.0 ? static_cast<std::int64_t>(counts * 1e-3) : 2;
}

/// Without 6061h in the process data a mode is taken as reached after so many cycles.
constexpr std::uint32_t kBlindModeCycles = 8;

/// Cycles at rest after which a drive in Quick stop active has stopped and is switched off.
constexpr std::uint32_t kQuickStopStillCycles = 20;

/// A drive may show the result of its last homing for a while after the start; after this time it
/// counts.
constexpr core::Duration kStaleTime = std::chrono::milliseconds{100};

}  // namespace

Drive::Drive(const AxisParams& params, core::Duration cycle)
    : enableLimit_{cyclesFor(params.supervision.enableTimeout, cycle)},
      resetLimit_{cyclesFor(params.supervision.resetTimeout, cycle)},
      homingLimit_{cyclesFor(params.homing.timeout, cycle)},
      staleLimit_{cyclesFor(kStaleTime, cycle)},
      stillStep_{stillStep(params, cycle)} {}

void Drive::attach(core::DeviceImage image, const DriveBindings& bindings,
                   core::ObjectAccess* objects) {
    image_ = image;
    bindings_ = bindings;
    objects_ = objects;
    inputs_ = {};
}

bool Drive::energised() const noexcept {
    return state_ == DriveState::OperationEnabled || state_ == DriveState::QuickStopActive ||
           state_ == DriveState::FaultReactionActive;
}

void Drive::readInputs() noexcept {
    ++unseen_;
    inputs_.fresh = image_.health->inputsFresh;
    if (inputs_.fresh) {
        decode();
        unseen_ = 0;
    } else if (inputs_.seen) {
        // Bridge a lost frame with the last step, so that the following error stays meaningful.
        inputs_.counts += inputs_.step;
    }
    stepMode();
    stepEnable();
    stepReset();
    if (homing_ != HomingStep::Idle) stepHoming();
}

void Drive::decode() noexcept {
    const auto in = image_.inputs;
    inputs_.statusword = static_cast<std::uint16_t>(load(in, bindings_.statusword));
    state_ = cia::stateOf(inputs_.statusword);
    takeCounts(std::bit_cast<std::int32_t>(load(in, bindings_.actualPosition)));
    if (bindings_.modeDisplay.present()) {
        inputs_.modeDisplay =
            std::bit_cast<std::int8_t>(static_cast<std::uint8_t>(load(in, bindings_.modeDisplay)));
    }
    if (bindings_.errorCode.present()) {
        inputs_.errorCode = static_cast<std::uint16_t>(load(in, bindings_.errorCode));
    } else {
        readErrorCode();
    }
    if (bindings_.digitalInputs.present())
        inputs_.digitalInputs = load(in, bindings_.digitalInputs);
}

void Drive::takeCounts(std::int32_t raw) noexcept {
    if (!inputs_.seen) {
        inputs_.seen = true;
        confirmed_ = raw;
        inputs_.counts = raw;
        inputs_.step = 0;
        return;
    }
    // The 32-bit difference is right across a wrap of the drive's position.
    const std::uint32_t moved = static_cast<std::uint32_t>(raw) -
                                static_cast<std::uint32_t>(static_cast<std::uint64_t>(confirmed_));
    const std::int64_t distance = std::bit_cast<std::int32_t>(moved);
    confirmed_ += distance;
    inputs_.counts = confirmed_;
    // Never taken from a bridged position: the error of one bridge would be the speed of the next.
    const std::int64_t half = distance < 0 ? -std::int64_t{unseen_ / 2} : unseen_ / 2;
    inputs_.step = (distance + half) / std::int64_t{unseen_};
}

void Drive::readErrorCode() noexcept {
    if (!fault()) {
        inputs_.errorCode = 0;
        errorCodeAsked_ = false;
        return;
    }
    if (objects_ == nullptr || inputs_.errorCode != 0 || modeWrite_ == ModeWrite::Pending) return;
    if (!errorCodeAsked_) {
        errorCodeAsked_ = objects_->startRead({cia::ErrorCode, 0});
        return;
    }
    const core::ObjectReply reply = objects_->reply();
    if (reply.state == core::ObjectState::Done && reply.value.size >= 2) {
        inputs_.errorCode =
            static_cast<std::uint16_t>(reply.value.bytes[0] | (reply.value.bytes[1] << 8));
    }
}

void Drive::switchOn() noexcept {
    if (wantOn_) return;
    wantOn_ = true;
    enableCycles_ = 0;
    mustLeave_ = state_ == DriveState::OperationEnabled;
}

void Drive::switchOff(SwitchOff how) noexcept {
    // A stronger order is not weakened while it is being carried out.
    if (wantOn_ || how > offHow_) offHow_ = how;
    if (wantOn_ && how == SwitchOff::QuickStop && !energised()) offHow_ = SwitchOff::Immediate;
    wantOn_ = false;
    if (homing_ != HomingStep::Idle) abandonHoming();
}

void Drive::stepEnable() noexcept {
    if (state_ != DriveState::OperationEnabled) mustLeave_ = false;
    if (!energised() && !wantOn_) offHow_ = SwitchOff::Orderly;
    stepQuickStop();
    // A bus that is not up yet is no fault of the drive.
    const bool waiting = wantOn_ && !enabled() && homing_ == HomingStep::Idle &&
                         image_.health->operational && !fault();
    enableCycles_ = waiting ? enableCycles_ + 1 : 0;
}

void Drive::resetFault() noexcept {
    if (reset_ != ResetStep::Idle || !fault()) return;
    reset_ = ResetStep::Low;
    resetTimedOut_ = false;
    resetCycles_ = 0;
}

void Drive::stepQuickStop() noexcept {
    // Some drives rest in Quick stop active with torque: once they stand they are switched off.
    const bool resting = !wantOn_ && offHow_ == SwitchOff::QuickStop &&
                         state_ == DriveState::QuickStopActive && inputs_.step <= stillStep_ &&
                         inputs_.step >= -stillStep_;
    quickStopCycles_ = resting ? quickStopCycles_ + 1 : 0;
    if (quickStopCycles_ >= kQuickStopStillCycles) offHow_ = SwitchOff::Immediate;
}

void Drive::stepReset() noexcept {
    if (reset_ == ResetStep::Idle) return;
    if (!fault()) {
        reset_ = ResetStep::Idle;
        return;
    }
    // Bit 7 works by its rising edge, so it was low for a cycle before it rises.
    if (reset_ == ResetStep::Low && state_ == DriveState::Fault &&
        (controlword_ & cia::FaultReset) == 0) {
        reset_ = ResetStep::High;
    }
    if (++resetCycles_ > resetLimit_) {
        reset_ = ResetStep::Idle;
        resetTimedOut_ = true;
    }
}

void Drive::requestMode(cia::Mode mode) noexcept {
    mode_ = mode;
    modeWrite_ = ModeWrite::Idle;
    modeReached_ = false;
    modeCycles_ = 0;
}

void Drive::stepMode() noexcept {
    if (modeReached_ && !bindings_.modeDisplay.present()) return;
    if (modeWrite_ != ModeWrite::Done) writeMode();
    if (modeWrite_ != ModeWrite::Done) return;
    if (bindings_.modeDisplay.present()) {
        modeReached_ = inputs_.modeDisplay == static_cast<std::int8_t>(mode_);
    } else {
        modeReached_ = ++modeCycles_ >= kBlindModeCycles;
    }
}

void Drive::writeMode() noexcept {
    if (bindings_.modeOfOperation.present() || objects_ == nullptr) {
        modeWrite_ = ModeWrite::Done;  // goes with the process data, or is set at start-up
        return;
    }
    if (modeWrite_ == ModeWrite::Idle) {
        core::ObjectValue value;
        value.bytes[0] = static_cast<std::uint8_t>(mode_);
        value.size = 1;
        if (objects_->startWrite({cia::ModesOfOperation, 0}, value))
            modeWrite_ = ModeWrite::Pending;
        return;
    }
    const core::ObjectState answer = objects_->reply().state;
    if (answer == core::ObjectState::Done) modeWrite_ = ModeWrite::Done;
    if (answer == core::ObjectState::Failed) modeWrite_ = ModeWrite::Idle;  // the time-out ends it
}

std::uint16_t Drive::offControlword() const noexcept {
    if (offHow_ == SwitchOff::Immediate) return cia::DisableVoltage;
    switch (state_) {
        case DriveState::OperationEnabled:
            return offHow_ == SwitchOff::QuickStop ? cia::QuickStop : cia::SwitchOn;
        case DriveState::QuickStopActive:
            return offHow_ == SwitchOff::QuickStop ? cia::QuickStop : cia::DisableVoltage;
        case DriveState::SwitchedOn:
        case DriveState::ReadyToSwitchOn:
            return cia::Shutdown;
        case DriveState::NotReadyToSwitchOn:
        case DriveState::SwitchOnDisabled:
        case DriveState::FaultReactionActive:
        case DriveState::Fault:
            break;
    }
    return cia::DisableVoltage;
}

std::uint16_t Drive::nextControlword() const noexcept {
    if (reset_ == ResetStep::High) return cia::FaultReset;
    if (!wantOn_ || mustLeave_) return offControlword();
    switch (state_) {
        case DriveState::SwitchOnDisabled:
            return cia::Shutdown;
        case DriveState::ReadyToSwitchOn:
            return cia::SwitchOn;
        case DriveState::SwitchedOn:
            return cia::EnableOperation;
        case DriveState::OperationEnabled:
            return static_cast<std::uint16_t>(cia::EnableOperation | homingBits());
        case DriveState::NotReadyToSwitchOn:
        case DriveState::QuickStopActive:
        case DriveState::FaultReactionActive:
        case DriveState::Fault:
            break;
    }
    return cia::DisableVoltage;
}

void Drive::writeOutputs() noexcept {
    controlword_ = nextControlword();
    const auto out = image_.outputs;
    store(out, bindings_.controlword, controlword_);
    if (bindings_.modeOfOperation.present()) {
        store(out, bindings_.modeOfOperation, static_cast<std::uint8_t>(mode_));
    }
    store(out, bindings_.targetPosition, static_cast<std::uint32_t>(target()));
}

}  // namespace takt::axis
