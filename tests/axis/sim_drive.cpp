#include "sim_drive.hpp"

#include <algorithm>
#include <cstdlib>

namespace takt::test {

using core::cia402::DriveState;

namespace {

constexpr std::int64_t kHomingSpeed = 40;

void put16(std::span<std::uint8_t> b, std::size_t at, std::uint16_t v) {
    b[at] = static_cast<std::uint8_t>(v & 0xFFU);
    b[at + 1] = static_cast<std::uint8_t>(v >> 8U);
}
void put32(std::span<std::uint8_t> b, std::size_t at, std::uint32_t v) {
    put16(b, at, static_cast<std::uint16_t>(v & 0xFFFFU));
    put16(b, at + 2, static_cast<std::uint16_t>(v >> 16U));
}
std::uint16_t get16(std::span<const std::uint8_t> b, std::size_t at) {
    return static_cast<std::uint16_t>(b[at] | (b[at + 1] << 8U));
}
std::int32_t get32(std::span<const std::uint8_t> b, std::size_t at) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(get16(b, at)) |
                                     (static_cast<std::uint32_t>(get16(b, at + 2)) << 16U));
}

}  // namespace

SimDrive::SimDrive() {
    latchInputs();
}

axis::DriveBindings SimDrive::bindings() {
    axis::DriveBindings b;
    b.controlword = {0, 16};
    b.modeOfOperation = {16, 8};
    b.targetPosition = {24, 32};
    b.statusword = {0, 16};
    b.modeDisplay = {16, 8};
    b.actualPosition = {24, 32};
    b.errorCode = {56, 16};
    return b;
}

void SimDrive::exchange() {
    if (frameLost) {
        health.inputsFresh = false;
        ++health.lostInRow;
    } else {
        health.inputsFresh = true;
        health.lostInRow = 0;
        inputs = latched_;
        if (health.operational) takeOutputs();
    }
    stepState();
    stepMotor();
    latchInputs();
}

void SimDrive::takeOutputs() {
    lastControlword_ = controlword;
    controlword = get16(outputs, 0);
    mode = static_cast<std::int8_t>(outputs[2]);
    target = get32(outputs, 3);
}

void SimDrive::stepState() {
    const bool edge = (controlword & 0x80U) != 0 && (lastControlword_ & 0x80U) == 0;
    lastControlword_ = controlword;
    if (faultCode != 0 && state != DriveState::Fault) state = DriveState::Fault;
    if (state == DriveState::Fault) {
        if (edge) {
            ++resetEdges;
            if (faultResettable) {
                faultCode = 0;
                state = DriveState::SwitchOnDisabled;
            }
        }
        return;
    }
    // Commands by table 30 of IEC 61800-7-201: bits 7, 3, 2, 1, 0.
    const unsigned c = controlword & 0x8FU;
    const bool shutdown = (c & 0x87U) == 0x06U;
    const bool switchOn = (c & 0x8FU) == 0x07U;
    const bool enable = (c & 0x8FU) == 0x0FU;
    const bool disableVoltage = (c & 0x82U) == 0x00U;
    const bool quickStop = (c & 0x86U) == 0x02U;
    const bool wasEnabled = state == DriveState::OperationEnabled;
    switch (state) {
        case DriveState::SwitchOnDisabled:
            if (shutdown) state = DriveState::ReadyToSwitchOn;
            break;
        case DriveState::ReadyToSwitchOn:
            if (disableVoltage || quickStop) state = DriveState::SwitchOnDisabled;
            if (switchOn || enable) state = DriveState::SwitchedOn;
            delay_ = enableDelay;
            break;
        case DriveState::SwitchedOn:
            if (shutdown) state = DriveState::ReadyToSwitchOn;
            if (disableVoltage || quickStop) state = DriveState::SwitchOnDisabled;
            if (enable && enableInput && !refuseEnable && delay_-- <= 0) {
                state = DriveState::OperationEnabled;
                positionAtEnable = position;
                pendingTarget_ = target;
                firstTargetAfterEnable.reset();
            }
            break;
        case DriveState::OperationEnabled:
            if (switchOn) state = DriveState::SwitchedOn;
            if (shutdown) state = DriveState::ReadyToSwitchOn;
            if (disableVoltage || !enableInput) state = DriveState::SwitchOnDisabled;
            if (quickStop) state = DriveState::QuickStopActive;
            if (wasEnabled && !firstTargetAfterEnable) firstTargetAfterEnable = target;
            break;
        case DriveState::QuickStopActive:
            if (disableVoltage || !enableInput) state = DriveState::SwitchOnDisabled;
            break;
        case DriveState::NotReadyToSwitchOn:
        case DriveState::FaultReactionActive:
        case DriveState::Fault:
            break;
    }
}

