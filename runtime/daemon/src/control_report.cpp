// What the control server tells of the machine.
#include <fmt/format.h>
#include <unistd.h>

#include "control_server.hpp"
#include "network_summary.hpp"

namespace takt::daemon {

namespace {

AxisReport reportOf(const AxisEntry& entry, const ControlNames& names, std::size_t index) {
    const axis::AxisStatus& status = entry.status;
    AxisReport report;
    report.name = names.axes[index];
    report.unit = names.units[index];
    report.state = axis::name(status.state);
    report.set = status.set.count();
    report.actual = status.actual.count();
    report.velocity = status.actualVelocity.count();
    report.lag = status.lag.count();
    report.powered = status.powered;
    report.homed = status.homed;
    report.needsEnableEdge = entry.needsEnableEdge;
    if (entry.error.id != axis::ErrorId::None) report.error = axis::explain(entry.error);
    if (entry.holder < names.programs.size()) report.holder = names.programs[entry.holder];
    return report;
}

GroupReport reportOf(const GroupEntry& entry, const ControlNames& names, std::size_t index) {
    const axis::GroupStatus& status = entry.status;
    GroupReport report;
    report.name = names.groups[index];
    report.unit = names.groupUnits[index];
    report.state = axis::name(status.state);
    report.path = status.path.count();
    report.velocity = status.velocity.count();
    report.queued = status.queued;
    if (entry.error.id != axis::ErrorId::None) report.error = axis::explain(entry.error);
    return report;
}

ProgramReport reportOf(const ProgramEntry& entry, const std::string& programName,
                       const std::vector<std::string>& watches) {
    ProgramReport report;
    report.name = programName;
    report.state = name(entry.phase, entry.held);
    for (std::size_t i = 0; i < watches.size() && i < entry.watches.size(); ++i) {
        report.watches.push_back({watches[i], entry.watches[i]});
    }
    return report;
}

}  // namespace

StatusReport ControlServer::report() const {
    const StatusBoard& board = parts_.control.board();
    const ControlNames& names = parts_.control.names();
    const RunEntry run = board.run.read();
    StatusReport report;
    report.machine = parts_.machine.name;
    report.pid = ::getpid();
    report.cycle = run.cycle;
    report.seconds = secondsOf(run.cycle);
    report.phase = name(run.phase);
    report.network = fieldbus::ethercat::name(run.network);
    report.framesSent = run.counters.framesSent;
    report.framesLost = run.counters.framesLost;
    report.framesLate = run.counters.framesLate;
    report.workingCounterErrors = run.counters.workingCounterErrors;
    if (run.stop.cause != StopCause::None) {
        report.machineStop = describe(run.stop, names.stopInputs, names.programs, names.axes);
    }
    report.owner = gate_.ownerName();
    if (parts_.bridge != nullptr) {
        report.bridgeProcess = parts_.bridge->process().pid();
        report.bridgeStarts = parts_.bridge->process().starts();
        report.bridgePublished = parts_.bridge->published();
    }
    for (std::size_t i = 0; i < board.axes.size(); ++i) {
        report.axes.push_back(reportOf(board.axes[i].read(), names, i));
    }
    for (std::size_t i = 0; i < board.groups.size(); ++i) {
        report.groups.push_back(reportOf(board.groups[i].read(), names, i));
    }
    for (std::size_t i = 0; i < board.programs.size(); ++i) {
        const ProgramEntry entry = board.programs[i].read();
        report.programs.push_back(
            reportOf(entry, names.programs[i], parts_.stock.watchNames(i, entry.instance)));
    }
    return report;
}

NetworkReport ControlServer::networkReport() const {
    const DiagnosisBoard& board = parts_.control.diagnosis();
    std::vector<DeviceEntry> devices;
    for (const auto& device : board.devices) devices.push_back(device.read());
    return summarize(parts_.machine, board.run.read(), devices);
}

std::vector<EventReport> ControlServer::eventsAfter(std::uint64_t number) const {
    std::vector<EventReport> events;
    for (const EventReport& event : events_) {
        if (event.number > number) events.push_back(event);
    }
    return events;
}

double ControlServer::secondsOf(core::CycleNumber cycle) const {
    return static_cast<double>(cycle) *
           std::chrono::duration<double>{parts_.machine.network.cycle}.count();
}

}  // namespace takt::daemon
