#include "status_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace takt::cli {

namespace {

/// "running" of an axis in one word: what keeps it from moving comes first.
std::string noteOf(const daemon::AxisReport& axis) {
    if (!axis.error.empty()) return axis.error;
    std::string note = axis.powered ? "on" : "off";
    note += axis.homed ? ", homed" : ", not homed";
    if (axis.needsEnableEdge) note += ", waits for a new enable";
    if (!axis.holder.empty()) note += fmt::format(", held by program '{}'", axis.holder);
    return note;
}

}  // namespace

std::string statusTable(const daemon::StatusReport& status) {
    std::string text = fmt::format("{}  {}  network {}  {:.3f} s, cycle {}\n", status.machine,
                                   status.phase, status.network, status.seconds, status.cycle);
    text += fmt::format("frames {} sent, {} lost, {} late; working counter errors {}\n",
                        status.framesSent, status.framesLost, status.framesLate,
                        status.workingCounterErrors);
    if (!status.machineStop.empty())
        text += fmt::format("MACHINE STOP by {}\n", status.machineStop);
    if (!status.owner.empty()) text += fmt::format("operated by {}\n", status.owner);
    if (status.bridgeStarts > 0) {
        text += status.bridgeProcess != 0
                    ? fmt::format("bridge process {}, {} samples published, started {} times\n",
                                  status.bridgeProcess, status.bridgePublished, status.bridgeStarts)
                    : fmt::format("bridge down, started {} times\n", status.bridgeStarts);
    }
    std::size_t width = 4;
    for (const auto& axis : status.axes) width = std::max(width, axis.name.size());
    text += fmt::format("\n{:<{}}  {:<18} {:>13} {:>13} {:>12} {:>10}\n", "axis", width, "state",
                        "set", "actual", "velocity", "lag");
    for (const auto& axis : status.axes) {
        text += fmt::format("{:<{}}  {:<18} {:>13.4f} {:>13.4f} {:>12.3f} {:>10.4f} {:<4} {}\n",
                            axis.name, width, axis.state, axis.set, axis.actual, axis.velocity,
                            axis.lag, axis.unit, noteOf(axis));
    }
    for (const auto& group : status.groups) {
        text += fmt::format("group {}  {:<18} path {:.3f} {}, {:.3f} {}/s, {} waiting  {}\n",
                            group.name, group.state, group.path, group.unit, group.velocity,
                            group.unit, group.queued, group.error);
    }
    for (const auto& program : status.programs) {
        text += fmt::format("\nprogram '{}' {}\n", program.name, program.state);
        for (const auto& watch : program.watches)
            text += fmt::format("  {} = {}\n", watch.name, watch.value);
    }
    return text;
}

}  // namespace takt::cli
