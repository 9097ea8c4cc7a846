#include <takt/axis/admit.hpp>
#include <takt/axis/axis.hpp>

namespace takt::axis {

void Axis::openPort(AxisPort& port) const noexcept {
    port.open(view_);
    if (events_.missedBy(port.book())) {
        core::FixedVector<CommandId, MaxQueue + 16> alive;
        alive.push(view_.active);
        for (const Command& queued : queue_) alive.push(queued.id);
        for (const CommandId id : resets_) alive.push(id);
        port.book().forgetAllBut({alive.begin(), alive.size()});
    }
    events_.deliver(port.book());
}

void Axis::takeCommands(AxisPort& port) noexcept {
    for (const Command& command : port.commands()) execute(command);
    port.close();
    applyPower();
}

void Axis::execute(const Command& request) noexcept {
    // The port has asked the same rules already; another program may have been faster in this
    // cycle.
    const auto admitted = admit(view_, request);
    if (!admitted.ok()) {
        report(request.id, {CommandPhase::Error, admitted.error()});
        return;
    }
    const Command& command = admitted.value();
    switch (command.kind) {
        case CommandKind::PowerOn:
        case CommandKind::ReleaseStop:
            noteAccepted(view_, command);
            return;
        case CommandKind::PowerOff:
            executePowerOff(command);
            return;
        case CommandKind::Reset:
            executeReset(command);
            return;
        case CommandKind::Stop:
            executeStop(command);
            return;
        case CommandKind::Halt:
        case CommandKind::Home:
        case CommandKind::MoveAbsolute:
        case CommandKind::MoveRelative:
        case CommandKind::MoveVelocity:
            executeMotion(command);
            return;
    }
}

void Axis::executeMotion(const Command& command) noexcept {
    if (doneAtOnce(view_, command)) {
        report(command.id, {CommandPhase::Done, ErrorId::None});
        return;
    }
    if (mustQueue(view_, command)) {
        noteAccepted(view_, command);
        queue_.push(command);  // admit() has kept it inside the configured depth
        return;
    }
    endAll({CommandPhase::Aborted, ErrorId::None});
    noteAccepted(view_, command);
    control(command);
}

void Axis::executeStop(const Command& command) noexcept {
    const bool homing = view_.state == AxisState::Homing;
    const bool again = view_.active == command.replaces && view_.state == AxisState::Stopping;
    // The same instance stopping anew: its earlier command ends without a word.
    if (again) active_.id = view_.active = CommandId::None;
    endAll({CommandPhase::Aborted, ErrorId::None});
    noteAccepted(view_, command);
    active_ = command;
    planPending_ = false;
    if (view_.stopDone) {
        report(command.id, {CommandPhase::Done, ErrorId::None});
    } else if (homing) {
        drive_.cancelHoming();
        view_.homed = false;
    } else {
        planPending_ = !homingRunning_ && !view_.grouped;
    }
}

void Axis::executePowerOff(const Command& command) noexcept {
    const bool wasLive = live() && view_.powerRequested;
    const bool homing = view_.state == AxisState::Homing;
    if (wasLive) endAll({CommandPhase::Aborted, ErrorId::None});
    noteAccepted(view_, command);
    if (!wasLive) return;
    if (homing) view_.homed = false;
    if (view_.state == AxisState::Stopping) {
        brake(CommandKind::Stop);
        return;
    }
    planPending_ = false;
    homingRunning_ = false;
    view_.grouped = false;
    motion_.hold(motion_.set().position);
}

void Axis::executeReset(const Command& command) noexcept {
    if (doneAtOnce(view_, command)) {
        report(command.id, {CommandPhase::Done, ErrorId::None});
        return;
    }
    if (resets_.empty()) resetCycles_ = 0;
    if (!resets_.push(command.id)) {
        report(command.id, {CommandPhase::Error, ErrorId::InstanceBusy});
        return;
    }
    updateReset();
}

void Axis::control(const Command& command) noexcept {
    active_ = command;
    inPositionSince_ = 0;
    planPending_ = false;
    if (command.kind != CommandKind::Home) {
        planPending_ = true;
        return;
    }
    view_.homed = false;
    homingRunning_ = true;
    drive_.home();
}

void Axis::planActive() noexcept {
    // Each round takes one command off the queue, so this ends.
    while (planPending_) {
        planPending_ = false;
        const ErrorId bad = motion_.begin(active_);
        if (bad == ErrorId::None) {
            view_.commandedPosition = motion_.target();
            return;
        }
        if (active_.id == CommandId::None) {
            // Not even the axis' own stop: the gate's ramp is what is left.
            raise(ErrorId::ProfileNotFeasible, {}, Reaction::Ramp);
            return;
        }
        report(active_.id, {CommandPhase::Error, bad});
        view_.active = CommandId::None;
        active_ = Command{};
        if (view_.state == AxisState::Stopping) {
            brake(CommandKind::Stop);
        } else if (!queue_.empty()) {
            activateNext();
        } else {
            brake(CommandKind::Halt);
        }
    }
}

void Axis::completeActive(CommandStatus outcome) noexcept {
    report(active_.id, outcome);
    view_.active = CommandId::None;
    active_ = Command{};
    enterStandstill();
    if (!queue_.empty()) activateNext();
}

void Axis::activateNext() noexcept {
    const AxisState before = view_.state;
    while (!queue_.empty()) {
        Command next = queue_.front();
        queue_.popFront();
        const auto left = static_cast<std::uint8_t>(queue_.size());
        next.bufferMode = BufferMode::Aborting;
        if (const auto admitted = admit(view_, next); admitted.ok()) {
            if (doneAtOnce(view_, admitted.value())) {
                report(next.id, {CommandPhase::Done, ErrorId::None});
                view_.queued = left;
                continue;
            }
            noteAccepted(view_, admitted.value());
            view_.queued = left;
            report(next.id, {CommandPhase::Active, ErrorId::None});
            control(admitted.value());
            return;
        } else {
            report(next.id, {CommandPhase::Error, admitted.error()});
            view_.queued = left;
        }
    }
    if (before != AxisState::Standstill) brake(CommandKind::Halt);
}

/// The axis' own stop, in the name of no block: kind Stop keeps the axis locked in Stopping until
/// rest.
void Axis::brake(CommandKind kind) noexcept {
    const LimitParams& l = traits_.limits;
    active_ = Command{};
    active_.kind = kind;
    active_.dynamics = {l.velocity, l.stopDeceleration, l.stopDeceleration, l.stopJerk};
    view_.active = CommandId::None;
    view_.inVelocity = false;
    view_.stopDone = false;
    if (kind == CommandKind::Stop) {
        view_.state = AxisState::Stopping;
        view_.stopReleased = true;
    } else {
        view_.state = AxisState::DiscreteMotion;
    }
    if (homingRunning_) {
        drive_.cancelHoming();
        planPending_ = false;
    } else {
        // A grouped axis stops on the path of its group.
        planPending_ = !motion_.resting() && !view_.grouped;
    }
}

void Axis::endAll(CommandStatus outcome) noexcept {
    // A stop that is done has been answered; what is left of it is the lock.
    const bool answered = view_.state == AxisState::Stopping && view_.stopDone;
    if (!answered) report(view_.active, outcome);
    for (const Command& queued : queue_) report(queued.id, outcome);
    queue_.clear();
    view_.queued = 0;
    view_.active = CommandId::None;
}

void Axis::enterStandstill() noexcept {
    view_.state = view_.powerRequested ? AxisState::Standstill : AxisState::Disabled;
    view_.active = CommandId::None;
    view_.inVelocity = false;
    view_.stopDone = false;
    view_.stopReleased = true;
}

void Axis::stopByProgramLoss() noexcept {
    if (!live() || view_.state == AxisState::Standstill) return;
    if (view_.state == AxisState::Homing) view_.homed = false;
    if (view_.state == AxisState::Stopping && view_.stopDone) {
        enterStandstill();
        return;
    }
    endAll({CommandPhase::Aborted, ErrorId::None});
    brake(CommandKind::Stop);
}

void Axis::requestPowerOff() noexcept {
    Command off;
    off.kind = CommandKind::PowerOff;
    execute(off);
    applyPower();
}

void Axis::quickStop() noexcept {
    endAll({CommandPhase::Aborted, ErrorId::None});
    view_.powerRequested = false;
    if (view_.state != AxisState::ErrorStop) view_.state = AxisState::Disabled;
    planPending_ = false;
    homingRunning_ = false;
    view_.grouped = false;
    motion_.hold(motion_.set().position);
    drive_.switchOff(SwitchOff::QuickStop);
}

}  // namespace takt::axis
