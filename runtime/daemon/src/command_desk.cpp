#include "command_desk.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "event_text.hpp"

namespace takt::daemon {

CommandDesk::CommandDesk(const Parts& parts, core::Duration cycle, std::vector<TakenCommand> replay,
                         bool record)
    : parts_{parts},
      stations_(parts.axes.size()),
      replay_{std::move(replay)},
      replaying_{!replay_.empty()},
      record_{record},
      heartbeatLimit_{static_cast<core::CycleNumber>(HeartbeatTime / cycle)} {}

void CommandDesk::cycle(core::CycleNumber cycle, bool operating) noexcept {
    takeAll(cycle, operating);
    const bool lost = cycle - lastHeartbeat_ > heartbeatLimit_;
    if (lost || !operating) {
        for (std::size_t i = 0; i < stations_.size(); ++i) {
            if (stations_[i].held()) {
                parts_.rings.events.add(operatorLost(cycle, static_cast<std::uint16_t>(i)));
            }
            stations_[i].letGo();
        }
    }
    runStations(cycle);
}

void CommandDesk::takeAll(core::CycleNumber cycle, bool operating) noexcept {
    for (; replayed_ < replay_.size() && replay_[replayed_].cycle <= cycle; ++replayed_) {
        take(replay_[replayed_].command, cycle, operating);
    }
    ControlCommand command;
    for (std::size_t i = 0; i < MostPerCycle && parts_.rings.commands.pop(command); ++i) {
        if (replaying_ && command.order != Order::MachineStop) {
            if (command.ticket == 0) continue;
            static_cast<void>(parts_.rings.answers.push(
                {command.ticket, cycle, AnswerKind::Refused, Refusal::Replaying, {}, 0}));
            continue;
        }
        take(command, cycle, operating);
    }
}

void CommandDesk::take(const ControlCommand& command, core::CycleNumber cycle,
                       bool operating) noexcept {
    if (record_ && !parts_.rings.taken.push({cycle, command})) {
        parts_.rings.takenLost.fetch_add(1, std::memory_order_relaxed);
    }
    const Verdict verdict = execute(command, cycle, operating);
    const bool refused = verdict.refusal != Refusal::None;
    if (refused) {
        parts_.rings.events.add(commandRefused(cycle, command, verdict.refusal, verdict.detail));
    } else if (command.order != Order::Heartbeat && command.order != Order::Leave) {
        parts_.rings.events.add(commandTaken(cycle, command));
    }
    if (verdict.pending || command.ticket == 0) return;
    static_cast<void>(parts_.rings.answers.push({command.ticket,
                                                 cycle,
                                                 refused ? AnswerKind::Refused : AnswerKind::Done,
                                                 verdict.refusal,
                                                 {},
                                                 verdict.detail}));
}

CommandDesk::Verdict CommandDesk::execute(const ControlCommand& command, core::CycleNumber cycle,
                                          bool operating) noexcept {
    // Stopping is never refused.
    switch (command.order) {
        case Order::MachineStop:
            parts_.machineStop.request(StopCause::Command, 0, cycle);
            return {};
        case Order::Leave:
        case Order::Halt:
            letGoAll();
            return {};
        case Order::ProgramStop:
            return stopProgram(command);
        default:
            break;
    }
    lastHeartbeat_ = cycle;
    if (command.order == Order::Heartbeat) return {};
    if (!operating) return {.refusal = Refusal::NotOperating};
    if (command.order == Order::ResetStop) return resetStop();
    if (command.order == Order::ProgramStart) return startProgram(command);
    return commandAxis(command);
}

CommandDesk::Verdict CommandDesk::commandAxis(const ControlCommand& command) noexcept {
    if (command.target >= stations_.size()) return {.refusal = Refusal::UnknownTarget};
    const bool finite = std::isfinite(command.distance) && std::isfinite(command.velocity);
    if (!finite) return {.refusal = Refusal::NotFinite};
    const std::size_t holder = holderOf(command.target);
    if (holder < parts_.programs.size()) {
        return {.refusal = Refusal::HeldByProgram, .detail = static_cast<std::uint16_t>(holder)};
    }
    if (command.order == Order::PowerOff) stations_[command.target].letGo();
    if (!stations_[command.target].begin(command)) return {.refusal = Refusal::Busy};
    return {.pending = true};
}

CommandDesk::Verdict CommandDesk::startProgram(const ControlCommand& command) noexcept {
    if (command.target >= parts_.programs.size()) return {.refusal = Refusal::UnknownTarget};
    ProgramHost& program = parts_.programs[command.target];
    if (program.ended()) return {.refusal = Refusal::ProgramEnded};
    if (!program.held()) return {.refusal = Refusal::ProgramRunning};
    for (std::size_t i = 0; i < stations_.size(); ++i) {
        if (stations_[i].moves() && program.uses(i)) {
            return {.refusal = Refusal::OperatorMoves, .detail = static_cast<std::uint16_t>(i)};
        }
    }
    program.goOn();
    return {};
}

CommandDesk::Verdict CommandDesk::stopProgram(const ControlCommand& command) noexcept {
    if (command.target >= parts_.programs.size()) return {.refusal = Refusal::UnknownTarget};
    ProgramHost& program = parts_.programs[command.target];
    if (program.ended()) return {.refusal = Refusal::ProgramEnded};
    program.hold({parts_.axes, parts_.groups});
    return {};
}

CommandDesk::Verdict CommandDesk::resetStop() noexcept {
    if (!parts_.machineStop.active()) return {.refusal = Refusal::NotStopped};
    const auto input = static_cast<std::uint16_t>(parts_.machineStop.activeInput());
    if (!parts_.machineStop.reset(parts_.axes)) {
        return {.refusal = Refusal::StopActive, .detail = input};
    }
    return {};
}

std::size_t CommandDesk::holderOf(std::size_t axis) const noexcept {
    const auto holds = [axis](const ProgramHost& program) {
        return !program.ended() && !program.held() && program.uses(axis);
    };
    const auto found = std::find_if(parts_.programs.begin(), parts_.programs.end(), holds);
    return static_cast<std::size_t>(found - parts_.programs.begin());
}

void CommandDesk::letGoAll() noexcept {
    for (AxisStation& station : stations_) station.letGo();
}

void CommandDesk::runStations(core::CycleNumber cycle) noexcept {
    for (std::size_t i = 0; i < stations_.size(); ++i) {
        const auto answer = stations_[i].cycle(parts_.axes[i]);
        if (!answer) continue;
        const bool bad = answer->kind == AnswerKind::Refused || answer->kind == AnswerKind::Failed;
        if (bad) {
            parts_.rings.events.add(
                stationFailed(cycle, static_cast<std::uint16_t>(i), answer->error));
        }
        if (answer->ticket != 0) static_cast<void>(parts_.rings.answers.push(*answer));
    }
}

}  // namespace takt::daemon
