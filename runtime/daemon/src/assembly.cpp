#include "assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <takt/core/cia402.hpp>
#include <takt/fieldbus/pdo_layout.hpp>
#include <utility>

namespace takt::daemon {

namespace {

program::ProgramPtr takeLinked(std::vector<LinkedProgram>& linked, const std::string& name) {
    const auto found =
        std::find_if(linked.begin(), linked.end(),
                     [&name](const LinkedProgram& entry) { return entry.name == name; });
    if (found == linked.end()) return nullptr;
    program::ProgramPtr program = std::move(found->program);
    linked.erase(found);
    return program;
}

std::size_t slaveIndex(const fieldbus::NetworkParams& network, const std::string& name) {
    const auto found = std::find_if(network.slaves.begin(), network.slaves.end(),
                                    [&name](const auto& slave) { return slave.name == name; });
    return static_cast<std::size_t>(found - network.slaves.begin());
}

}  // namespace

std::vector<ProgramHost> loadPrograms(const config::MachineConfig& machine,
                                      std::vector<LinkedProgram> linked,
                                      std::vector<std::string>& problems) {
    std::vector<ProgramHost> programs;
    std::uint16_t number = 1;
    for (const program::ProgramParams& params : machine.programs) {
        program::ProgramPtr program = takeLinked(linked, params.name);
        if (!program && params.library.empty()) {
            problems.push_back(
                fmt::format("{}: error: program '{}' has no library and is not linked in; do: add "
                            "library=\"…\", or run the executable that brings it",
                            params.origin, params.name));
            continue;
        }
        if (!program) {
            program::LoadedProgram loaded = program::loadProgram(params.library);
            if (!loaded.program) {
                problems.push_back(fmt::format("{}: error: {}", params.origin, loaded.error));
                continue;
            }
            program = std::move(loaded.program);
        }
        programs.emplace_back(params, std::move(program), machine.axes.size(),
                              machine.groups.size(), number++);
    }
    for (LinkedProgram& rest : linked) {
        program::ProgramParams params;
        params.name = rest.name;
        params.origin = machine.file;
        programs.emplace_back(std::move(params), std::move(rest.program), machine.axes.size(),
                              machine.groups.size(), number++);
    }
    return programs;
}

void makeAxes(const config::MachineConfig& machine, Axes& axes) {
    for (const axis::AxisParams& params : machine.axes) {
        axes.emplace_back(params, machine.network.cycle);
    }
}

void makeGroups(const config::MachineConfig& machine, Axes& axes, Groups& groups) {
    std::vector<axis::Axis*> all;
    for (axis::Axis& axis : axes) all.push_back(&axis);
    for (const axis::GroupParams& params : machine.groups)
        groups.emplace_back(params, all, machine.network.cycle);
}

axis::DriveBindings bindingsOf(const fieldbus::SlaveParams& slave) {
    using namespace core::cia402;  // NOLINT(google-build-using-namespace): a list of its names
    const auto output = [&slave](std::uint16_t index) {
        return fieldbus::findEntry(slave, fieldbus::Direction::Outputs, index, 0);
    };
    const auto input = [&slave](std::uint16_t index) {
        return fieldbus::findEntry(slave, fieldbus::Direction::Inputs, index, 0);
    };
    return {.controlword = output(ControlWord),
            .modeOfOperation = output(ModesOfOperation),
            .targetPosition = output(TargetPosition),
            .statusword = input(StatusWord),
            .modeDisplay = input(ModesOfOperationDisplay),
            .actualPosition = input(PositionActual),
            .errorCode = input(ErrorCode),
            .digitalInputs = input(DigitalInputs),
            .followingError = input(FollowingErrorActual),
            .actualTorque = input(TorqueActual)};
}

void attachAxes(const config::MachineConfig& machine, fieldbus::ethercat::Master& master,
                Axes& axes) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::size_t slave = slaveIndex(machine.network, machine.axes[i].drive.slave);
        axes[i].attach(master.image(slave), bindingsOf(machine.network.slaves[slave]),
                       &master.objects(slave));
    }
}

}  // namespace takt::daemon
