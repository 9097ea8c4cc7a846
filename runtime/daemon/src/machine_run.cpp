#include "machine_run.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <takt/axis/error.hpp>

namespace takt::daemon {

namespace {

using namespace std::chrono_literals;
using fieldbus::ethercat::NetworkState;

constexpr core::Duration OpTimeout = 30s;
constexpr core::Duration StopTimeout = 10s;
constexpr core::Duration QuickStopTime = 1s;  ///< for the drives, after StopTimeout
constexpr core::Duration InitTimeout = 10s;

double seconds(core::Duration duration) { return std::chrono::duration<double>{duration}.count(); }

}  // namespace

MachineRun::MachineRun(const RunOptions& options, LoadedMachine& machine, Recorders& recorders,
                       Console& console)
    : options_{options},
      machine_{machine.config},
      recorders_{recorders},
      console_{console},
      axes_{machine.axes},
      programs_{machine.programs},
      reported_(programs_.size(), false),
      bus_{machine_, recorders.capture()},
      dcLock_{machine_.scheduler.dcLock, machine_.network.cycle},
      grid_{core::HostTime{}, machine_.network.cycle},
      control_{{machine_, bus_.master(), axes_, programs_}, machine.commands, !options.recordCommands.empty()},
      server_{{machine_, programs_, control_}, options.socket, options.recordCommands},
      cycle_{{bus_.master(), axes_, programs_, grid_, dcLock_, recorders_, control_}},
      pace_{!options.fast} {
    attachAxes(machine_, bus_.master(), axes_);
}

int MachineRun::execute() {
    if (!bringUp()) return exitCode();
    const core::HostTime began = bus_.clock().now();
    grid_ = scheduler::Grid{bus_.master().firstSend(began + machine_.network.cycle), machine_.network.cycle};
    bus_.master().prepare();
    bus_.master().requestOp();
    enter(Phase::GoingOp);
    while (phase_ != Phase::Over) {
        const scheduler::Beat beat = grid_.wait(bus_.clock());
        cycle_.run(beat, orders_);
        now_ = beat.number + 1;
        recorders_.drain();
        supervise();
        showProgress();
        pace_.wait(bus_.clock().now() - began);
    }
    for (ProgramHost& program : programs_) program.stop();
    conclude();
    return exitCode();
}

bool MachineRun::bringUp() {
    console_.line(fmt::format("{}: {} devices, {} axes, cycle {} us", machine_.name,
                              machine_.network.slaves.size(), axes_.size(),
                              machine_.network.cycle.count() / 1000));
    if (options_.socket.empty() && server_.path().filename() != machine_.name + ".sock") {
        console_.line(fmt::format("control socket {}, since another takt runs a machine of this name",
                                  server_.path().string()));
    }
    const auto problems = bus_.master().bringUp([this](std::string_view text) {
        recorders_.drain();
        console_.progress(text);
    });
    recorders_.drain();
    for (const auto& problem : problems) {
        console_.error(fmt::format("{}: {}", problem.origin.empty() ? machine_.file : problem.origin, problem.text));
    }
    if (!problems.empty()) code_ = ExitCode::CouldNotRun;
    return problems.empty();
}

void MachineRun::supervise() {
    switch (phase_) {
        case Phase::BringUp: return;
        case Phase::GoingOp: return superviseGoingOp();
        case Phase::Operating: return superviseOperating();
        case Phase::PoweringOff: return supervisePoweringOff();
        case Phase::LeavingOp: return superviseLeavingOp();
        case Phase::Over: return;
    }
}

void MachineRun::superviseGoingOp() {
    if (bus_.master().state() == NetworkState::Op) {
        console_.line(fmt::format("network in OP after {:.3f} s; DC locked, host clock {:+.1f} ppm",
                                  seconds(inPhase()), dcLock_.driftPpm()));
        orders_.runPrograms = !options_.manual;
        orders_.operating = true;
        return enter(Phase::Operating);
    }
    if (bus_.master().state() == NetworkState::Failed) {
        fail(ExitCode::CouldNotRun, std::string{bus_.master().problem()});
    } else if (inPhase() > OpTimeout) {
        fail(ExitCode::CouldNotRun, fmt::format("the network did not reach OP within {} s: {}",
                                                OpTimeout / 1s, bus_.master().problem()));
    } else if (stop_.count() == 0) {
        return;
    }
    bus_.master().requestInit();
    enter(Phase::LeavingOp);
}

void MachineRun::superviseOperating() {
    reportEndedPrograms();
    reportMachineStop();
    const bool allEnded = std::all_of(programs_.begin(), programs_.end(),
                                      [](const ProgramHost& program) { return program.ended(); });
    const bool timeOver = options_.length && inPhase() >= *options_.length;
    if (!(allEnded && !options_.manual) && !timeOver && stop_.count() == 0) return;
    orders_.runPrograms = false;
    orders_.operating = false;
    orders_.stopAxes = true;
    enter(Phase::PoweringOff);
}

void MachineRun::supervisePoweringOff() {
    if (stop_.count() > 1) quickStopAll();
    const bool allOff = std::all_of(axes_.begin(), axes_.end(),
                                    [](const axis::Axis& axis) { return axis.isDisabled(); });
    if (!allOff && inPhase() < StopTimeout) return;
    if (!allOff && !stopTimedOut_) {
        stopTimedOut_ = true;
        for (const axis::Axis& axis : axes_) {
            if (axis.isDisabled()) continue;
            fail(ExitCode::StopTimeout,
                 fmt::format("axis {} did not stop and power off within {} s; its drive stops it now", axis.name(),
                             StopTimeout / 1s));
        }
        quickStopAll();
    }
    // No drive is left alone in motion as long as it may still stop by itself.
    if (!allOff && inPhase() < StopTimeout + QuickStopTime) return;
    bus_.master().requestInit();
    enter(Phase::LeavingOp);
}

void MachineRun::quickStopAll() {
    if (quickStopped_) return;
    quickStopped_ = true;
    for (axis::Axis& axis : axes_) {
        if (!axis.isDisabled()) axis.quickStop();
    }
}

void MachineRun::superviseLeavingOp() {
    const NetworkState state = bus_.master().state();
    if (state == NetworkState::Init || state == NetworkState::Failed) return enter(Phase::Over);
    if (inPhase() < InitTimeout) return;
    fail(ExitCode::StopTimeout, fmt::format("the network did not go to INIT within {} s", InitTimeout / 1s));
    enter(Phase::Over);
}

void MachineRun::enter(Phase phase) {
    phase_ = phase;
    orders_.phase = phase;
    phaseBegan_ = now_;
}

void MachineRun::fail(ExitCode code, const std::string& why) {
    console_.error(why);
    if (code_ == ExitCode::Good) code_ = code;
}

void MachineRun::reportEndedPrograms() {
    for (std::size_t i = 0; i < programs_.size(); ++i) {
        const ProgramHost& program = programs_[i];
        if (!program.ended() || reported_[i]) continue;
        reported_[i] = true;
        const std::string seen = program.watches();
        const std::string where = fmt::format("program '{}' in cycle {}{}{}", program.name(), program.endCycle(),
                                              seen.empty() ? "" : ": ", seen);
        switch (program.phase()) {
            case ProgramPhase::Waiting:
            case ProgramPhase::Running: break;
            case ProgramPhase::Finished: console_.line(fmt::format("{}: finished", where)); break;
            case ProgramPhase::Failed:
                fail(ExitCode::MachineFault, fmt::format("{}: failed: {}", where, program.failure()));
                break;
            case ProgramPhase::Threw:
                fail(ExitCode::MachineFault,
                     fmt::format("{}: threw an exception: {}; its axes stop on their path", where, program.failure()));
                break;
        }
    }
}

void MachineRun::reportMachineStop() {
    const MachineStop& stop = control_.machineStop();
    const bool changed = stop.active() != stopReported_;
    stopReported_ = stop.active();
    if (!changed) return;
    if (!stop.active()) return console_.line(fmt::format("machine stop reset before cycle {}", now_));
    const ControlNames& names = control_.names();
    const StopRecord& record = stop.record();
    std::string why = describe(record, names.stopInputs, names.programs, names.axes);
    if (record.cause == StopCause::Program) {
        why += fmt::format(": {}", programs_[record.source].machine().stopReason());
    }
    console_.error(fmt::format("machine stop in cycle {} by {}; axes stop and are switched off", record.cycle, why));
}

void MachineRun::showProgress() {
    const auto perSecond = static_cast<core::CycleNumber>(1s / machine_.network.cycle);
    if (perSecond == 0 || now_ % perSecond != 0) return;
    std::string text = fmt::format("{:7.1f} s", static_cast<double>(now_) * seconds(machine_.network.cycle));
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        const axis::AxisStatus status = axes_[i].status();
        text += fmt::format("   {} {:9.3f} {} {}", axes_[i].name(), status.actual.count(),
                            machine_.axes[i].unit, axis::name(status.state));
    }
    console_.progress(text);
}

