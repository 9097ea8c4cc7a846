#include "assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <takt/core/cia402.hpp>
#include <takt/fieldbus/pdo_layout.hpp>
#include <utility>

namespace takt::daemon {

namespace {

ProgramFactory factoryOf(LinkedProgram linked) {
    return [make = std::move(linked.make)] { return program::LoadedProgram{make(), {}}; };
}

ProgramFactory takeLinked(std::vector<LinkedProgram>& linked, const std::string& name) {
    const auto found =
        std::find_if(linked.begin(), linked.end(),
                     [&name](const LinkedProgram& entry) { return entry.name == name; });
    if (found == linked.end()) return {};
    ProgramFactory factory = factoryOf(std::move(*found));
    linked.erase(found);
    return factory;
}

std::size_t slaveIndex(const fieldbus::NetworkParams& network, const std::string& name) {
    const auto found = std::find_if(network.slaves.begin(), network.slaves.end(),
                                    [&name](const auto& slave) { return slave.name == name; });
    return static_cast<std::size_t>(found - network.slaves.begin());
}

}  // namespace

LoadedPrograms loadPrograms(const config::MachineConfig& machine, std::vector<LinkedProgram> linked,
                            std::vector<std::string>& problems) {
    LoadedPrograms programs;
    const auto load = [&](const program::ProgramParams& params, ProgramFactory factory) {
        program::LoadedProgram loaded = factory();
        if (!loaded.program) {
            problems.push_back(fmt::format("{}: error: {}", params.origin, loaded.error));
            return;
        }
        const auto number = static_cast<std::uint16_t>(programs.hosts.size() + 1);
        programs.hosts.emplace_back(params, std::move(loaded.program), machine.axes.size(),
                                    machine.groups.size(), number);
        programs.factories.push_back(std::move(factory));
    };
    for (const program::ProgramParams& params : machine.programs) {
        ProgramFactory factory = takeLinked(linked, params.name);
        if (!factory && params.library.empty()) {
            problems.push_back(
                fmt::format("{}: error: program '{}' has no library and is not linked in; do: add "
                            "library=\"…\", or run the executable that brings it",
                            params.origin, params.name));
            continue;
        }
        if (!factory)
            factory = [library = params.library] { return program::loadProgram(library); };
        load(params, std::move(factory));
    }
    for (LinkedProgram& rest : linked) {
        program::ProgramParams params;
        params.name = rest.name;
        params.origin = machine.file;
        load(params, factoryOf(std::move(rest)));
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

axis::DriveBindings bindingsOf(const fieldbus::SlaveParams& slave,
                               const axis::DriveBindings& bound) {
    using namespace core::cia402;  // NOLINT(google-build-using-namespace): a list of its names
    const auto output = [&slave](core::PdoSlot told, std::uint16_t index) {
        return told.present() ? told
                              : fieldbus::findEntry(slave, fieldbus::Direction::Outputs, index, 0);
    };
    const auto input = [&slave](core::PdoSlot told, std::uint16_t index) {
        return told.present() ? told
                              : fieldbus::findEntry(slave, fieldbus::Direction::Inputs, index, 0);
    };
    return {.controlword = output(bound.controlword, ControlWord),
            .modeOfOperation = output(bound.modeOfOperation, ModesOfOperation),
            .targetPosition = output(bound.targetPosition, TargetPosition),
            .statusword = input(bound.statusword, StatusWord),
            .modeDisplay = input(bound.modeDisplay, ModesOfOperationDisplay),
            .actualPosition = input(bound.actualPosition, PositionActual),
            .errorCode = input(bound.errorCode, ErrorCode),
            .digitalInputs = input(bound.digitalInputs, DigitalInputs),
            .followingError = input(bound.followingError, FollowingErrorActual),
            .actualTorque = input(bound.actualTorque, TorqueActual)};
}

void attachAxes(const config::MachineConfig& machine, fieldbus::ethercat::Master& master,
                Axes& axes) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::size_t slave = slaveIndex(machine.network, machine.axes[i].drive.slave);
        axes[i].attach(master.image(slave),
                       bindingsOf(machine.network.slaves[slave], machine.axes[i].drive.bound),
                       &master.objects(slave));
    }
}

}  // namespace takt::daemon
