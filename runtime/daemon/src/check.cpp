#include <fmt/format.h>

#include <takt/daemon/run.hpp>
#include <takt/fieldbus/bus_timing.hpp>
#include <takt/fieldbus/pdo_layout.hpp>
#include <takt/wire/device_description.hpp>

#include "loading.hpp"

namespace takt::daemon {

namespace {

double microseconds(core::Duration duration) {
    return std::chrono::duration<double, std::micro>{duration}.count();
}

void printNetwork(const fieldbus::NetworkParams& network, Console& console) {
    console.line(fmt::format("{:>3} {:<16} {:<12} {:>8} {:>8}  {}", "pos", "slave", "device", "out",
                             "in", "dc"));
    for (const fieldbus::SlaveParams& slave : network.slaves) {
        console.line(fmt::format(
            "{:>3} {:<16} {:<12} {:>6} B {:>6} B  {}", slave.position, slave.name,
            slave.device->type, fieldbus::processDataBytes(slave, fieldbus::Direction::Outputs),
            fieldbus::processDataBytes(slave, fieldbus::Direction::Inputs),
            slave.dc.enabled ? fmt::format("SYNC0 {:.1f} us", microseconds(slave.dc.sync0Cycle))
                             : std::string{"off"}));
    }
    const fieldbus::BusTiming timing = fieldbus::computeTiming(network);
    console.line(
        fmt::format("cycle {:.1f} us: {} frame(s), {} bytes, wire {:.1f} us, round trip {:.1f} us",
                    microseconds(network.cycle), timing.frames, timing.frameBytes,
                    microseconds(timing.wireTime), microseconds(timing.roundTrip)));
    console.line(
        fmt::format("receive deadline {:.1f} us after the send, SYNC0 {:.1f} us after the send, "
                    "{:.0f} % of the cycle needed",
                    microseconds(timing.receiveDeadline), microseconds(timing.sync0AfterSend),
                    timing.load * 100));
}

void printAxes(const config::MachineConfig& machine, Console& console) {
    for (const axis::AxisParams& axis : machine.axes) {
        const axis::ScalingParams& s = axis.scaling;
        const double countsPerUnit =
            static_cast<double>(s.countsPerTurn) * static_cast<double>(s.gearMotor) *
            static_cast<double>(s.unitsPerTurnDenominator) /
            (static_cast<double>(s.gearLoad) * static_cast<double>(s.unitsPerTurnNumerator));
        console.line(fmt::format(
            "axis {}: slave {} ({}), {:.6g} counts/{}, {:.6g} {}/s = {:.6g} counts per cycle",
            axis.name, axis.drive.slave, axis.drive.profile, countsPerUnit, axis.unit,
            axis.limits.velocity.count(), axis.unit,
            axis.limits.velocity.count() * countsPerUnit *
                std::chrono::duration<double>{machine.network.cycle}.count()));
    }
}

void printBridge(const config::MachineConfig& machine, Console& console) {
    const bridge::DdsParams& dds = machine.bridge.dds;
    if (!dds.enabled) return;
    const double period = std::chrono::duration<double>{machine.network.cycle}.count() *
                          static_cast<double>(dds.everyCycles);
    console.line(fmt::format("bridge: DDS domain {} on {}, status at {:g} Hz, commands {}",
                             dds.domain, dds.interface, 1 / period,
                             dds.commands ? "from every user of this computer" : "off"));
}

}  // namespace

int check(const RunOptions& options) {
    Console console{options.quiet};
    if (!std::filesystem::is_regular_file(options.machine)) {
        console.error(fmt::format("{}: no such file; allowed: the path of a machine file",
                                  options.machine.string()));
        return static_cast<int>(ExitCode::CouldNotRun);
    }
    const auto machine = loadMachine(options, {}, console);
    if (!machine) return static_cast<int>(ExitCode::Refused);
    printNetwork(machine->config.network, console);
    printAxes(machine->config, console);
    printBridge(machine->config, console);
    console.line(fmt::format("{}: good", machine->config.file));
    return 0;
}

}  // namespace takt::daemon
