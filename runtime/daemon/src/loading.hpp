#pragma once

#include <optional>
#include <takt/config/machine_config.hpp>
#include <takt/daemon/run_options.hpp>
#include <vector>

#include "assembly.hpp"
#include "console.hpp"
#include "control_command.hpp"

namespace takt::daemon {

/// A machine that may be started: its file is good, its bus fits the cycle, its programs are there
/// and know their axes.
struct LoadedMachine {
    config::MachineConfig config;
    Axes axes;
    Groups groups;
    std::vector<ProgramHost> programs;
    std::vector<ProgramFactory> factories;  ///< of the programs
    std::vector<TakenCommand> commands;     ///< to be replayed
};

/// Reads the machine file and all it names, loads the programs and lets each one start. Everything
/// that is wrong is told at once; nothing is opened and nothing moves. \return empty when the
/// machine is refused
std::optional<LoadedMachine> loadMachine(const RunOptions& options,
                                         std::vector<LinkedProgram> linked, Console& console);

}  // namespace takt::daemon
