#include <takt/axis/group_admit.hpp>
#include <takt/axis/group_port.hpp>

namespace takt::axis {

namespace {

/// This command ends whatever has control or waits.
bool clearsOthers(const GroupView& view, const GroupCommand& command) noexcept {
    switch (command.kind) {
        case GroupCommandKind::Stop:
        case GroupCommandKind::Disable:
        case GroupCommandKind::UngroupAll:
            return true;
        default:
            return isMotion(command.kind) && !mustQueue(view, command);
    }
}

}  // namespace

core::Result<CommandId, ErrorId> GroupPort::submit(const GroupCommand& request) noexcept {
    if (view_.traits == nullptr) return ErrorId::NullReference;  // never opened by a group
    if (request.bufferMode != BufferMode::Aborting && book_.pending(request.replaces)) {
        return ErrorId::InstanceBusy;
    }
    const auto admitted = admit(view_, request);
    if (!admitted.ok()) return admitted.error();
    if (commands_.full()) return ErrorId::BufferFull;

    GroupCommand command = admitted.value();
    // A path is planned first: until then its command is accepted, and not in control.
    CommandPhase phase = CommandPhase::Active;
    if (isPath(command.kind) || mustQueue(view_, command)) phase = CommandPhase::Queued;
    if (doneAtOnce(view_, command)) phase = CommandPhase::Done;
    if (clearsOthers(view_, command)) book_.abortPending();
    if (command.kind != GroupCommandKind::ReleaseStop) {
        const bool takesMotion = isMotion(command.kind) || command.kind == GroupCommandKind::Stop;
        command.id = book_.add(phase, takesMotion);
    }
    noteAccepted(view_, command);
    commands_.push(command);
    return command.id;
}

core::Result<GroupPort::Ids, ErrorId> GroupPort::submit(
    std::span<const GroupCommand> requests) noexcept {
    const GroupView view = view_;
    const CommandBook book = book_;
    const std::size_t waiting = commands_.size();
    Ids ids{CommandId::None, CommandId::None};
    for (const GroupCommand& request : requests) {
        const auto accepted = submit(request);
        if (!accepted.ok()) {
            view_ = view;
            book_ = book;
            commands_.truncate(waiting);
            return accepted.error();
        }
        if (ids.first == CommandId::None) ids.first = accepted.value();
        ids.last = accepted.value();
    }
    return ids;
}

}  // namespace takt::axis
