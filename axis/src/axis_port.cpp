#include <takt/axis/admit.hpp>
#include <takt/axis/axis_port.hpp>

namespace takt::axis {

namespace {

/// This command ends whatever has control or waits.
bool clearsOthers(const AxisView& view, const Command& command) noexcept {
    if (command.kind == CommandKind::Stop || command.kind == CommandKind::PowerOff) return true;
    return isMotion(command.kind) && !mustQueue(view, command);
}

}  // namespace

core::Result<CommandId, ErrorId> AxisPort::submit(const Command& request) noexcept {
    if (view_.traits == nullptr) return ErrorId::NullReference;  // never opened by an axis
    if (request.bufferMode != BufferMode::Aborting && book_.pending(request.replaces)) {
        return ErrorId::InstanceBusy;
    }
    const auto admitted = admit(view_, request);
    if (!admitted.ok()) return admitted.error();
    if (commands_.full()) return ErrorId::BufferFull;

    Command command = admitted.value();
    CommandPhase phase = mustQueue(view_, command) ? CommandPhase::Queued : CommandPhase::Active;
    if (doneAtOnce(view_, command)) phase = CommandPhase::Done;
    if (clearsOthers(view_, command)) book_.abortPending();
    const bool takesMotion = isMotion(command.kind) || command.kind == CommandKind::Stop;
    if (takesMotion || command.kind == CommandKind::Reset) {
        command.id = book_.add(phase, takesMotion);
    }
    noteAccepted(view_, command);
    commands_.push(command);
    return command.id;
}

}  // namespace takt::axis