void MachineRun::conclude() {
    if (!server_.finish()) {
        fail(ExitCode::CouldNotRun,
             fmt::format("{}: not complete; is the disk full?", options_.recordCommands.string()));
    }
    for (const axis::Axis& axis : axes_) {
        const axis::AxisStatus status = axis.status();
        if (status.state != axis::AxisState::ErrorStop) continue;
        fail(ExitCode::MachineFault,
             fmt::format("axis {} ended in ErrorStop: {}", axis.name(), axis::explain(axis.error())));
    }
    const double simulated = static_cast<double>(now_) * seconds(machine_.network.cycle);
    const double wall = seconds(pace_.elapsed());
    const auto counters = bus_.master().counters();
    console_.line(fmt::format("{:.3f} s in {} cycles, {:.1f} times real time; frames {} sent, {} lost, {} late; "
                              "working counter errors {}; largest DC phase error {} ns",
                              simulated, now_, wall > 0 ? simulated / wall : 0.0, counters.framesSent, counters.framesLost,
                              counters.framesLate, counters.workingCounterErrors, cycle_.worstPhaseError().count()));
}

std::string MachineRun::summary() const {
    return fmt::format("{} cycles of {} us on the simulated machine", now_, machine_.network.cycle.count() / 1000);
}

core::Duration MachineRun::inPhase() const {
    return machine_.network.cycle * static_cast<std::int64_t>(now_ - phaseBegan_);
}

int MachineRun::exitCode() const {
    if (code_ != ExitCode::StopTimeout && stop_.count() > 0) return 128 + stop_.signal();
    return static_cast<int>(code_);
}

}  // namespace takt::daemon
