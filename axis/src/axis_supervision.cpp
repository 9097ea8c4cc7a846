#include <algorithm>
#include <takt/axis/axis.hpp>

namespace takt::axis {

namespace cia = core::cia402;

void Axis::supervise() noexcept {
    const bool wasPowered = view_.powered;
    view_.powered = drive_.on() && (drive_.following() || drive_.homing());
    // The moment of switching on: from here the set position leads.
    if (drive_.enabled() && !wasPowered) standAtActual();
    if (view_.state == AxisState::ErrorStop) {
        superviseErrorStop(wasPowered);
        return;
    }
    superviseBus();
    if (view_.state != AxisState::ErrorStop) superviseDrive();
    if (live()) superviseMotion();
}

void Axis::superviseBus() noexcept {
    const core::DeviceHealth& health = drive_.health();
    if (!health.operational) {
        // The reference is in doubt once the device may have been switched off and on.
        if (drive_.inputs().seen) view_.homed = false;
        if (live()) {
            raise(ErrorId::SlaveNotOperational,
                  {static_cast<double>(health.alStatusCode), 0.0, 0.0}, Reaction::Off);
        }
    } else if (health.lostInRow > lostCycles_ && live()) {
        dropAfterRamp_ = true;
        raise(ErrorId::CommunicationLost,
              {static_cast<double>(health.lostInRow), static_cast<double>(lostCycles_), 0.0},
              Reaction::Ramp);
    }
}

void Axis::superviseDrive() noexcept {
    const double statusword = drive_.inputs().statusword;
    if (drive_.fault()) {
        raise(ErrorId::DriveFault, {statusword, 0.0, 0.0}, Reaction::Off);
    } else if (live() && !drive_.on()) {
        raise(ErrorId::PowerLost, {statusword, 0.0, 0.0}, Reaction::Off);
    } else if (live() && !homingRunning_ && !drive_.following()) {
        const double shown = drive_.inputs().modeDisplay;
        raise(ErrorId::ModeChangeFailed, {8.0, shown, 0.0}, Reaction::DriveStop);
    } else if (view_.state == AxisState::Disabled && drive_.enableTimedOut()) {
        raise(ErrorId::EnableTimeout, {statusword, enableTimeout_, 0.0}, Reaction::Off);
    }
}

void Axis::superviseMotion() noexcept {
    if (homingRunning_ || !drive_.following()) return;
    const DriveInputs& in = drive_.inputs();
    if (in.step > jumpCounts_ || in.step < -jumpCounts_) {
        view_.homed = false;
        raise(ErrorId::EncoderError,
              {static_cast<double>(in.step), static_cast<double>(jumpCounts_), 0.0},
              Reaction::DriveStop);
        return;
    }
    if (followingError_.exceeded(lag_)) {
        const double limit = followingError_.limit().count();
        raise(ErrorId::LagExceeded, {lag_.count(), limit, motion_.set().position.count()},
              Reaction::Ramp);
    }
}

void Axis::superviseErrorStop(bool wasPowered) noexcept {
    if (drive_.fault() && view_.error.driveError == 0) {
        view_.error.driveError = drive_.inputs().errorCode;  // may come some cycles later, by SDO
    }
    const core::DeviceHealth& health = drive_.health();
    const bool lostPower = wasPowered && !drive_.on() && view_.powerRequested;
    if (drive_.fault() || lostPower || !health.operational || drive_.enableTimedOut()) {
        react(Reaction::Off);
    }
    if (health.lostInRow > lostCycles_) dropAfterRamp_ = true;
    const bool rests = motion_.resting() || !drive_.following();
    if (dropAfterRamp_ && rests) react(Reaction::DriveStop);
}

void Axis::raise(ErrorId id, Numbers numbers, Reaction reaction) noexcept {
    if (view_.state != AxisState::ErrorStop) {
        view_.error = {id, drive_.fault() ? drive_.inputs().errorCode : std::uint16_t{0},
                       view_.cycle, numbers};
        endAll({CommandPhase::Error, id});
        if (homingRunning_) {
            // The drive moves by its own plan: a ramp of set-points would not reach it.
            homingRunning_ = false;
            view_.homed = false;
            reaction = std::max(reaction, Reaction::DriveStop);
        }
        active_ = Command{};
        planPending_ = false;
        view_.state = AxisState::ErrorStop;
        view_.inVelocity = false;
        view_.stopDone = false;
        view_.stopReleased = true;
        // A grouped axis stops on the path of its group.
        if (drive_.following() && !view_.grouped && !motion_.beginStop()) emergency_ = true;
    }
    react(reaction);
}

void Axis::react(Reaction reaction) noexcept {
    if (reaction <= reaction_) return;
    reaction_ = reaction;
    if (reaction == Reaction::Ramp) return;
    // The drive stays off until the reset, whatever MC_Power asks.
    powerBlocked_ = true;
    drive_.switchOff(reaction == Reaction::Off ? SwitchOff::Immediate : SwitchOff::QuickStop);
}

void Axis::updatePower() noexcept {
    if (view_.state != AxisState::Disabled || !view_.powerRequested) return;
    if (!drive_.enabled() || !drive_.inputs().fresh || !drive_.health().operational) return;
    enterStandstill();
    view_.commandedPosition = motion_.set().position;
}

void Axis::applyPower() noexcept {
    if (powerBlocked_) return;
    if (view_.powerRequested) {
        drive_.switchOn();
        return;
    }
    const bool immediate = traits_.powerOff == PowerOffMode::Immediate;
    const bool stopped = view_.state == AxisState::ErrorStop && (motion_.resting() || immediate);
    if (view_.state == AxisState::Disabled || stopped) {
        drive_.switchOff(immediate ? SwitchOff::Immediate : SwitchOff::Orderly);
    }
}

void Axis::updateReset() noexcept {
    if (resets_.empty()) return;
    if (const ErrorId bad = resetObstacle(); bad != ErrorId::None) {
        finishReset(bad);
        return;
    }
    // The ramp, and a stop made by the drive, end first.
    const bool moving = drive_.following() && !motion_.resting();
    const bool driveStops = drive_.energised() && !drive_.following() && !drive_.fault();
    if (moving) return;
    if (++resetCycles_ > resetLimit_ && !drive_.resetRunning()) {
        finishReset(ErrorId::ResetFailed);
        return;
    }
    if (driveStops || !drive_.inputs().fresh) return;
    if (drive_.fault()) {
        if (drive_.resetRunning()) return;
        if (drive_.resetTimedOut()) {
            finishReset(ErrorId::ResetFailed);
        } else {
            drive_.resetFault();
        }
        return;
    }
    view_.error = {};
    reaction_ = Reaction::None;
    powerBlocked_ = false;
    dropAfterRamp_ = false;
    const bool on = drive_.enabled() && view_.powerRequested;
    view_.state = on ? AxisState::Standstill : AxisState::Disabled;
    finishReset(ErrorId::None);
}

/// A cause that is still there and that no waiting removes.
ErrorId Axis::resetObstacle() const noexcept {
    const core::DeviceHealth& health = drive_.health();
    if (!health.operational) return ErrorId::SlaveNotOperational;
    if (health.lostInRow > lostCycles_) return ErrorId::CommunicationLost;
    if (drive_.following() && motion_.resting() && followingError_.above(lag_)) {
        return ErrorId::LagExceeded;
    }
    return ErrorId::None;
}

void Axis::finishReset(ErrorId error) noexcept {
    const CommandPhase phase = error == ErrorId::None ? CommandPhase::Done : CommandPhase::Error;
    for (const CommandId id : resets_) report(id, {phase, error});
    resetError_ = error;
    resets_.clear();
    drive_.forgetReset();
}

}  // namespace takt::axis
