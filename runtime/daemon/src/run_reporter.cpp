#include "run_reporter.hpp"

#include <fmt/format.h>

#include <takt/axis/error.hpp>

#include "run_limits.hpp"

namespace takt::daemon {

namespace {

using namespace std::chrono_literals;

double seconds(core::Duration duration) {
    return std::chrono::duration<double>{duration}.count();
}

}  // namespace

void RunReporter::tell(const RunNotice& notice) {
    switch (notice.kind) {
        case RunNotice::Kind::ReachedOp:
            return console_.line(
                fmt::format("network in OP after {:.3f} s, clocks locked", seconds(notice.time)));
        case RunNotice::Kind::NetworkFailed:
            return console_.error(master_.problem());
        case RunNotice::Kind::OpTimedOut:
            return console_.error(fmt::format("the network did not reach OP within {} s: {}",
                                              OpTimeout / 1s, master_.problem()));
        case RunNotice::Kind::ProgramEnded:
            return tellProgram(programs_[notice.index]);
        case RunNotice::Kind::AxisNotStopped:
            return console_.error(fmt::format(
                "axis {} did not stop and power off within {} s; its drive stops it now",
                machine_.axes[notice.index].name, StopTimeout / 1s));
        case RunNotice::Kind::InitTimedOut:
            return console_.error(
                fmt::format("the network did not go to INIT within {} s", InitTimeout / 1s));
        case RunNotice::Kind::CycleMissed:
            return console_.line(
                fmt::format("warning: cycle {} came late, {} cycle(s) missed; the count is in the "
                            "summary",
                            notice.cycle, notice.number));
        case RunNotice::Kind::StoppedOnPath:
            return console_.error(fmt::format(
                "cycle {}: too many cycles missed ({} in a row); the axes stop on their "
                "path",
                notice.cycle, notice.number));
        case RunNotice::Kind::MachineStopped:
            return tellMachineStop(notice.stop);
        case RunNotice::Kind::MachineStopReset:
            return console_.line(fmt::format("machine stop reset before cycle {}", notice.cycle));
        case RunNotice::Kind::MachineStopOverdue:
            return console_.error(fmt::format(
                "axis {} did not stop and power off within the {:g} s of the machine stop; its "
                "drive stops it now",
                machine_.axes[notice.index].name, seconds(machine_.machineStop.time)));
        case RunNotice::Kind::DrivesStopped:
            return console_.error(
                fmt::format("cycle {}: {} cycles missed in a row; the drives stop", notice.cycle,
                            notice.number));
    }
}

void RunReporter::tellProgram(const ProgramHost& program) {
    const std::string seen = program.watches();
    const std::string where = fmt::format("program '{}' in cycle {}{}{}", program.name(),
                                          program.endCycle(), seen.empty() ? "" : ": ", seen);
    switch (program.phase()) {
        case ProgramPhase::Waiting:
        case ProgramPhase::Running:
            return;
        case ProgramPhase::Finished:
            return console_.line(fmt::format("{}: finished", where));
        case ProgramPhase::Failed:
            return console_.error(fmt::format("{}: failed: {}", where, program.failure()));
        case ProgramPhase::Threw:
            return console_.error(
                fmt::format("{}: threw an exception: {}; its axes stop on their path", where,
                            program.failure()));
        case ProgramPhase::Abandoned:
            return console_.error(fmt::format(
                "{}: did not come back within its budget and was abandoned; its axes stop "
                "on their path",
                where));
    }
}

void RunReporter::tellMachineStop(const StopRecord& stop) {
    std::string why = describe(stop, names_.stopInputs, names_.programs, names_.axes);
    if (stop.cause == StopCause::Program) {
        // The program keeps its words until the stop is reset.
        why += fmt::format(": {}", programs_[stop.source].machine().stopReason());
    }
    console_.error(fmt::format("machine stop in cycle {} by {}; axes stop and are switched off",
                               stop.cycle, why));
}

void RunReporter::progress(const StatusBoard& board) {
    const core::CycleNumber now = board.run.read().cycle;
    const auto perSecond = static_cast<core::CycleNumber>(1s / machine_.network.cycle);
    if (now < shownAt_ + perSecond) return;
    shownAt_ = now;
    std::string text =
        fmt::format("{:7.1f} s", static_cast<double>(now) * seconds(machine_.network.cycle));
    for (std::size_t i = 0; i < machine_.axes.size(); ++i) {
        const axis::AxisStatus status = board.axes[i].read().status;
        text += fmt::format("   {} {:9.3f} {} {}", machine_.axes[i].name, status.actual.count(),
                            machine_.axes[i].unit, axis::name(status.state));
    }
    console_.progress(text);
}

bool RunReporter::tellErrors(const Movers& movers) {
    bool any = false;
    for (const axis::Axis& axis : movers.axes) {
        if (axis.status().state != axis::AxisState::ErrorStop) continue;
        any = true;
        console_.error(fmt::format("axis {} ended in ErrorStop: {}", axis.name(),
                                   axis::explain(axis.error())));
    }
    for (const axis::Group& group : movers.groups) {
        if (group.state() != axis::GroupState::ErrorStop) continue;
        any = true;
        console_.error(fmt::format("group {} ended in GroupErrorStop: {}", group.name(),
                                   axis::explain(group.view().error)));
    }
    return any;
}

}  // namespace takt::daemon
