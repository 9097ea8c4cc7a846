#pragma once

#include <functional>
#include <memory>
#include <string>
#include <takt/config/machine_config.hpp>
#include <takt/daemon/run_options.hpp>
#include <takt/fieldbus/ethercat/master.hpp>
#include <vector>

#include "axes.hpp"
#include "program_host.hpp"

namespace takt::daemon {

/// Makes an instance of a program, again and again.
using ProgramFactory = std::function<program::LoadedProgram()>;

/// The programs of a machine, and for each what makes a fresh one.
struct LoadedPrograms {
    std::vector<ProgramHost> hosts;
    std::vector<ProgramFactory> factories;
};

/// Loads every program of the machine: linked ones by name, the others from their libraries.
/// `problems` gets one `file:line: …` for each that cannot be had.
LoadedPrograms loadPrograms(const config::MachineConfig& machine, std::vector<LinkedProgram> linked,
                            std::vector<std::string>& problems);

/// The machine's axes, not yet bound to a bus, at the end of `axes`.
void makeAxes(const config::MachineConfig& machine, Axes& axes);

/// Its groups of these axes, at the end of `groups`.
void makeGroups(const config::MachineConfig& machine, Axes& axes, Groups& groups);

/// Where each drive's objects lie in its device's process data: where `bound` says it, else where
/// they are mapped.
axis::DriveBindings bindingsOf(const fieldbus::SlaveParams& slave,
                               const axis::DriveBindings& bound);

/// Binds each axis to the process data and objects of its drive.
void attachAxes(const config::MachineConfig& machine, fieldbus::ethercat::Master& master,
                Axes& axes);

}  // namespace takt::daemon
