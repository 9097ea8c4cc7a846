// The part of MachineRun that runs in the cycle's thread, after each cycle and by its rules.
#include <algorithm>

#include <takt/core/cycle_guard.hpp>

#include "machine_run.hpp"
#include "run_limits.hpp"

namespace takt::daemon {

using fieldbus::ethercat::NetworkState;

void MachineRun::oneCycle() noexcept {
    const scheduler::Beat beat = grid_.wait(bus_.clock());
    cycle_.run(beat, orders_);
    now_ = beat.number + 1;
    const core::CycleGuard guard;
    lights_.update(now_, axes_);
    superviseOverruns(beat);
    supervise();
}

void MachineRun::supervise() noexcept {
    switch (phase_) {
        case Phase::GoingOp: return superviseGoingOp();
        case Phase::Operating: return superviseOperating();
        case Phase::PoweringOff: return supervisePoweringOff();
        case Phase::LeavingOp: return superviseLeavingOp();
        case Phase::Over: return;
    }
}

void MachineRun::superviseOverruns(const scheduler::Beat& beat) noexcept {
    const scheduler::OverrunVerdict verdict = overruns_.update(beat.skipped);
    const bool tell = machine_.scheduler.overruns.policy == scheduler::OverrunPolicy::React;
    if (tell && beat.skipped > 0 && overruns_.overruns() == 1) note(RunNotice::Kind::CycleMissed, 0, beat.skipped);
    const bool moving = phase_ == Phase::Operating || phase_ == Phase::PoweringOff;
    if (!moving || verdict == scheduler::OverrunVerdict::Fine) return;
    if (verdict == scheduler::OverrunVerdict::DriveStop && !quickStopped_) {
        quickStopped_ = true;
        for (axis::Axis& axis : axes_) axis.quickStop();
        fail(ExitCode::MachineFault, RunNotice::Kind::DrivesStopped);
    } else if (phase_ == Phase::Operating) {
        for (axis::Axis& axis : axes_) axis.stopByProgramLoss();
        stopFirst_ = true;
        fail(ExitCode::MachineFault, RunNotice::Kind::StoppedOnPath);
    }
    if (phase_ != Phase::Operating) return;
    orders_.runPrograms = false;
    enter(Phase::PoweringOff);
}

void MachineRun::superviseGoingOp() noexcept {
    const NetworkState state = bus_.master().state();
    if (state == NetworkState::Op) {
        note(RunNotice::Kind::ReachedOp);
        orders_.runPrograms = !options_.manual;
        return enter(Phase::Operating);
    }
    if (state == NetworkState::Failed) {
        fail(ExitCode::CouldNotRun, RunNotice::Kind::NetworkFailed);
    } else if (inPhase() > OpTimeout) {
        fail(ExitCode::CouldNotRun, RunNotice::Kind::OpTimedOut);
    } else if (stop_.count() == 0) {
        return;
    }
    // What was noted speaks of the network as it is now: house is kept before it goes down further.
    bus_.master().requestInit();
    enter(Phase::LeavingOp);
}

void MachineRun::superviseOperating() noexcept {
    noteEndedPrograms();
    const bool allEnded = std::all_of(programs_.begin(), programs_.end(),
                                      [](const ProgramHost& program) { return program.ended(); });
    const bool timeOver = options_.length && inPhase() >= *options_.length;
    if (!(allEnded && !options_.manual) && !timeOver && stop_.count() == 0) return;
    orders_.runPrograms = false;
    for (axis::Axis& axis : axes_) axis.requestPowerOff();
    enter(Phase::PoweringOff);
}

void MachineRun::supervisePoweringOff() noexcept {
    if (stop_.count() > 1 && !quickStopped_) {
        quickStopped_ = true;
        for (axis::Axis& axis : axes_) axis.quickStop();
    }
    const auto rests = [](const axis::Axis& axis) { return axis.isStopped(); };
    if (stopFirst_ && std::all_of(axes_.begin(), axes_.end(), rests)) {
        stopFirst_ = false;
        for (axis::Axis& axis : axes_) axis.requestPowerOff();
    }
    const bool allOff = std::all_of(axes_.begin(), axes_.end(),
                                    [](const axis::Axis& axis) { return axis.isDisabled(); });
    if (!allOff && inPhase() < StopTimeout) return;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        if (!axes_[i].isDisabled()) fail(ExitCode::StopTimeout, RunNotice::Kind::AxisNotStopped, i);
    }
    bus_.master().requestInit();
    enter(Phase::LeavingOp);
}

void MachineRun::superviseLeavingOp() noexcept {
    const NetworkState state = bus_.master().state();
    if (state == NetworkState::Init || state == NetworkState::Failed) return enter(Phase::Over);
    if (inPhase() < InitTimeout) return;
    fail(ExitCode::StopTimeout, RunNotice::Kind::InitTimedOut);
    enter(Phase::Over);
}

void MachineRun::enter(Phase phase) noexcept {
    phase_ = phase;
    phaseBegan_ = now_;
}

void MachineRun::fail(ExitCode code, RunNotice::Kind kind, std::size_t index) noexcept {
    note(kind, index, overruns_.inRow());
    if (code_ == ExitCode::Good) code_ = code;
}

void MachineRun::note(RunNotice::Kind kind, std::size_t index, std::uint64_t number) noexcept {
    notices_.push({kind, index, now_, inPhase(), number});
}

void MachineRun::noteEndedPrograms() noexcept {
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        const ProgramPhase phase = programs_[i].phase();
        if (!programs_[i].ended() || noted_[i]) continue;
        noted_[i] = true;
        note(RunNotice::Kind::ProgramEnded, i);
        if (phase == ProgramPhase::Finished || code_ != ExitCode::Good) continue;
        code_ = phase == ProgramPhase::Abandoned ? ExitCode::ProgramAbandoned : ExitCode::MachineFault;
    }
}

core::Duration MachineRun::inPhase() const noexcept {
    return machine_.network.cycle * static_cast<std::int64_t>(now_ - phaseBegan_);
}

}  // namespace takt::daemon
