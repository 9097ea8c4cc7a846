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

void CommandDesk::cycle(core::CycleNumber cycle, bool operating, bool allTold) noexcept {
    takeAll(cycle, operating);
    if (parked_ && allTold) {
        answer(*parked_, resetProgram(*parked_, operating), cycle);
        parked_.reset();
    }
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
    runBus(cycle);
}

void CommandDesk::takeAll(core::CycleNumber cycle, bool operating) noexcept {
    for (; replayed_ < replay_.size() && replay_[replayed_].cycle <= cycle; ++replayed_) {
        take(replay_[replayed_].command, cycle, operating);
    }
    ControlCommand command;
    for (std::size_t i = 0; i < MostPerCycle && parts_.rings.commands.pop(command); ++i) {
        if (replaying_ && command.order != Order::MachineStop) {
            if (command.ticket == 0) continue;
            static_cast<void>(parts_.rings.answers.push({.ticket = command.ticket,
                                                         .cycle = cycle,
                                                         .kind = AnswerKind::Refused,
                                                         .refusal = Refusal::Replaying}));
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
    if (verdict.refusal == Refusal::None && command.order != Order::Heartbeat &&
        command.order != Order::Leave) {
        parts_.rings.events.add(commandTaken(cycle, command));
    }
    if (!verdict.pending) answer(command, verdict, cycle);
}

void CommandDesk::answer(const ControlCommand& command, const Verdict& verdict,
                         core::CycleNumber cycle) noexcept {
    const bool refused = verdict.refusal != Refusal::None;
    if (refused)
        parts_.rings.events.add(commandRefused(cycle, command, verdict.refusal, verdict.detail));
    if (command.ticket == 0) return;
    static_cast<void>(
        parts_.rings.answers.push({.ticket = command.ticket,
                                   .cycle = cycle,
                                   .kind = refused ? AnswerKind::Refused : AnswerKind::Done,
                                   .refusal = verdict.refusal,
                                   .detail = verdict.detail}));
}

Verdict CommandDesk::execute(const ControlCommand& command, core::CycleNumber cycle,
                             bool operating) noexcept {
    // Stopping is never refused.
    // Who only reads gives no sign of life for what moves.
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
        case Order::Upload:
            return parts_.bus.begin(command, operating);
        default:
            break;
    }
    lastHeartbeat_ = cycle;
    if (command.order == Order::Heartbeat) return {};
    if (command.order == Order::Download) return parts_.bus.begin(command, operating);
    if (!operating) return {.refusal = Refusal::NotOperating};
    if (command.order == Order::ResetStop) return resetStop();
    if (command.order == Order::ProgramStart) return startProgram(command);
    if (command.order == Order::ProgramReset) {
        if (command.target >= parts_.programs.size()) return {.refusal = Refusal::UnknownTarget};
        if (parked_) return {.refusal = Refusal::Busy};
        parked_ = command;
        return {.pending = true};
    }
    return commandAxis(command);
}

Verdict CommandDesk::commandAxis(const ControlCommand& command) noexcept {
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

Verdict CommandDesk::startProgram(const ControlCommand& command) noexcept {
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

Verdict CommandDesk::stopProgram(const ControlCommand& command) noexcept {
    if (command.target >= parts_.programs.size()) return {.refusal = Refusal::UnknownTarget};
    ProgramHost& program = parts_.programs[command.target];
    if (program.ended()) return {.refusal = Refusal::ProgramEnded};
    program.hold({parts_.axes, parts_.groups});
    return {};
}

/// A fresh instance takes the place of the program, which is then stopped before its first call.
Verdict CommandDesk::resetProgram(const ControlCommand& command, bool operating) noexcept {
    ProgramHost& program = parts_.programs[command.target];
    ProgramHost* const fresh = parts_.stock.take(command.target);
    if (fresh == nullptr) return {.refusal = Refusal::Busy};
    std::uint16_t detail = 0;
    const Refusal refusal = whyNoReset(program, operating, detail);
    if (refusal == Refusal::None) program.exchange(*fresh, {parts_.axes, parts_.groups});
    parts_.stock.retire(fresh);
    return {.refusal = refusal, .detail = detail};
}

Refusal CommandDesk::whyNoReset(const ProgramHost& program, bool operating,
                                std::uint16_t& detail) const noexcept {
    if (!operating) return Refusal::NotOperating;
    if (program.phase() == ProgramPhase::Abandoned) return Refusal::ProgramLost;
    if (!program.atRest()) return Refusal::Busy;
    for (std::size_t i = 0; i < parts_.axes.size(); ++i) {
        if (!program.uses(i) || !isMoving(parts_.axes[i])) continue;
        detail = static_cast<std::uint16_t>(i);
        return Refusal::AxisMoves;
    }
    return Refusal::None;
}

Verdict CommandDesk::resetStop() noexcept {
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

void CommandDesk::runBus(core::CycleNumber cycle) noexcept {
    const auto answer = parts_.bus.cycle(cycle);
    if (answer && answer->ticket != 0) static_cast<void>(parts_.rings.answers.push(*answer));
}

}  // namespace takt::daemon
