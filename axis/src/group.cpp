#include <takt/axis/group.hpp>
#include <takt/axis/group_admit.hpp>
#include <utility>

namespace takt::axis {

const char* name(GroupState state) noexcept {
    switch (state) {
        case GroupState::Disabled:
            return "GroupDisabled";
        case GroupState::Standby:
            return "GroupStandby";
        case GroupState::Homing:
            return "GroupHoming";
        case GroupState::Moving:
            return "GroupMoving";
        case GroupState::Stopping:
            return "GroupStopping";
        case GroupState::ErrorStop:
            return "GroupErrorStop";
    }
    return "?";
}

Group::Group(const GroupParams& params, std::vector<Axis*> machineAxes, core::Duration cycle)
    : name_{params.name},
      traits_{params.limits, params.queueDepth},
      machineAxes_{std::move(machineAxes)},
      latency_{params.latencyCycles},
      lead_{params.latencyCycles},
      cycle_{cycle},
      motion_{cycle},
      planner_{cycle} {
    view_.traits = &traits_;
    for (const std::size_t index : params.axes) {
        members_[size_] = machineAxes_[index];
        view_.members[size_] = &machineAxes_[index]->traits();
        ++size_;
    }
}

void Group::readMembers(core::CycleNumber cycle) noexcept {
    view_.cycle = cycle;
    updateMembers();
    superviseMembers();
    takePlan();
    updateProgress();
    updateRest();
    updateReset();
    waitForPlan();
}

void Group::updateMembers() noexcept {
    view_.actualValid = size_ > 0;
    view_.claim = ErrorId::None;
    const bool enabled = view_.state != GroupState::Disabled;
    for (std::size_t i = 0; i < size_; ++i) {
        if (members_[i] == nullptr) continue;
        const AxisView& axis = members_[i]->view();
        view_.set[i] = axis.set.count();
        view_.actual[i] = axis.actual.count();
        view_.actualValid = view_.actualValid && axis.inputsValid;
        if (!enabled && members_[i]->claimed()) view_.claim = ErrorId::AxisInOtherGroup;
    }
    view_.hurdle = hurdle();
}

/// What keeps the group from moving: the first thing that is wrong with a member.
ErrorId Group::hurdle() const noexcept {
    if (view_.state == GroupState::Disabled) return ErrorId::GroupNotEnabled;
    for (const Axis* member : members()) {
        const AxisView& axis = member->view();
        if (axis.machineStop) return ErrorId::MachineStopped;
        switch (axis.state) {
            case AxisState::Standstill:
                if (!axis.powered) return ErrorId::NotPowered;
                continue;
            case AxisState::Disabled:
                return ErrorId::NotPowered;
            case AxisState::ErrorStop:
                return ErrorId::AxisInErrorStop;
            case AxisState::SynchronizedMotion:
                if (axis.grouped && joined_) continue;
                return ErrorId::MemberBusy;
            case AxisState::Homing:
            case AxisState::DiscreteMotion:
            case AxisState::ContinuousMotion:
            case AxisState::Stopping:
                return ErrorId::MemberBusy;
        }
    }
    return ErrorId::None;
}

void Group::superviseMembers() noexcept {
    if (view_.state == GroupState::Disabled || view_.state == GroupState::ErrorStop) return;
    bool leaves = false;
    for (const Axis* member : members()) {
        const AxisState state = member->state();
        if (state == AxisState::ErrorStop) {
            const ErrorRecord& error = member->view().error;
            fail(error.id, error.numbers);
            return;
        }
        leaves = leaves || state != AxisState::SynchronizedMotion;
    }
    // MC_Stop, MC_Power, machine stop or the loss of a program took a member.
    if (view_.state == GroupState::Moving && joined_ && leaves)
        stopOnPath({CommandPhase::Aborted, ErrorId::None});
}

/// Ends the motions that the path has left, and gives control to the one that it is in.
void Group::updateProgress() noexcept {
    if (view_.state != GroupState::Moving) return;
    constexpr CommandStatus Done{CommandPhase::Done, ErrorId::None};
    if (const planner::PathMotion* path = motion_.path(); path != nullptr) {
        const planner::PathGeometry& geometry = path->geometry;
        const std::uint32_t here = geometry.element(geometry.elementAt(motion_.feed().s)).tag;
        while (!queue_.empty() && queue_.front().serial < here) endFront(Done);
        if (!frontActive_ && !queue_.empty() && queue_.front().serial == here) activateFront();
        return;
    }
    if (!motion_.resting() || !frontActive_) return;
    const bool path = isPath(queue_.front().command.kind);
    endFront(Done);
    // What follows on the same path has been run through in the last cycle, or had no length.
    while (path && !queue_.empty() && queue_.front().serial <= pathEnd_) endFront(Done);
    if (queue_.empty()) enter(GroupState::Standby);
}

void Group::updateRest() noexcept {
    if (!motion_.resting()) return;
    if (view_.state == GroupState::ErrorStop) {
        leaveMembers();
        if (disabling_) enter(GroupState::Disabled);
        return;
    }
    if (view_.state != GroupState::Stopping) return;
    leaveMembers();
    if (!view_.stopDone) {
        view_.stopDone = true;
        report(view_.active, {CommandPhase::Done, ErrorId::None});
    }
    if (view_.stopReleased) enter(disabling_ ? GroupState::Disabled : GroupState::Standby);
}

void Group::enter(GroupState state) noexcept {
    view_.state = state;
    view_.active = CommandId::None;
    view_.stopDone = false;
    view_.stopReleased = true;
    lead_ = latency_;
    leaveMembers();
    if (state != GroupState::Disabled) return;
    report(std::exchange(disable_, CommandId::None), {CommandPhase::Done, ErrorId::None});
    disabling_ = false;
    view_.error = {};
    for (Axis* member : members()) {
        if (member != nullptr) member->unclaim();
    }
}

void Group::updateReset() noexcept {
    if (resets_.empty()) return;
    ErrorId error = ErrorId::None;
    for (const Axis* member : members()) {
        if (member->resetRunning()) return;
        if (member->state() == AxisState::ErrorStop) error = member->resetError();
    }
    if (!motion_.resting()) return;
    const CommandPhase phase = error == ErrorId::None ? CommandPhase::Done : CommandPhase::Error;
    for (const CommandId id : resets_) report(id, {phase, error});
    resets_.clear();
    if (error != ErrorId::None || view_.state != GroupState::ErrorStop) return;
    view_.error = {};
    enter(GroupState::Standby);
}

void Group::step() noexcept {
    superviseMembers();
    startFront();
    const double before = motion_.feed().s2;
    const bool moved = !motion_.resting();
    motion_.step();
    const double seconds = std::chrono::duration<double>(cycle_).count();
    jerk_ = moved ? core::Jerk{(motion_.feed().s2 - before) / seconds} : core::Jerk{};
    leadMembers();
    askForPlan();
}

void Group::missCycle() noexcept {
    motion_.step();
    leadMembers();
}

void Group::leadMembers() noexcept {
    if (!joined_) return;
    for (std::size_t i = 0; i < size_; ++i) members_[i]->follow(motion_.states()[i]);
}

GroupStatus Group::status() const noexcept {
    GroupStatus s;
    s.state = view_.state;
    s.queued = view_.queued;
    s.command = commands_;
    s.path = motion_.travelled();
    s.velocity = core::Velocity{motion_.feed().s1};
    s.acceleration = core::Acceleration{motion_.feed().s2};
    s.jerk = jerk_;
    s.error = view_.error.id;
    s.latePlans = latePlans_;
    return s;
}

}  // namespace takt::axis
