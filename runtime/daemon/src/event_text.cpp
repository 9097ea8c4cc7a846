#include "event_text.hpp"

#include <fmt/format.h>

#include <array>

namespace takt::daemon {

namespace {

using fieldbus::ethercat::NetworkState;

constexpr double DriveErrorSpan = 65536.0;

record::Event event(core::CycleNumber cycle, EventId id, std::uint16_t source,
                    std::array<double, 4> numbers = {}) noexcept {
    return {cycle, static_cast<std::uint16_t>(id), source, numbers};
}

template <typename Enum>
double number(Enum value) noexcept {
    return static_cast<double>(static_cast<std::uint16_t>(value));
}
record::Event failure(core::CycleNumber cycle, EventId id, std::uint16_t source,
                      const axis::ErrorRecord& error) noexcept {
    const double packed = number(error.id) * DriveErrorSpan + error.driveError;
    return event(cycle, id, source, {packed, error.numbers[0], error.numbers[1], error.numbers[2]});
}
template <typename Enum>
Enum as(double value) noexcept {
    return static_cast<Enum>(static_cast<std::uint16_t>(value));
}

std::string nameIn(const std::vector<std::string>& names, std::size_t index) {
    return index < names.size() ? names[index] : fmt::format("#{}", index);
}

std::string targetName(Order order, std::uint16_t target, const ControlNames& names) {
    if (targetOf(order) == OrderTarget::None) return {};
    return " " + nameIn(namesOf(targetOf(order), names), target);
}

std::string busyText(OrderTarget target) {
    if (target == OrderTarget::Device) return "too many objects are asked for at once";
    if (target == OrderTarget::Program) return "its last call, or its last reset, is not over yet";
    return "the last command for this axis still runs";
}

axis::ErrorRecord errorOf(const record::Event& event) noexcept {
    const auto packed = static_cast<std::uint64_t>(event.numbers[0]);
    axis::ErrorRecord error;
    error.id = static_cast<axis::ErrorId>(packed / 65536U);
    error.driveError = static_cast<std::uint16_t>(packed % 65536U);
    error.cycle = event.cycle;
    error.numbers = {event.numbers[1], event.numbers[2], event.numbers[3]};
    return error;
}

std::string textOfCommand(const record::Event& event, const ControlNames& names) {
    const auto order = as<Order>(event.numbers[0]);
    const auto target = static_cast<std::uint16_t>(event.numbers[1]);
    std::string words = fmt::format("command {}{}", name(order), targetName(order, target, names));
    if (static_cast<EventId>(event.id) == EventId::CommandRefused) {
        const auto detail = static_cast<std::uint16_t>(event.numbers[3]);
        return fmt::format("{} refused: {}", words,
                           explain(as<Refusal>(event.numbers[2]), order, target, detail, names));
    }
    if (targetOf(order) == OrderTarget::Device) {
        words += fmt::format(" 0x{:04X}:{}", static_cast<unsigned>(event.numbers[2]),
                             static_cast<unsigned>(event.numbers[3]));
    }
    if (order == Order::Inch) {
        const std::string unit = nameIn(names.units, target);
        words += fmt::format(" by {:+g} {} at {:g} {}/s", event.numbers[2], unit, event.numbers[3],
                             unit);
    }
    return words;
}

}  // namespace

record::Event networkChanged(core::CycleNumber cycle, NetworkState to) noexcept {
    return event(cycle, EventId::NetworkChanged, 0, {number(to)});
}
record::Event axisChanged(core::CycleNumber cycle, std::uint16_t axis, axis::AxisState from,
                          axis::AxisState to) noexcept {
    return event(cycle, EventId::AxisChanged, axis, {number(from), number(to)});
}
record::Event axisFailed(core::CycleNumber cycle, std::uint16_t axis,
                         const axis::ErrorRecord& error) noexcept {
    return failure(cycle, EventId::AxisFailed, axis, error);
}
record::Event groupChanged(core::CycleNumber cycle, std::uint16_t group, axis::GroupState from,
                           axis::GroupState to) noexcept {
    return event(cycle, EventId::GroupChanged, group, {number(from), number(to)});
}
record::Event groupFailed(core::CycleNumber cycle, std::uint16_t group,
                          const axis::ErrorRecord& error) noexcept {
    return failure(cycle, EventId::GroupFailed, group, error);
}
record::Event programChanged(core::CycleNumber cycle, std::uint16_t program, ProgramPhase phase,
                             bool held) noexcept {
    return event(cycle, EventId::ProgramChanged, program, {number(phase), held ? 1.0 : 0.0});
}
record::Event machineStopped(core::CycleNumber cycle, const StopRecord& stop) noexcept {
    return event(cycle, EventId::MachineStopped, stop.source, {number(stop.cause)});
}
record::Event machineStopReset(core::CycleNumber cycle) noexcept {
    return event(cycle, EventId::MachineStopReset, 0);
}
record::Event commandTaken(core::CycleNumber cycle, const ControlCommand& command) noexcept {
    std::array<double, 4> numbers{number(command.order), static_cast<double>(command.target),
                                  command.distance, command.velocity};
    if (targetOf(command.order) == OrderTarget::Device) {
        numbers[2] = static_cast<double>(command.object.index);
        numbers[3] = static_cast<double>(command.object.subindex);
    }
    return event(cycle, EventId::CommandTaken, 0, numbers);
}
record::Event commandRefused(core::CycleNumber cycle, const ControlCommand& command,
                             Refusal refusal, std::uint16_t detail) noexcept {
    return event(cycle, EventId::CommandRefused, 0,
                 {number(command.order), static_cast<double>(command.target), number(refusal),
                  static_cast<double>(detail)});
}
record::Event stationFailed(core::CycleNumber cycle, std::uint16_t axis,
                            axis::ErrorId error) noexcept {
    return event(cycle, EventId::StationFailed, axis, {number(error)});
}
record::Event operatorLost(core::CycleNumber cycle, std::uint16_t axis) noexcept {
    return event(cycle, EventId::OperatorLost, axis);
}

const std::vector<std::string>& namesOf(OrderTarget target, const ControlNames& names) noexcept {
    if (target == OrderTarget::Axis) return names.axes;
    return target == OrderTarget::Program ? names.programs : names.devices;
}

const char* name(ProgramPhase phase, bool held) noexcept {
    switch (phase) {
        case ProgramPhase::Waiting:
            return held ? "stopped" : "waiting";
        case ProgramPhase::Running:
            return held ? "stopped" : "running";
        case ProgramPhase::Finished:
            return "finished";
        case ProgramPhase::Failed:
            return "failed";
        case ProgramPhase::Threw:
            return "threw";
        case ProgramPhase::Abandoned:
            return "abandoned";
    }
    return "?";
}

std::string explain(Refusal refusal, Order order, std::uint16_t target, std::uint16_t detail,
                    const ControlNames& names) {
    switch (refusal) {
        case Refusal::None:
            return "not refused";
        case Refusal::NotOperating:
            return "the network is not in OP, or the run is ending";
        case Refusal::UnknownTarget:
            return fmt::format("there is no{}", targetName(order, target, names));
        case Refusal::NotFinite:
            return "a number is not finite";
        case Refusal::HeldByProgram:
            return fmt::format(
                "axis{} is held by program '{}'; do: stop the program, or run with --manual",
                targetName(order, target, names), nameIn(names.programs, detail));
        case Refusal::Busy:
            return busyText(targetOf(order));
        case Refusal::Block:
            return "the block refused it";
        case Refusal::StopActive:
            return fmt::format("input '{}' still asks for the stop",
                               nameIn(names.stopInputs, detail));
        case Refusal::NotStopped:
            return "the machine is not stopped";
        case Refusal::ProgramEnded:
            return "the program has ended";
        case Refusal::ProgramRunning:
            return "the program runs already";
        case Refusal::OperatorMoves:
            return fmt::format("axis {} moves for the operator", nameIn(names.axes, detail));
        case Refusal::ProgramsRun:
            return fmt::format(
                "program '{}' runs, and a written object may disturb it; do: stop it first, or "
                "write with --force",
                nameIn(names.programs, detail));
        case Refusal::AxisMoves:
            return fmt::format("axis {} moves; do: stop it first", nameIn(names.axes, detail));
        case Refusal::ProgramLost:
            return "the program was abandoned, and its thread is lost; do: end the run";
        case Refusal::OfTheCycle:
            return "the cycle writes this object with the process data";
        case Refusal::Replaying:
            return "a command file is being replayed";
    }
    return "?";
}

std::string text(const record::Event& event, const ControlNames& names) {
    const auto axis = [&] { return nameIn(names.axes, event.source); };
    switch (static_cast<EventId>(event.id)) {
        case EventId::NetworkChanged:
            return fmt::format("network {}",
                               fieldbus::ethercat::name(as<NetworkState>(event.numbers[0])));
        case EventId::AxisChanged:
            return fmt::format("axis {} {} -> {}", axis(),
                               axis::name(as<axis::AxisState>(event.numbers[0])),
                               axis::name(as<axis::AxisState>(event.numbers[1])));
        case EventId::AxisFailed:
            return fmt::format("axis {}: {}", axis(), axis::explain(errorOf(event)));
        case EventId::GroupChanged:
            return fmt::format("group {} {} -> {}", nameIn(names.groups, event.source),
                               axis::name(as<axis::GroupState>(event.numbers[0])),
                               axis::name(as<axis::GroupState>(event.numbers[1])));
        case EventId::GroupFailed:
            return fmt::format("group {}: {}", nameIn(names.groups, event.source),
                               axis::explain(errorOf(event)));
        case EventId::ProgramChanged:
            return fmt::format("program '{}' {}", nameIn(names.programs, event.source),
                               name(as<ProgramPhase>(event.numbers[0]), event.numbers[1] != 0.0));
        case EventId::MachineStopped:
            return fmt::format(
                "machine stop by {}",
                describe({as<StopCause>(event.numbers[0]), event.source, event.cycle},
                         names.stopInputs, names.programs, names.axes));
        case EventId::MachineStopReset:
            return "machine stop reset";
        case EventId::CommandTaken:
        case EventId::CommandRefused:
            return textOfCommand(event, names);
        case EventId::StationFailed: {
            const axis::ErrorInfo& error = axis::errorInfo(as<axis::ErrorId>(event.numbers[0]));
            return fmt::format("axis {}: operator's command failed: {}: {}", axis(), error.name,
                               error.text);
        }
        case EventId::OperatorLost:
            return fmt::format("axis {} stops: no sign of life from the operator", axis());
    }
    return fmt::format("event {}", event.id);
}

}  // namespace takt::daemon
