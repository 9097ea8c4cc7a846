// The part of MachineRun that runs in the cycle's thread, after each cycle and by its rules.
#include <algorithm>
#include <takt/core/cycle_guard.hpp>

#include "machine_run.hpp"
#include "run_limits.hpp"

namespace takt::daemon {

using fieldbus::ethercat::NetworkState;

void MachineRun::oneCycle() noexcept {
    const scheduler::Beat beat = grid_.wait(bus_.clock());
    bus_.beginCycle(beat.number);
    orders_.allTold = told_.load(std::memory_order_acquire) == noted_;
    cycle_.run(beat, orders_);
    doJobs();
    now_ = beat.number + 1;
    const core::CycleGuard guard;
    superviseOverruns(beat);
    supervise();
    if (control_.diagnosis().wanted()) control_.diagnosis().show(diagnosis(), bus_.master());
}

DiagnosisEntry MachineRun::diagnosis() const noexcept {
    return {.cycle = now_,
            .statistics = cycle_.statistics(),
            .lateWakeUps = overruns_.overruns(),
            .missedCycles = overruns_.skipped(),
            .relocks = dcLock_.relocks(),
            .clockLocked = dcLock_.locked(),
            .driftPpm = dcLock_.driftPpm(),
            .network = bus_.master().state(),
            .problem = bus_.master().problemRecord(),
            .counters = bus_.master().counters()};
}

/// Jobs: in virtual time between the cycles, on a machine on a thread of their own.
void MachineRun::doJobs() noexcept {
    if (!planning_) {
        planPaths();
        routes_.work();
        return;
    }
    bool paths = false;
    for (axis::Group& group : groups_) paths = group.planner().takeCall() || paths;
    if (paths) planning_->ring();
    if (routes_.takeCalls()) routing_->ring();
}

void MachineRun::planPaths() {
    for (axis::Group& group : groups_) {
        if (group.planner().wanted()) group.planner().work();
    }
}

void MachineRun::supervise() noexcept {
    switch (phase_) {
        case Phase::BringUp:
            return;
        case Phase::GoingOp:
            return superviseGoingOp();
        case Phase::Operating:
            return superviseOperating();
        case Phase::PoweringOff:
            return supervisePoweringOff();
        case Phase::LeavingOp:
            return superviseLeavingOp();
        case Phase::Over:
            return;
    }
}

void MachineRun::superviseOverruns(const scheduler::Beat& beat) noexcept {
    const scheduler::OverrunVerdict verdict = overruns_.update(beat.skipped);
    const bool tell = machine_.scheduler.overruns.policy == scheduler::OverrunPolicy::React;
    if (tell && beat.skipped > 0 && overruns_.overruns() == 1)
        note(RunNotice::Kind::CycleMissed, 0, beat.skipped);
    const bool moving = phase_ == Phase::Operating || phase_ == Phase::PoweringOff;
    if (!moving || verdict == scheduler::OverrunVerdict::Fine) return;
    if (verdict == scheduler::OverrunVerdict::DriveStop && !quickStopped_) {
        fail(ExitCode::MachineFault, RunNotice::Kind::DrivesStopped);
        quickStopAll();
    } else if (phase_ == Phase::Operating) {
        fail(ExitCode::MachineFault, RunNotice::Kind::StoppedOnPath);
    }
    if (phase_ == Phase::Operating) endOperation();
}

void MachineRun::superviseGoingOp() noexcept {
    const NetworkState state = bus_.master().state();
    if (state == NetworkState::Op) {
        note(RunNotice::Kind::ReachedOp);
        orders_.runPrograms = !options_.manual;
        orders_.operating = true;
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
    noteMachineStop();
    const bool allEnded = std::all_of(programs_.begin(), programs_.end(),
                                      [](const ProgramHost& program) { return program.ended(); });
    const bool timeOver = options_.length && inPhase() >= *options_.length;
    if ((allEnded && !options_.manual) || timeOver || stop_.count() > 0) endOperation();
}

/// From now on every axis ramps down and is switched off.
void MachineRun::endOperation() noexcept {
    orders_.runPrograms = false;
    orders_.operating = false;
    orders_.stopAxes = true;
    enter(Phase::PoweringOff);
}

void MachineRun::supervisePoweringOff() noexcept {
    if (stop_.count() > 1) quickStopAll();
    const bool allOff = std::all_of(axes_.begin(), axes_.end(),
                                    [](const axis::Axis& axis) { return axis.isDisabled(); });
    if (!allOff && inPhase() < StopTimeout) return;
    if (!allOff && !stopTimedOut_) {
        stopTimedOut_ = true;
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            if (!axes_[i].isDisabled())
                fail(ExitCode::StopTimeout, RunNotice::Kind::AxisNotStopped, i);
        }
        quickStopAll();
    }
    // No drive is left alone in motion as long as it may still stop by itself.
    if (!allOff && inPhase() < StopTimeout + QuickStopTime) return;
    bus_.master().requestInit();
    enter(Phase::LeavingOp);
}

void MachineRun::quickStopAll() noexcept {
    if (quickStopped_) return;
    quickStopped_ = true;
    for (axis::Axis& axis : axes_) {
        if (!axis.isDisabled()) axis.quickStop();
    }
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
    orders_.phase = phase;
    phaseBegan_ = now_;
}

void MachineRun::fail(ExitCode code, RunNotice::Kind kind, std::size_t index) noexcept {
    note(kind, index, overruns_.inRow());
    // What does not stop is worse than all else.
    if (code_ == ExitCode::Good || code == ExitCode::StopTimeout) code_ = code;
}

void MachineRun::note(RunNotice::Kind kind, std::size_t index, std::uint64_t number) noexcept {
    send({.kind = kind, .index = index, .cycle = now_, .time = inPhase(), .number = number});
}

void MachineRun::send(const RunNotice& notice) noexcept {
    if (notices_.push(notice)) ++noted_;
}

void MachineRun::noteEndedPrograms() noexcept {
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        const ProgramPhase phase = programs_[i].phase();
        const bool known = endNoted_[i];
        endNoted_[i] = programs_[i].ended();  // a program that was reset may end again
        if (known || !endNoted_[i]) continue;
        note(RunNotice::Kind::ProgramEnded, i);
        if (phase == ProgramPhase::Finished || code_ != ExitCode::Good) continue;
        code_ =
            phase == ProgramPhase::Abandoned ? ExitCode::ProgramAbandoned : ExitCode::MachineFault;
    }
}

void MachineRun::noteMachineStop() noexcept {
    const MachineStop& stop = control_.machineStop();
    for (std::size_t i = 0; i < overdueNoted_.size(); ++i) {
        if (stop.overdue(i) && !overdueNoted_[i])
            fail(ExitCode::StopTimeout, RunNotice::Kind::MachineStopOverdue, i);
        overdueNoted_[i] = stop.overdue(i);
    }
    if (stop.active() == stopNoted_) return;
    stopNoted_ = stop.active();
    const auto kind =
        stopNoted_ ? RunNotice::Kind::MachineStopped : RunNotice::Kind::MachineStopReset;
    send({.kind = kind, .cycle = now_, .stop = stop.record()});
}

core::Duration MachineRun::inPhase() const noexcept {
    return machine_.network.cycle * static_cast<std::int64_t>(now_ - phaseBegan_);
}

}  // namespace takt::daemon
