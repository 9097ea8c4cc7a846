#include <algorithm>
#include <takt/axis/group.hpp>
#include <takt/axis/group_admit.hpp>
#include <utility>

namespace takt::axis {

namespace {

constexpr CommandStatus kDone{CommandPhase::Done, ErrorId::None};
constexpr CommandStatus kAborted{CommandPhase::Aborted, ErrorId::None};

}  // namespace

void Group::openPort(GroupPort& port) const noexcept {
    port.open(view_);
    if (events_.missedBy(port.book())) {
        core::FixedVector<CommandId, GroupQueue::Capacity + 16> alive;
        alive.push(view_.active);
        alive.push(disable_);
        for (std::size_t i = 0; i < queue_.size(); ++i) alive.push(queue_[i].command.id);
        for (const CommandId id : resets_) alive.push(id);
        port.book().forgetAllBut({alive.begin(), alive.size()});
    }
    events_.deliver(port.book());
}

void Group::takeCommands(GroupPort& port) noexcept {
    if (!port.commands().empty()) updateMembers();
    for (const GroupCommand& command : port.commands()) execute(command);
    port.close();
}

void Group::execute(const GroupCommand& request) noexcept {
    // The port has asked the same rules already; another program may have been faster in this
    // cycle.
    const auto admitted = admit(view_, request);
    if (!admitted.ok()) {
        report(request.id, {CommandPhase::Error, admitted.error()});
        return;
    }
    const GroupCommand& command = admitted.value();
    switch (command.kind) {
        case GroupCommandKind::AddAxis:
        case GroupCommandKind::RemoveAxis:
        case GroupCommandKind::UngroupAll:
            return executeMember(command);
        case GroupCommandKind::Enable:
            return executeEnable(command);
        case GroupCommandKind::Disable:
            return executeDisable(command);
        case GroupCommandKind::Reset:
            return executeReset(command);
        case GroupCommandKind::ReleaseStop:
            noteAccepted(view_, command);
            return;
        case GroupCommandKind::Stop:
            return executeStop(command);
        case GroupCommandKind::Halt:
        case GroupCommandKind::MoveDirect:
        case GroupCommandKind::MoveLinear:
        case GroupCommandKind::MoveCircular:
            return executeMotion(command);
    }
}

void Group::executeMember(const GroupCommand& command) noexcept {
    if (command.kind == GroupCommandKind::AddAxis) {
        const auto found =
            std::find_if(machineAxes_.begin(), machineAxes_.end(),
                         [&command](const Axis* axis) { return &axis->traits() == command.axis; });
        if (found == machineAxes_.end()) {
            report(command.id, {CommandPhase::Error, ErrorId::NullReference});
            return;
        }
        members_[command.place - 1U] = *found;
    } else if (command.kind == GroupCommandKind::RemoveAxis) {
        members_[command.place - 1U] = nullptr;
    } else {
        if (view_.state != GroupState::Disabled) enter(GroupState::Disabled);
        members_.fill(nullptr);
    }
    noteAccepted(view_, command);
    size_ = view_.size();
    report(command.id, kDone);
    updateMembers();
}

void Group::executeEnable(const GroupCommand& command) noexcept {
    if (view_.state == GroupState::Disabled) {
        for (Axis* member : members()) static_cast<void>(member->claim());
        noteAccepted(view_, command);
        updateMembers();
    }
    report(command.id, kDone);
}

void Group::executeDisable(const GroupCommand& command) noexcept {
    report(std::exchange(disable_, command.id), kAborted);
    if (doneAtOnce(view_, command)) {
        endAll(kAborted);
        enter(GroupState::Disabled);
        return;
    }
    disabling_ = true;
    if (view_.state == GroupState::ErrorStop) return;
    if (view_.state == GroupState::Stopping) {
        report(std::exchange(view_.active, CommandId::None), kAborted);
        view_.stopReleased = true;
        return;
    }
    stopOnPath(kAborted);
}

void Group::executeReset(const GroupCommand& command) noexcept {
    if (doneAtOnce(view_, command)) {
        report(command.id, kDone);
        return;
    }
    if (!resets_.push(command.id)) {
        report(command.id, {CommandPhase::Error, ErrorId::InstanceBusy});
        return;
    }
    for (Axis* member : members()) {
        if (member->state() == AxisState::ErrorStop) member->resetWithGroup();
    }
}

void Group::executeStop(const GroupCommand& command) noexcept {
    // The same instance stopping anew: its earlier command ends without a word.
    if (view_.state == GroupState::Stopping) view_.active = CommandId::None;
    endAll(kAborted);
    noteAccepted(view_, command);
    if (view_.stopDone) {
        report(command.id, kDone);
    } else {
        motion_.brake(command.dynamics, true);
    }
}

void Group::executeMotion(const GroupCommand& command) noexcept {
    if (doneAtOnce(view_, command)) {
        report(command.id, kDone);
        return;
    }
    if (!mustQueue(view_, command)) {
        endAll(kAborted);
        // What moves is brought to rest on its path, and the new motion begins there.
        if (command.kind == GroupCommandKind::Halt) {
            motion_.brake(command.dynamics, false);
        } else {
            motion_.brake({{}, {}, traits_.limits.deceleration, traits_.limits.jerk}, false);
        }
        if (!joined_) joinMembers();
    }
    noteAccepted(view_, command);
    queue_.push(command, ++serial_);  // admit() has kept it inside the configured depth
    const bool inControl = !isPath(command.kind) && queue_.size() == 1;
    if (inControl && command.kind == GroupCommandKind::Halt) activateFront();
}

void Group::activateFront() noexcept {
    frontActive_ = true;
    ++commands_;
    view_.active = queue_.front().command.id;
    view_.queued = static_cast<std::uint8_t>(queue_.size() - 1);
    report(view_.active, {CommandPhase::Active, ErrorId::None});
}

void Group::endFront(CommandStatus outcome) noexcept {
    report(queue_.front().command.id, outcome);
    queue_.pop();
    frontActive_ = false;
    view_.active = CommandId::None;
    view_.queued = static_cast<std::uint8_t>(queue_.size());
}

void Group::endAll(CommandStatus outcome) noexcept {
    // A stop that is done has been answered; what is left of it is the lock.
    const bool stops = view_.state == GroupState::Stopping && !view_.stopDone;
    if (stops) report(view_.active, outcome);
    while (!queue_.empty()) endFront(outcome);
    view_.active = CommandId::None;
    view_.queued = 0;
    asked_ = false;
}

/// The group's own stop, in the name of no block.
void Group::stopOnPath(CommandStatus outcome) noexcept {
    endAll(outcome);
    view_.state = GroupState::Stopping;
    view_.stopDone = false;
    view_.stopReleased = true;
    motion_.brake({{}, {}, core::Acceleration{planner::unlimited}, core::Jerk{planner::unlimited}},
                  true);
}

void Group::stopByProgramLoss() noexcept {
    if (view_.state == GroupState::Moving) stopOnPath(kAborted);
    if (view_.state == GroupState::Stopping) view_.stopReleased = true;
}

void Group::fail(ErrorId id, std::array<double, 3> numbers) noexcept {
    stopOnPath({CommandPhase::Error, id});
    view_.state = GroupState::ErrorStop;
    view_.error = {id, 0, view_.cycle, numbers};
    if (!joined_) return;
    for (Axis* member : members()) member->failWithGroup();
}

}  // namespace takt::axis
