#include <takt/axis/drive.hpp>

/// The drive's own homing (mode 6): bit 4 of the controlword starts it and stays set for the whole
/// run, since one of the supported drives treats it as a level and another as an edge whose fall
/// interrupts. Statusword bit 12 attained, bit 10 standing, bit 13 error; finished is 12 and 10
/// together.
namespace takt::axis {

namespace cia = core::cia402;
using cia::DriveState;

namespace {

/// Cycles in a row without motion before the drive is taken back to CSP.
constexpr std::uint32_t kStillCycles = 4;

bool attained(std::uint16_t statusword) noexcept {
    return (statusword & cia::HomingAttained) != 0 && (statusword & cia::TargetReached) != 0;
}

/// Neither result of a homing is shown.
bool clean(std::uint16_t statusword) noexcept {
    return !attained(statusword) && (statusword & cia::HomingError) == 0;
}

}  // namespace

void Drive::home() noexcept {
    homing_ = HomingStep::EnterMode;
    outcome_ = HomingOutcome::Running;
    requestMode(cia::Mode::Homing);
    seenClean_ = false;
    stuck_ = false;
    homingCycles_ = 0;
    stepCycles_ = 0;
}

void Drive::cancelHoming() noexcept {
    if (homing_ == HomingStep::EnterMode || homing_ == HomingStep::Armed ||
        homing_ == HomingStep::Running) {
        endHoming(HomingOutcome::Cancelled, HomingStep::Settle);
    } else if (homing_ == HomingStep::Settle || homing_ == HomingStep::Leave) {
        ending_ = HomingOutcome::Cancelled;
    }
}

void Drive::abandonHoming() noexcept {
    homing_ = HomingStep::Idle;
    outcome_ = HomingOutcome::Cancelled;
    requestMode(cia::Mode::CyclicSynchronousPosition);
    stuck_ = false;
}

void Drive::endHoming(HomingOutcome outcome, HomingStep next) noexcept {
    ending_ = outcome;
    homing_ = next;
    stepCycles_ = 0;
    stillCycles_ = 0;
}

std::uint16_t Drive::homingBits() const noexcept {
    return homing_ == HomingStep::Running ? cia::HomingStart : std::uint16_t{0};
}

void Drive::stepHoming() noexcept {
    if (!inputs_.fresh) return;
    ++homingCycles_;
    ++stepCycles_;
    switch (homing_) {
        case HomingStep::Idle:
            return;
        case HomingStep::EnterMode:
            if (modeReached_) {
                homing_ = HomingStep::Armed;
                stepCycles_ = 0;
            } else if (stepCycles_ > enableLimit_) {
                endHoming(HomingOutcome::ModeFailed, HomingStep::Settle);
            }
            return;
        case HomingStep::Armed:
            // One cycle in mode 6 with bit 4 low: the drive sees the edge, and a result that is not
            // shown here cannot be the one of an earlier homing when it is shown later.
            seenClean_ = clean(inputs_.statusword);
            homing_ = HomingStep::Running;
            stepCycles_ = 0;
            return;
        case HomingStep::Running:
            watchHoming();
            return;
        case HomingStep::Settle:
            settleHoming();
            return;
        case HomingStep::Leave:
            leaveHoming();
            return;
    }
}

void Drive::watchHoming() noexcept {
    const std::uint16_t status = inputs_.statusword;
    const bool done = attained(status);
    if (clean(status)) seenClean_ = true;
    // A drive that still shows the last result needs time to clear it.
    const bool believable = seenClean_ || stepCycles_ > staleLimit_;
    if (believable && (status & cia::HomingError) != 0) {
        endHoming(HomingOutcome::DriveError, HomingStep::Settle);
    } else if (believable && done) {
        endHoming(HomingOutcome::Done, HomingStep::Settle);
    } else if (homingLimit_ != 0 && homingCycles_ > homingLimit_) {
        endHoming(HomingOutcome::TimedOut, HomingStep::Settle);
    }
}

void Drive::settleHoming() noexcept {
    // Leaving mode 6 is bumpless only at standstill.
    const bool still = inputs_.step <= stillStep_ && inputs_.step >= -stillStep_;
    stillCycles_ = still ? stillCycles_ + 1 : 0;
    if (stillCycles_ >= kStillCycles) {
        homing_ = HomingStep::Leave;
        requestMode(cia::Mode::CyclicSynchronousPosition);
        stepCycles_ = 0;
    } else if (stepCycles_ > enableLimit_) {
        stuck_ = true;
    }
}

void Drive::leaveHoming() noexcept {
    if (!modeReached_) {
        stuck_ = stepCycles_ > enableLimit_;
        return;
    }
    // The drive may have moved its zero: what it shows now are its counts, without history.
    if (ending_ == HomingOutcome::Done) {
        const auto raw = static_cast<std::int32_t>(
            static_cast<std::uint32_t>(static_cast<std::uint64_t>(confirmed_)));
        confirmed_ = raw;
        inputs_.counts = raw;
        inputs_.step = 0;
    }
    homing_ = HomingStep::Idle;
    outcome_ = ending_;
}

}  // namespace takt::axis
