#include "machine_control.hpp"

#include <algorithm>
#include <takt/fieldbus/pdo_layout.hpp>
#include <utility>

#include "bridge_samples.hpp"

namespace takt::daemon {

namespace {

std::vector<MachineStop::Input> bindInputs(const config::MachineConfig& machine,
                                           fieldbus::ethercat::Master& master) {
    std::vector<MachineStop::Input> inputs;
    const auto& slaves = machine.network.slaves;
    for (const axis::MachineStopInput& input : machine.machineStop.inputs) {
        const auto slave = std::find_if(slaves.begin(), slaves.end(),
                                        [&input](const auto& s) { return s.name == input.slave; });
        const core::PdoSlot slot =
            fieldbus::findEntry(*slave, fieldbus::Direction::Inputs, input.index, input.subindex);
        inputs.push_back({master.image(static_cast<std::size_t>(slave - slaves.begin())), slot,
                          input.bit, input.activeHigh, machine.network.lostLimit});
    }
    return inputs;
}

}  // namespace

const char* name(RunPhase phase) noexcept {
    switch (phase) {
        case RunPhase::BringUp:
            return "bring-up";
        case RunPhase::GoingOp:
            return "going to OP";
        case RunPhase::Operating:
            return "operating";
        case RunPhase::PoweringOff:
            return "stopping";
        case RunPhase::LeavingOp:
            return "leaving OP";
        case RunPhase::Over:
            return "over";
    }
    return "?";
}

ControlNames controlNames(const config::MachineConfig& machine,
                          std::span<const ProgramHost> programs) {
    ControlNames names;
    for (const axis::AxisParams& axis : machine.axes) {
        names.axes.push_back(axis.name);
        names.units.push_back(axis.unit);
    }
    for (const axis::GroupParams& group : machine.groups) {
        names.groups.push_back(group.name);
        names.groupUnits.push_back(group.unit);
    }
    for (const ProgramHost& program : programs) names.programs.push_back(program.name());
    for (const auto& input : machine.machineStop.inputs) names.stopInputs.push_back(input.name);
    for (const auto& slave : machine.network.slaves) names.devices.push_back(slave.name);
    return names;
}

MachineControl::MachineControl(const Parts& parts, std::vector<TakenCommand> replay, bool record)
    : parts_{parts},
      names_{controlNames(parts.machine, parts.programs)},
      board_{parts.axes.size(), parts.groups.size(), parts.programs.size()},
      diagnosis_{parts.machine.network.slaves.size()},
      stop_{parts.machine.machineStop, parts.machine.network.cycle,
            bindInputs(parts.machine, parts.master), parts.axes.size()},
      bus_{{parts.machine.network, parts.machine.axes, parts.master, parts.axes, parts.programs}},
      desk_{{parts.axes, parts.groups, parts.programs, stop_, bus_, parts.stock, rings_},
            parts.machine.network.cycle,
            std::move(replay),
            record} {
    seen_.axes.resize(parts.axes.size());
    seen_.groups.resize(parts.groups.size());
    seen_.programs.resize(parts.programs.size());
}

void MachineControl::beforePrograms(core::CycleNumber cycle, const CycleOrders& orders) noexcept {
    if (orders.operating) stop_.watchInputs(cycle);
    for (ProgramHost& program : parts_.programs) {
        if (program.atRest()) program.machine().setStopped(stop_.active());
    }
}

void MachineControl::afterPrograms(core::CycleNumber cycle, const CycleOrders& orders) noexcept {
    takeWishes(cycle);
    if (stop_.onFault()) watchFaults(cycle);
    desk_.cycle(cycle, orders.operating, orders.allTold);
    stop_.act(cycle, parts_.axes);
    if (!orders.stopAxes) return;
    for (axis::Axis& axis : parts_.axes) axis.machineStop();
}

void MachineControl::takeWishes(core::CycleNumber cycle) noexcept {
    for (std::size_t i = 0; i < parts_.programs.size(); ++i) {
        // A call under way, or one given up, may be writing its wishes now: they count when it
        // comes back.
        if (!parts_.programs[i].atRest()) continue;
        const auto wishes = parts_.programs[i].machine().takeStopWishes();
        if (wishes.reset && stop_.active()) stop_.reset(parts_.axes);
        if (wishes.stop) stop_.request(StopCause::Program, static_cast<std::uint16_t>(i), cycle);
    }
}

/// Edges only: a fault that is still there must not undo a reset.
void MachineControl::watchFaults(core::CycleNumber cycle) noexcept {
    for (std::size_t i = 0; i < parts_.axes.size(); ++i) {
        const bool now = parts_.axes[i].state() == axis::AxisState::ErrorStop;
        if (now && seen_.axes[i] != axis::AxisState::ErrorStop) {
            stop_.request(StopCause::AxisFault, static_cast<std::uint16_t>(i), cycle);
        }
    }
    for (std::size_t i = 0; i < parts_.programs.size(); ++i) {
        const bool now = parts_.programs[i].phase() > ProgramPhase::Finished;
        if (now && seen_.programs[i].phase <= ProgramPhase::Finished) {
            stop_.request(StopCause::ProgramFault, static_cast<std::uint16_t>(i), cycle);
        }
    }
}

void MachineControl::publish(core::CycleNumber cycle, const CycleOrders& orders) noexcept {
    publishStatus(cycle, orders);
    noteChanges(cycle);
}

void MachineControl::publishStatus(core::CycleNumber cycle, const CycleOrders& orders) noexcept {
    const RunEntry run{cycle, orders.phase, parts_.master.state(), stop_.record(),
                       parts_.master.counters()};
    board_.run.write(run);
    publishToBridge(run);
    for (std::size_t i = 0; i < parts_.axes.size(); ++i) {
        const axis::Axis& axis = parts_.axes[i];
        board_.axes[i].write({axis.status(), axis.error(),
                              static_cast<std::uint16_t>(desk_.holderOf(i)),
                              axis.view().needsEnableEdge});
    }
    for (std::size_t i = 0; i < parts_.groups.size(); ++i) {
        const axis::Group& group = parts_.groups[i];
        board_.groups[i].write({group.status(), group.view().error});
    }
    for (std::size_t i = 0; i < parts_.programs.size(); ++i) {
        const ProgramHost& program = parts_.programs[i];
        ProgramEntry entry{
            program.phase(), program.held(), program.instance(), program.endCycle(), {}};
        const auto& watched = program.watched();
        const std::size_t count =
            program.atRest() ? std::min(watched.size(), entry.watches.size()) : 0;
        for (std::size_t w = 0; w < count; ++w) entry.watches[w] = watched[w].number();
        board_.programs[i].write(entry);
    }
}

void MachineControl::publishToBridge(const RunEntry& run) noexcept {
    if (parts_.bridge == nullptr || !parts_.bridge->due(run.cycle)) return;
    for (std::size_t i = 0; i < parts_.axes.size(); ++i) {
        parts_.bridge->axis(i, sampleOf(run.cycle, parts_.axes[i].status()));
    }
    for (std::size_t i = 0; i < parts_.groups.size(); ++i) {
        parts_.bridge->group(i, sampleOf(run.cycle, parts_.groups[i].status()));
    }
    parts_.bridge->machine(sampleOf(run));
}

void MachineControl::noteChanges(core::CycleNumber cycle) noexcept {
    record::EventLog& events = rings_.events;
    const auto network = parts_.master.state();
    if (network != seen_.network) events.add(networkChanged(cycle, network));
    seen_.network = network;
    for (std::size_t i = 0; i < parts_.programs.size(); ++i) {
        const ProgramHost& program = parts_.programs[i];
        Seen::ProgramSeen& seen = seen_.programs[i];
        if (program.phase() != seen.phase || program.held() != seen.held) {
            events.add(programChanged(cycle, static_cast<std::uint16_t>(i), program.phase(),
                                      program.held()));
        }
        seen = {program.phase(), program.held()};
    }
    const StopRecord& stop = stop_.record();
    if (stop.cause != StopCause::None && stop.cycle != seen_.stop.cycle)
        events.add(machineStopped(cycle, stop));
    if (stop.cause == StopCause::None && seen_.stop.cause != StopCause::None)
        events.add(machineStopReset(cycle));
    seen_.stop = stop;
    noteMovers(cycle);
}

void MachineControl::noteMovers(core::CycleNumber cycle) noexcept {
    record::EventLog& events = rings_.events;
    for (std::size_t i = 0; i < parts_.groups.size(); ++i) {
        const axis::Group& group = parts_.groups[i];
        const auto number = static_cast<std::uint16_t>(i);
        if (group.state() == seen_.groups[i]) continue;
        events.add(groupChanged(cycle, number, seen_.groups[i], group.state()));
        if (group.state() == axis::GroupState::ErrorStop)
            events.add(groupFailed(cycle, number, group.view().error));
        seen_.groups[i] = group.state();
    }
    for (std::size_t i = 0; i < parts_.axes.size(); ++i) {
        const axis::Axis& axis = parts_.axes[i];
        const auto number = static_cast<std::uint16_t>(i);
        if (axis.state() == seen_.axes[i]) continue;
        events.add(axisChanged(cycle, number, seen_.axes[i], axis.state()));
        if (axis.state() == axis::AxisState::ErrorStop)
            events.add(axisFailed(cycle, number, axis.error()));
        seen_.axes[i] = axis.state();
    }
}

}  // namespace takt::daemon
