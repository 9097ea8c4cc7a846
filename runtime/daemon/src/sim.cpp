#include <fmt/format.h>

#include <chrono>
#include <stdexcept>
#include <takt/config/load_machine.hpp>
#include <takt/daemon/run_options.hpp>
#include <takt/daemon/sim.hpp>
#include <thread>

#include "console.hpp"
#include "realtime_thread.hpp"
#include "sim_server.hpp"
#include "stop_request.hpp"

namespace takt::daemon {

namespace {

using namespace std::chrono_literals;

/// Below the cycle of a master on the same computer, which waits for the answer anyway.
constexpr int ServerPriority = 70;
constexpr auto PrintInterval = 20ms;

std::string standing(const std::string& name, const twin::DeviceProbe& probe) {
    std::string text =
        fmt::format("{}: {}{}, drive {}", name, wire::name(probe.alState),
                    probe.alError ? " with error" : "", core::cia402::name(probe.driveState));
    if (probe.alStatusCode != 0) {
        text += fmt::format("; AL status 0x{:04X}: {}", probe.alStatusCode,
                            wire::explainAlStatus(probe.alStatusCode));
    }
    return text;
}

void printEvents(SimServer& server, const config::MachineConfig& machine, Console& console) {
    SimEvent event;
    while (server.next(event)) {
        console.line(fmt::format(
            "{:.3f} s  {}", std::chrono::duration<double>{event.time.time_since_epoch()}.count(),
            standing(machine.network.slaves[event.device].name, event.probe)));
    }
}

void serve(const SimOptions& options, const config::MachineConfig& machine, Console& console) {
    const StopRequest stop;
    SimServer server{machine, options.interface};
    Notes notes;
    RealtimeThread thread{{"takt-sim", ServerPriority, -1}, [&server] { server.serve(); }, notes};
    dropCapabilities();
    for (const std::string& note : notes.lines()) console.line(note);
    console.line(fmt::format("{}: {} simulated devices on {}", machine.name,
                             machine.network.slaves.size(), options.interface));
    while (stop.count() == 0) {
        printEvents(server, machine, console);
        std::this_thread::sleep_for(PrintInterval);
    }
    server.stop();
    thread.join();
    printEvents(server, machine, console);
    for (std::size_t i = 0; i < machine.network.slaves.size(); ++i) {
        const twin::DeviceProbe probe = server.probe(i);
        console.line(fmt::format(
            "end: {}; motor at {:.6f} turns, {:.3f} turns/s; {} cycles, {} without new outputs",
            standing(machine.network.slaves[i].name, probe), probe.motorTurns, probe.motorVelocity,
            probe.cycles, probe.missedOutputs));
    }
    console.line(fmt::format("{} frames answered", server.frames()));
}

}  // namespace

int sim(const SimOptions& options) {
    Console console{options.quiet};
    const config::LoadResult loaded =
        config::loadMachine(options.machine, {}, config::ProgramLibraries::NotNeeded);
    for (const config::Diagnostic& diagnostic : loaded.diagnostics.items()) {
        console.error(config::format(diagnostic));
    }
    if (!loaded.machine) return static_cast<int>(ExitCode::Refused);
    try {
        serve(options, *loaded.machine, console);
    } catch (const std::runtime_error& error) {
        console.error(error.what());
        return static_cast<int>(ExitCode::CouldNotRun);
    }
    return static_cast<int>(ExitCode::Good);
}

}  // namespace takt::daemon