void SimDrive::stepMotor() {
    const std::int64_t before = position;
    if (state == DriveState::OperationEnabled && mode == 8) {
        // One cycle from target to motor; the target's 32 bits are unfolded around the present
        // position.
        const auto delta = static_cast<std::int32_t>(static_cast<std::uint32_t>(pendingTarget_) -
                                                     static_cast<std::uint32_t>(position));
        position += delta;
        worstStep = std::max(worstStep, std::abs(position - before));
        pendingTarget_ = target;
    } else if (state == DriveState::OperationEnabled && mode == 6) {
        stepHoming();
        pendingTarget_ = position;
    } else if (state == DriveState::QuickStopActive) {
        const auto slower = std::max<std::int64_t>(0, std::abs(lastStep_) - quickStopStep);
        position += lastStep_ < 0 ? -slower : slower;
    } else {
        position += drift;
        pendingTarget_ = position;
    }
    if (blockedAt) position = *blockedAt;
    lastStep_ = position - before;
    if (mode != 6 || state != DriveState::OperationEnabled) {
        homingRuns_ = false;
        if (!keepsHomingBits) homingDone_ = homingError_ = false;
    }
}

void SimDrive::stepHoming() {
    const bool start = (controlword & 0x10U) != 0;
    if (!start) {
        homingRuns_ = false;
        return;
    }
    if (!homingRuns_) {
        homingRuns_ = true;
        homingDone_ = homingError_ = false;
        homingLeft_ = homingTravel;
        return;
    }
    if (homingDone_ || homingError_) return;
    if (homingLeft_ != 0) {
        const std::int64_t step = std::clamp(homingLeft_, -kHomingSpeed, kHomingSpeed);
        position += step;
        homingLeft_ -= step;
        return;
    }
    if (homingNeverEnds) return;
    if (homingFails) {
        homingError_ = true;
        return;
    }
    homingDone_ = true;
    position = homingZeroAt;  // the drive takes its zero: 6064h jumps
}

std::uint16_t SimDrive::statusword() const {
    std::uint16_t s = 0x0210;
    switch (state) {
        case DriveState::NotReadyToSwitchOn:
            break;
        case DriveState::SwitchOnDisabled:
            s |= 0x0040U;
            break;
        case DriveState::ReadyToSwitchOn:
            s |= 0x0021U;
            break;
        case DriveState::SwitchedOn:
            s |= 0x0023U;
            break;
        case DriveState::OperationEnabled:
            s |= 0x0027U;
            break;
        case DriveState::QuickStopActive:
            s |= 0x0007U;
            break;
        case DriveState::FaultReactionActive:
            s |= 0x000FU;
            break;
        case DriveState::Fault:
            s |= 0x0008U;
            break;
    }
    if (mode == 6) {
        if (homingDone_) s |= 0x1000U;
        if (homingError_) s |= 0x2000U;
        if (homingDone_ || homingError_ || !homingRuns_) s |= 0x0400U;
    } else if (state == DriveState::OperationEnabled) {
        s |= 0x1000U;
    }
    return s;
}

void SimDrive::latchInputs() {
    put16(latched_, 0, statusword());
    latched_[2] = static_cast<std::uint8_t>(fixedMode != 0 ? fixedMode : mode);
    put32(latched_, 3, static_cast<std::uint32_t>(position));
    put16(latched_, 7, faultCode);
}

}  // namespace takt::test
