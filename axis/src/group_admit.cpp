#include <algorithm>
#include <cmath>
#include <limits>
#include <takt/axis/admit.hpp>
#include <takt/axis/group_admit.hpp>

#include "settle.hpp"

namespace takt::axis {

namespace {

using Kind = GroupCommandKind;

ErrorId admitAdd(const GroupView& view, GroupCommand& command) noexcept {
    if (view.state != GroupState::Disabled) return ErrorId::InvalidState;
    if (command.axis == nullptr) return ErrorId::NullReference;
    // Where a turn has no end a straight line to a target has none either.
    if (command.axis->period > core::Distance{}) return ErrorId::InvalidParameter;
    const auto& members = view.members;
    const auto member = std::find(members.begin(), members.end(), command.axis);
    if (member != members.end()) return ErrorId::InvalidParameter;
    if (command.place == 0) {
        const auto free = std::find(members.begin(), members.end(), nullptr);
        command.place = static_cast<std::uint8_t>(free - members.begin() + 1);
    }
    const bool fits = command.place <= MaxGroupAxes && members[command.place - 1U] == nullptr;
    return fits ? ErrorId::None : ErrorId::InvalidParameter;
}

ErrorId admitRemove(const GroupView& view, const GroupCommand& command) noexcept {
    if (view.state != GroupState::Disabled) return ErrorId::InvalidState;
    const bool there = command.place >= 1 && command.place <= MaxGroupAxes &&
                       view.members[command.place - 1U] != nullptr;
    return there ? ErrorId::None : ErrorId::InvalidParameter;
}

ErrorId admitEnable(const GroupView& view) noexcept {
    if (view.state == GroupState::ErrorStop) return ErrorId::GroupInErrorStop;
    if (view.state != GroupState::Disabled) return ErrorId::None;
    const std::size_t size = view.size();
    const auto end = view.members.begin() + static_cast<std::ptrdiff_t>(size);
    const bool complete = size > 0 && std::find(view.members.begin(), end, nullptr) == end;
    return complete ? view.claim : ErrorId::GroupIncomplete;
}

ErrorId stateForStop(const GroupView& view, const GroupCommand& command) noexcept {
    switch (view.state) {
        case GroupState::Disabled:
            return ErrorId::GroupNotEnabled;
        case GroupState::ErrorStop:
            return ErrorId::GroupInErrorStop;
        case GroupState::Stopping:
            break;
        case GroupState::Standby:
        case GroupState::Homing:
        case GroupState::Moving:
            return ErrorId::None;
    }
    // Only the instance that holds the group may stop it anew.
    const bool sameInstance = view.active != CommandId::None && view.active == command.replaces;
    return sameInstance ? ErrorId::None : ErrorId::GroupLocked;
}

/// What may be left to the axes: 0 becomes infinite, which is no bound.
template <typename T>
ErrorId settleFree(T& value) noexcept {
    if (!(value >= T{0.0})) return ErrorId::InvalidParameter;
    if (value == T{0.0}) value = T{std::numeric_limits<double>::infinity()};
    return ErrorId::None;
}

/// A stop may be as hard as the axes can.
ErrorId admitStop(const GroupView& view, GroupCommand& command) noexcept {
    if (const ErrorId bad = stateForStop(view, command); bad != ErrorId::None) return bad;
    const ErrorId bad = settleFree(command.dynamics.deceleration);
    return bad != ErrorId::None ? bad : settleFree(command.dynamics.jerk);
}

ErrorId stateForMotion(const GroupView& view) noexcept {
    switch (view.state) {
        case GroupState::Disabled:
            return ErrorId::GroupNotEnabled;
        case GroupState::ErrorStop:
            return ErrorId::GroupInErrorStop;
        case GroupState::Stopping:
            return ErrorId::GroupLocked;
        case GroupState::Homing:
            return ErrorId::InvalidState;
        case GroupState::Standby:
            return view.hurdle;
        case GroupState::Moving:
            break;
    }
    return ErrorId::None;
}

ErrorId settlePath(const PathLimitParams& limits, GroupCommand& command) noexcept {
    Dynamics& d = command.dynamics;
    if (const ErrorId bad = settle(d.deceleration, limits.deceleration, limits.deceleration);
        bad != ErrorId::None) {
        return bad;
    }
    if (const ErrorId bad = settle(d.jerk, limits.jerk, limits.jerk); bad != ErrorId::None) {
        return bad;
    }
    if (command.kind == Kind::Halt) return ErrorId::None;
    if (!std::isfinite(d.velocity.count())) return ErrorId::NotFinite;
    if (d.velocity <= core::Velocity{}) return ErrorId::InvalidParameter;
    if (limits.velocity < d.velocity) return ErrorId::LimitExceeded;
    return settle(d.acceleration, limits.acceleration, limits.acceleration);
}

/// Every axis goes by its own limits; what is said bounds them all.
ErrorId settleDirect(GroupCommand& command) noexcept {
    Dynamics& d = command.dynamics;
    for (const ErrorId bad : {settleFree(d.velocity), settleFree(d.acceleration),
                              settleFree(d.deceleration), settleFree(d.jerk)}) {
        if (bad != ErrorId::None) return bad;
    }
    return ErrorId::None;
}

/// A blending mode asks for a way on from the motion before it; without one it only waits.
ErrorId settleBlending(const GroupView& view, GroupCommand& command) noexcept {
    if (command.bufferMode > BufferMode::BlendingHigh) return ErrorId::InvalidParameter;
    if (command.bufferMode <= BufferMode::Buffered) {
        command.transition = {};
        return ErrorId::None;
    }
    if (!isPath(command.kind)) return ErrorId::BlendingNotPossible;
    if (view.inMotion() && !view.pathLast) return ErrorId::BlendingNotPossible;
    const Transition& t = command.transition;
    const bool sized =
        t.mode == TransitionMode::CornerDistance || t.mode == TransitionMode::MaxCornerDeviation;
    if (!sized && t.mode != TransitionMode::None) return ErrorId::TransitionNotSupported;
    if (sized && !(t.parameter > 0.0 && std::isfinite(t.parameter)))
        return ErrorId::TransitionNotSupported;
    const bool velocity = std::isfinite(t.velocity.count()) && t.velocity >= core::Velocity{};
    return velocity ? ErrorId::None : ErrorId::InvalidParameter;
}

ErrorId checkNumbers(const GroupCommand& command, std::size_t axes) noexcept {
    for (std::size_t i = 0; i < axes; ++i) {
        if (!std::isfinite(command.point[i])) return ErrorId::NotFinite;
    }
    if (command.kind != Kind::MoveCircular) return ErrorId::None;
    for (std::size_t i = 0; i < axes; ++i) {
        if (!std::isfinite(command.arc.aux[i])) return ErrorId::NotFinite;
    }
    const Arc& arc = command.arc;
    if (arc.mode > CircMode::Radius || arc.choice > CircPathChoice::CounterClockwise)
        return ErrorId::InvalidParameter;
    return std::isfinite(arc.tolerance) && arc.tolerance >= 0.0 ? ErrorId::None
                                                                : ErrorId::InvalidParameter;
}

/// Points, where it is known what the motion starts from; else the group looks at them when it
/// begins.
ErrorId settlePoints(const GroupView& view, GroupCommand& command) noexcept {
    const std::size_t axes = view.size();
    if (const ErrorId bad = checkNumbers(command, axes); bad != ErrorId::None) return bad;
    const bool waits = mustQueue(view, command);
    const bool known = waits ? view.endKnown : !view.inMotion();
    const GroupPoint& from = waits ? view.end : view.set;
    if (known) {
        resolve(command, from, axes);
        return checkWay(view.axes(), command, from);
    }
    if (command.relative) return ErrorId::None;
    for (std::size_t i = 0; i < axes; ++i) {
        const ErrorId bad = checkTarget(*view.members[i], core::Position{command.point[i]});
        if (bad != ErrorId::None) return bad;
    }
    return ErrorId::None;
}

ErrorId admitMotion(const GroupView& view, GroupCommand& command) noexcept {
    if (const ErrorId bad = stateForMotion(view); bad != ErrorId::None) return bad;
    if (command.coordSystem != CoordSystem::Acs && command.coordSystem != CoordSystem::Mcs)
        return ErrorId::CoordSystemNotSupported;
    if (const ErrorId bad = settleBlending(view, command); bad != ErrorId::None) return bad;
    const ErrorId bad = command.kind == Kind::MoveDirect ? settleDirect(command)
                                                         : settlePath(view.traits->limits, command);
    if (bad != ErrorId::None) return bad;
    // While its path is planned the motion in control still counts as queued.
    const bool planned = view.active != CommandId::None;
    const std::uint32_t depth = view.traits->queueDepth + (planned ? 0U : 1U);
    if (mustQueue(view, command) && view.queued >= depth) return ErrorId::BufferFull;
    return command.kind == Kind::Halt ? ErrorId::None : settlePoints(view, command);
}

ErrorId admitKind(const GroupView& view, GroupCommand& command) noexcept {
    switch (command.kind) {
        case Kind::AddAxis:
            return admitAdd(view, command);
        case Kind::RemoveAxis:
            return admitRemove(view, command);
        case Kind::UngroupAll:
            if (view.state == GroupState::ErrorStop) return ErrorId::GroupInErrorStop;
            return view.state <= GroupState::Standby ? ErrorId::None : ErrorId::InvalidState;
        case Kind::Enable:
            return admitEnable(view);
        case Kind::Stop:
            return admitStop(view, command);
        case Kind::Disable:
        case Kind::Reset:
        case Kind::ReleaseStop:
            return ErrorId::None;
        case Kind::Halt:
        case Kind::MoveDirect:
        case Kind::MoveLinear:
        case Kind::MoveCircular:
            break;
    }
    return admitMotion(view, command);
}

void noteRelease(GroupView& view, const GroupCommand& command) noexcept {
    if (view.state != GroupState::Stopping || view.active == CommandId::None) return;
    if (view.active != command.replaces) return;
    view.stopReleased = true;
    if (!view.stopDone) return;
    view.state = GroupState::Standby;
    view.active = CommandId::None;
}

void noteStop(GroupView& view, const GroupCommand& command) noexcept {
    const bool still = doneAtOnce(view, command);
    view.state = GroupState::Stopping;
    view.active = command.id;
    view.queued = 0;
    view.stopDone = still;
    view.stopReleased = false;
}

void noteDisable(GroupView& view) noexcept {
    view.queued = 0;
    view.active = CommandId::None;
    const bool moves = view.inMotion() || (view.state == GroupState::Stopping && !view.stopDone);
    if (moves) {
        view.state = GroupState::Stopping;
        view.stopDone = false;
        view.stopReleased = true;
    } else if (view.state != GroupState::ErrorStop) {
        view.state = GroupState::Disabled;
    }
}

void noteMotion(GroupView& view, const GroupCommand& command) noexcept {
    if (doneAtOnce(view, command)) return;
    const bool waits = mustQueue(view, command);
    if (!waits) {
        view.queued = 0;
        view.active = CommandId::None;
        view.state = GroupState::Moving;
    }
    ++view.queued;
    view.pathLast = isPath(command.kind);
    if (command.kind == Kind::Halt) {
        view.endKnown = view.endKnown && waits;
        return;
    }
    view.endKnown = !command.relative;
    view.end = command.point;
}

}  // namespace

core::Result<GroupCommand, ErrorId> admit(const GroupView& view,
                                          const GroupCommand& request) noexcept {
    GroupCommand command = request;
    if (const ErrorId bad = admitKind(view, command); bad != ErrorId::None) return bad;
    return command;
}

bool mustQueue(const GroupView& view, const GroupCommand& command) noexcept {
    return isMotion(command.kind) && command.bufferMode != BufferMode::Aborting && view.inMotion();
}

bool doneAtOnce(const GroupView& view, const GroupCommand& command) noexcept {
    switch (command.kind) {
        case Kind::AddAxis:
        case Kind::RemoveAxis:
        case Kind::UngroupAll:
        case Kind::Enable:
            return true;
        case Kind::Disable:
            return view.state == GroupState::Disabled || view.state == GroupState::Standby ||
                   (view.state == GroupState::Stopping && view.stopDone);
        case Kind::Reset:
            return view.state != GroupState::ErrorStop;
        case Kind::Stop:
            return view.state == GroupState::Standby ||
                   (view.state == GroupState::Stopping && view.stopDone);
        case Kind::Halt:
            return view.state == GroupState::Standby;
        case Kind::ReleaseStop:
        case Kind::MoveDirect:
        case Kind::MoveLinear:
        case Kind::MoveCircular:
            break;
    }
    return false;
}

void noteAccepted(GroupView& view, const GroupCommand& command) noexcept {
    switch (command.kind) {
        case Kind::AddAxis:
            view.members[command.place - 1U] = command.axis;
            return;
        case Kind::RemoveAxis:
            view.members[command.place - 1U] = nullptr;
            return;
        case Kind::UngroupAll:
            view.members.fill(nullptr);
            view.state = GroupState::Disabled;
            return;
        case Kind::Enable:
            if (view.state == GroupState::Disabled) view.state = GroupState::Standby;
            return;
        case Kind::Disable:
            noteDisable(view);
            return;
        case Kind::Reset:
            return;
        case Kind::ReleaseStop:
            noteRelease(view, command);
            return;
        case Kind::Stop:
            noteStop(view, command);
            return;
        case Kind::Halt:
        case Kind::MoveDirect:
        case Kind::MoveLinear:
        case Kind::MoveCircular:
            break;
    }
    noteMotion(view, command);
}

}  // namespace takt::axis
