#include <algorithm>
#include <takt/axis/admit.hpp>
#include <takt/axis/axis_port.hpp>

namespace takt::axis {

namespace {

constexpr unsigned kPortShift = 48;

bool pending(CommandPhase phase) noexcept {
    return phase == CommandPhase::Queued || phase == CommandPhase::Active;
}

/// This command ends whatever has control or waits.
bool clearsOthers(const AxisView& view, const Command& command) noexcept {
    if (command.kind == CommandKind::Stop || command.kind == CommandKind::PowerOff) return true;
    return isMotion(command.kind) && !mustQueue(view, command);
}

}  // namespace

AxisPort::AxisPort(std::uint16_t number) noexcept
    : lastId_{static_cast<std::uint64_t>(number) << kPortShift} {}

core::Result<CommandId, ErrorId> AxisPort::submit(const Command& request) noexcept {
    if (view_.traits == nullptr) return ErrorId::NullReference;  // never opened by an axis
    if (request.bufferMode != BufferMode::Aborting && pending(status(request.replaces).phase)) {
        return ErrorId::InstanceBusy;
    }
    const auto admitted = admit(view_, request);
    if (!admitted.ok()) return admitted.error();
    if (commands_.full()) return ErrorId::BufferFull;

    Command command = admitted.value();
    CommandPhase phase = mustQueue(view_, command) ? CommandPhase::Queued : CommandPhase::Active;
    if (doneAtOnce(view_, command)) phase = CommandPhase::Done;
    if (clearsOthers(view_, command)) abortPending();
    const bool takesMotion = isMotion(command.kind) || command.kind == CommandKind::Stop;
    if (takesMotion || command.kind == CommandKind::Reset) {
        command.id = nextId();
        entryOf(command.id) = {command.id, {phase, ErrorId::None}, takesMotion};
    }
    noteAccepted(view_, command);
    commands_.push(command);
    return command.id;
}

CommandId AxisPort::nextId() noexcept {
    // A command that is still pending keeps its place, so that its end is never missed.
    for (std::size_t tried = 0; tried < Remembered; ++tried) {
        const auto id = static_cast<CommandId>(++lastId_);
        if (!pending(entryOf(id).status.phase)) return id;
    }
    return static_cast<CommandId>(++lastId_);
}

CommandStatus AxisPort::status(CommandId id) const noexcept {
    const Entry& entry = entryOf(id);
    if (id == CommandId::None || entry.id != id) return {};
    return entry.status;
}

void AxisPort::note(const CommandEvent& event) noexcept {
    Entry& entry = entryOf(event.id);
    if (entry.id == event.id) entry.status = event.status;
}

void AxisPort::abortPending() noexcept {
    for (Entry& entry : entries_) {
        if (entry.takesMotion && pending(entry.status.phase)) {
            entry.status = {CommandPhase::Aborted, ErrorId::None};
        }
    }
}

void AxisPort::forgetAllBut(std::span<const CommandId> alive) noexcept {
    for (Entry& entry : entries_) {
        if (!pending(entry.status.phase)) continue;
        if (std::find(alive.begin(), alive.end(), entry.id) == alive.end()) entry.id = {};
    }
}

}  // namespace takt::axis
