#include "network_summary.hpp"

#include <fmt/format.h>

#include <takt/wire/al_state.hpp>
#include <takt/wire/device_description.hpp>

namespace takt::daemon {

namespace {

TimesReport timesOf(const record::Histogram& histogram) {
    constexpr std::uint32_t permille99 = 990;
    constexpr std::uint32_t permille999 = 999;
    TimesReport times{.count = histogram.count(),
                      .least = histogram.min(),
                      .mean = histogram.mean(),
                      .mostOf99 = histogram.atMost(permille99),
                      .mostOf999 = histogram.atMost(permille999),
                      .most = histogram.max(),
                      .bins = {}};
    for (std::size_t bin = 0; bin < record::Histogram::Bins - 1; ++bin) {
        if (histogram.bin(bin) == 0) continue;
        times.bins.push_back({(std::uint64_t{1} << bin) - 1, histogram.bin(bin)});
    }
    return times;
}

/// The other devices whose process data travel in the same datagram.
std::string partners(const config::MachineConfig& machine, std::span<const DeviceEntry> devices,
                     std::size_t device) {
    std::string names;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (i == device || devices[i].group != devices[device].group) continue;
        names += (names.empty() ? "" : ", ") + machine.network.slaves[i].name;
    }
    return names;
}

/// A working counter is of a datagram, not of a device: who is in OP has done its part of it.
std::string workingCounterWords(const config::MachineConfig& machine,
                                std::span<const DeviceEntry> devices, std::size_t device) {
    const DeviceEntry& entry = devices[device];
    const auto& counters = entry.counters;
    if (counters.wrong == 0 && counters.lost == 0) return {};
    const bool missing = entry.state.state != wire::AlState::Op || !entry.state.answers;
    std::string words;
    if (counters.wrong > 0) {
        words = fmt::format("wrong in {} cycles, last {} of {}", counters.wrong, counters.lastSeen,
                            counters.expected);
        if (counters.lastSeen != counters.expected)
            words += missing ? ": this device does not take part" : ": not by this device";
    }
    if (counters.lost > 0)
        words += fmt::format("{}no reply in {} cycles", words.empty() ? "" : "; ", counters.lost);
    const std::string others = partners(machine, devices, device);
    if (!others.empty()) words += fmt::format("; the same datagram serves {}", others);
    return words;
}

std::string problemOf(const fieldbus::ethercat::DeviceState& state) {
    if (!state.answers) return "does not answer; check cable and power";
    if (!state.error) return {};
    return fmt::format("0x{:04X} {}", state.alStatusCode,
                       wire::explainAlStatus(state.alStatusCode));
}

DeviceReport deviceOf(const config::MachineConfig& machine, std::span<const DeviceEntry> devices,
                      std::size_t index) {
    const fieldbus::SlaveParams& slave = machine.network.slaves[index];
    const DeviceEntry& entry = devices[index];
    DeviceReport report;
    report.position = index;
    report.station = entry.state.station;
    report.name = slave.name;
    report.type = slave.device->type;
    report.device = slave.device->name;
    report.file = slave.device->source;
    report.vendor = slave.device->identity.vendor;
    report.product = slave.device->identity.product;
    report.revision = slave.device->identity.revision;
    report.state = wire::name(entry.state.answers ? entry.state.state : wire::AlState::None);
    report.error = entry.state.error;
    report.alStatusCode = entry.state.alStatusCode;
    report.problem = problemOf(entry.state);
    report.group = entry.group;
    report.expected = entry.counters.expected;
    report.lastSeen = entry.counters.lastSeen;
    report.wrong = entry.counters.wrong;
    report.lost = entry.counters.lost;
    report.lostInRow = entry.lostInRow;
    report.workingCounter = workingCounterWords(machine, devices, index);
    report.emergencies = entry.emergencies;
    report.lastEmergency = entry.lastEmergency;
    return report;
}

void takeCounters(const fieldbus::ethercat::CycleCounters& counters, NetworkReport& report) {
    report.framesSent = counters.framesSent;
    report.framesLost = counters.framesLost;
    report.framesLate = counters.framesLate;
    report.framesDuplicate = counters.framesDuplicate;
    report.framesMalformed = counters.framesMalformed;
    report.framesForeign = counters.framesForeign;
    report.sendFailures = counters.sendFailures;
    report.workingCounterErrors = counters.workingCounterErrors;
}

void takeStatistics(const CycleStatistics& statistics, NetworkReport& report) {
    const auto by = [&statistics](CyclePart part) {
        return statistics.missedBy[static_cast<std::size_t>(part)];
    };
    report.missedByHost = by(CyclePart::Host);
    report.missedByBus = by(CyclePart::Bus);
    report.missedByPrograms = by(CyclePart::Programs);
    report.missedByAxes = by(CyclePart::Motion);
    report.lateness = timesOf(statistics.lateness);
    report.reply = timesOf(statistics.reply);
    report.execution = timesOf(statistics.execution);
    report.phaseError = timesOf(statistics.phaseError);
}

}  // namespace

NetworkReport summarize(const config::MachineConfig& machine, const DiagnosisEntry& entry,
                        std::span<const DeviceEntry> devices) {
    NetworkReport report;
    report.machine = machine.name;
    report.cycle = entry.cycle;
    report.state = fieldbus::ethercat::name(entry.network);
    if (entry.problem.kind != fieldbus::ethercat::NetworkProblem::Kind::None)
        report.problem = fieldbus::ethercat::Master::explain(machine.network, entry.problem);
    takeCounters(entry.counters, report);
    report.missedCycles = entry.missedCycles;
    report.lateWakeUps = entry.lateWakeUps;
    report.clockLocked = entry.clockLocked;
    report.relocks = entry.relocks;
    report.driftPpm = entry.driftPpm;
    takeStatistics(entry.statistics, report);
    for (std::size_t i = 0; i < devices.size(); ++i)
        report.devices.push_back(deviceOf(machine, devices, i));
    return report;
}

}  // namespace takt::daemon
