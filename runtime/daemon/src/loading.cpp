#include "loading.hpp"

#include <fmt/format.h>

#include <string>
#include <takt/config/load_faults.hpp>
#include <takt/config/load_machine.hpp>
#include <takt/fieldbus/bus_timing.hpp>
#include <utility>

#include "command_file.hpp"
#include "machine_control.hpp"

namespace takt::daemon {

namespace {

/// A cycle needs room for what is not planned: design limit of the bus load.
constexpr double MaxLoad = 0.8;

/// `--manual` leaves the programs out, `--program` puts one in their place.
void choosePrograms(const RunOptions& options, config::MachineConfig& machine) {
    if (!options.manual && options.programLibrary.empty()) return;
    machine.programs.clear();
    if (options.manual) return;
    program::ProgramParams params;
    params.name = options.programLibrary.stem().string();
    params.library = options.programLibrary.string();
    params.origin = "--program";
    machine.programs.push_back(std::move(params));
}

config::ProgramLibraries librariesOf(const RunOptions& options) noexcept {
    const bool own = !options.manual && options.programLibrary.empty();
    return own ? config::ProgramLibraries::Needed : config::ProgramLibraries::NotNeeded;
}

void checkLoad(const config::MachineConfig& machine, std::vector<std::string>& problems) {
    const fieldbus::BusTiming timing = fieldbus::computeTiming(machine.network);
    if (timing.load <= MaxLoad) return;
    problems.push_back(fmt::format(
        "{}: error: the bus needs {:.0f} % of the cycle of {} us; allowed: {:.0f} %; "
        "do: use a longer cycle or map fewer objects",
        machine.file, timing.load * 100, machine.network.cycle.count() / 1000, MaxLoad * 100));
}

/// Faults belong to the simulated machine, so they go to its twin. \return false when they are
/// refused
bool readFaults(const RunOptions& options, config::LoadResult& result, Console& console) {
    config::Diagnostics diagnostics;
    const auto faults = config::loadFaults(options.faults, diagnostics);
    for (const config::Diagnostic& diagnostic : diagnostics.items()) {
        console.error(config::format(diagnostic));
    }
    if (faults && result.machine) result.machine->twin.faults = *faults;
    return faults.has_value();
}

}  // namespace

std::optional<LoadedMachine> loadMachine(const RunOptions& options,
                                         std::vector<LinkedProgram> linked, Console& console) {
    config::LoadResult result =
        config::loadMachine(options.machine, options.searchDirs, librariesOf(options));
    for (const config::Diagnostic& diagnostic : result.diagnostics.items()) {
        console.error(config::format(diagnostic));
    }
    if (!options.faults.empty() && !readFaults(options, result, console)) return std::nullopt;
    if (!result.machine) return std::nullopt;

    std::optional<LoadedMachine> loaded{std::in_place};
    LoadedMachine& machine = *loaded;
    machine.config = std::move(*result.machine);
    choosePrograms(options, machine.config);
    std::vector<std::string> problems;
    checkLoad(machine.config, problems);
    makeAxes(machine.config, machine.axes);
    makeGroups(machine.config, machine.axes, machine.groups);
    LoadedPrograms programs = loadPrograms(machine.config, std::move(linked), problems);
    machine.programs = std::move(programs.hosts);
    machine.factories = std::move(programs.factories);
    for (ProgramHost& program : machine.programs) {
        for (const std::string& text : program.start(machine.config)) {
            problems.push_back(fmt::format("{}: error: {}", program.origin(), text));
        }
    }
    if (problems.empty() && machine.programs.empty() && !options.manual) {
        problems.push_back(
            fmt::format("{}: error: no program; do: name one with <Program> or --program, or "
                        "run with --manual",
                        machine.config.file));
    }
    if (!options.commands.empty()) {
        const ControlNames names = controlNames(machine.config, machine.programs);
        machine.commands = readCommands(options.commands, names, problems);
    }
    for (const std::string& problem : problems) console.error(problem);
    if (!problems.empty()) return std::nullopt;
    return loaded;
}

}  // namespace takt::daemon
