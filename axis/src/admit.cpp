#include <cmath>
#include <takt/axis/admit.hpp>

#include "settle.hpp"

namespace takt::axis {

namespace {

/// The larger of the axis' ordinary and its stop value: what MC_Stop may ask for.
template <typename T>
constexpr T larger(T a, T b) noexcept {
    return a < b ? b : a;
}

ErrorId settleDynamics(const LimitParams& limits, Command& command) noexcept {
    Dynamics& d = command.dynamics;
    if (command.kind == CommandKind::Stop) {
        const auto most = larger(limits.stopDeceleration, limits.deceleration);
        const ErrorId bad = settle(d.deceleration, limits.stopDeceleration, most);
        if (bad != ErrorId::None) return bad;
        return settle(d.jerk, limits.stopJerk, larger(limits.stopJerk, limits.jerk));
    }
    const ErrorId bad = settle(d.deceleration, limits.deceleration, limits.deceleration);
    if (bad != ErrorId::None) return bad;
    if (const ErrorId jerk = settle(d.jerk, limits.jerk, limits.jerk); jerk != ErrorId::None) {
        return jerk;
    }
    if (command.kind == CommandKind::Halt) return ErrorId::None;
    return settle(d.acceleration, limits.acceleration, limits.acceleration);
}

/// Velocity of a positioning move: either sign, never 0.
ErrorId settleSpeed(const LimitParams& limits, core::Velocity& velocity) noexcept {
    if (!std::isfinite(velocity.count())) return ErrorId::NotFinite;
    if (velocity < core::Velocity{0.0}) velocity = -velocity;
    if (velocity == core::Velocity{0.0}) return ErrorId::InvalidParameter;
    return limits.velocity < velocity ? ErrorId::LimitExceeded : ErrorId::None;
}

bool validDirection(Direction direction) noexcept {
    return direction >= Direction::Positive && direction <= Direction::Current;
}

/// The velocity asked for with the sign it will have: sign(Velocity) · sign(Direction); Current
/// keeps the direction of the present or last motion.
ErrorId settleSignedVelocity(const AxisView& view, Command& command) noexcept {
    core::Velocity& v = command.dynamics.velocity;
    if (!std::isfinite(v.count())) return ErrorId::NotFinite;
    if (command.direction == Direction::ShortestWay || !validDirection(command.direction)) {
        return ErrorId::DirectionInvalid;
    }
    if (command.direction == Direction::Negative) v = -v;
    if (command.direction == Direction::Current &&
        (v < core::Velocity{0.0}) != view.movedBackward) {
        v = -v;
    }
    command.direction =
        Direction::Positive;  // the sign says it all; admitting twice changes nothing
    if (std::abs(v.count()) > view.traits->limits.velocity.count()) return ErrorId::LimitExceeded;
    return ErrorId::None;
}

/// An axis that stands at or beyond a software limit may only move inward.
ErrorId checkOutward(const AxisView& view, core::Velocity velocity) noexcept {
    const LimitParams& limits = view.traits->limits;
    const bool up = velocity > core::Velocity{0.0};
    const bool down = velocity < core::Velocity{0.0};
    if (up && limits.softPositive && view.set >= *limits.softPositive) {
        return ErrorId::SWLimitReached;
    }
    if (down && limits.softNegative && view.set <= *limits.softNegative) {
        return ErrorId::SWLimitReached;
    }
    return ErrorId::None;
}

ErrorId admitAbsolute(const AxisView& view, Command& command) noexcept {
    if (!std::isfinite(command.position.count())) return ErrorId::NotFinite;
    if (const ErrorId bad = settleSpeed(view.traits->limits, command.dynamics.velocity);
        bad != ErrorId::None) {
        return bad;
    }
    if (!validDirection(command.direction)) return ErrorId::DirectionInvalid;
    return checkTarget(*view.traits, command.position);
}

ErrorId admitRelative(const AxisView& view, Command& command) noexcept {
    if (!std::isfinite(command.distance.count())) return ErrorId::NotFinite;
    if (const ErrorId bad = settleSpeed(view.traits->limits, command.dynamics.velocity);
        bad != ErrorId::None) {
        return bad;
    }
    // A queued one starts from a position that is not known yet; the axis checks it again then.
    if (mustQueue(view, command)) return ErrorId::None;
    return checkTarget(*view.traits, view.set + command.distance);
}

ErrorId admitVelocity(const AxisView& view, Command& command) noexcept {
    if (const ErrorId bad = settleSignedVelocity(view, command); bad != ErrorId::None) return bad;
    if (mustQueue(view, command)) return ErrorId::None;
    return checkOutward(view, command.dynamics.velocity);
}

ErrorId stateForMotion(const AxisView& view, const Command& command) noexcept {
    const bool buffered = command.bufferMode != BufferMode::Aborting;
    switch (view.state) {
        case AxisState::Disabled:
            return ErrorId::NotPowered;
        case AxisState::ErrorStop:
            return ErrorId::AxisInErrorStop;
        case AxisState::Stopping:
            return ErrorId::AxisLocked;
        case AxisState::Homing:
            return buffered ? ErrorId::None : ErrorId::InvalidState;
        case AxisState::Standstill:
            return ErrorId::None;
        case AxisState::DiscreteMotion:
        case AxisState::ContinuousMotion:
        case AxisState::SynchronizedMotion:
            break;
    }
    if (view.grouped) return ErrorId::AxisInGroup;
    // Homing starts from Standstill only; waiting for it in the queue is allowed.
    if (command.kind == CommandKind::Home && !buffered) return ErrorId::InvalidState;
    return ErrorId::None;
}

ErrorId stateForStop(const AxisView& view, const Command& command) noexcept {
    switch (view.state) {
        case AxisState::Disabled:
        case AxisState::ErrorStop:
            return ErrorId::InvalidState;
        case AxisState::Stopping:
            break;
        case AxisState::Standstill:
        case AxisState::Homing:
        case AxisState::DiscreteMotion:
        case AxisState::ContinuousMotion:
        case AxisState::SynchronizedMotion:
            return ErrorId::None;
    }
    // Only the instance that holds the axis may stop it anew.
    const bool sameInstance = view.active != CommandId::None && view.active == command.replaces;
    return sameInstance ? ErrorId::None : ErrorId::AxisLocked;
}

ErrorId admitMotion(const AxisView& view, Command& command) noexcept {
    if (const ErrorId bad = stateForMotion(view, command); bad != ErrorId::None) return bad;
    if (command.bufferMode > BufferMode::Buffered) return ErrorId::BlendingNotPossible;
    if (command.kind == CommandKind::Home) {
        return std::isfinite(command.position.count()) ? ErrorId::None : ErrorId::NotFinite;
    }
    return settleDynamics(view.traits->limits, command);
}

ErrorId admitKind(const AxisView& view, Command& command) noexcept {
    switch (command.kind) {
        case CommandKind::PowerOn:
        case CommandKind::PowerOff:
        case CommandKind::Reset:
        case CommandKind::ReleaseStop:
        case CommandKind::Halt:
        case CommandKind::Home:
            return ErrorId::None;
        case CommandKind::Stop: {
            const ErrorId bad = stateForStop(view, command);
            return bad != ErrorId::None ? bad : settleDynamics(view.traits->limits, command);
        }
        case CommandKind::MoveAbsolute:
            return admitAbsolute(view, command);
        case CommandKind::MoveRelative:
            return admitRelative(view, command);
        case CommandKind::MoveVelocity:
            return admitVelocity(view, command);
    }
    return ErrorId::InvalidParameter;
}

void takeControl(AxisView& view, const Command& command) noexcept {
    view.active = command.id;
    view.queued = 0;
    view.inVelocity = false;
    view.stopDone = false;
    view.state = AxisState::DiscreteMotion;
    if (command.kind == CommandKind::Home) view.state = AxisState::Homing;
    if (command.kind == CommandKind::MoveVelocity) view.state = AxisState::ContinuousMotion;
}

void notePowerOff(AxisView& view) noexcept {
    const bool wasRequested = view.powerRequested;
    view.powerRequested = false;
    if (!view.machineStop) view.needsEnableEdge = false;
    if (!wasRequested || view.state == AxisState::Disabled || view.state == AxisState::ErrorStop) {
        return;
    }
    const bool ramp = view.traits->powerOff == PowerOffMode::Ramp &&
                      !(view.atRest && view.state != AxisState::Homing);
    view.state = ramp ? AxisState::Stopping : AxisState::Disabled;
    view.stopReleased = true;
    view.stopDone = false;
    view.active = CommandId::None;
    view.queued = 0;
    view.inVelocity = false;
}

void noteStop(AxisView& view, const Command& command) noexcept {
    const bool still = doneAtOnce(view, command);
    view.state = AxisState::Stopping;
    view.active = command.id;
    view.queued = 0;
    view.inVelocity = false;
    view.stopDone = still;
    view.stopReleased = false;
}

void noteRelease(AxisView& view, const Command& command) noexcept {
    if (view.state != AxisState::Stopping || view.active == CommandId::None) return;
    if (view.active != command.replaces) return;
    view.stopReleased = true;
    if (!view.stopDone) return;
    view.state = AxisState::Standstill;
    view.active = CommandId::None;
}

}  // namespace

ErrorId checkTarget(const AxisTraits& traits, core::Position target) noexcept {
    if (!(std::abs(target.count()) <= traits.maxPosition.count())) return ErrorId::LimitExceeded;
    const LimitParams& limits = traits.limits;
    if (limits.softPositive && target > *limits.softPositive) return ErrorId::TargetOutsideSWLimit;
    if (limits.softNegative && target < *limits.softNegative) return ErrorId::TargetOutsideSWLimit;
    return ErrorId::None;
}

core::Result<Command, ErrorId> admit(const AxisView& view, const Command& request) noexcept {
    Command command = request;
    const bool wantsPower = command.kind == CommandKind::PowerOn;
    const bool barred = view.machineStop ? wantsPower || isMotion(command.kind)
                                         : wantsPower && view.needsEnableEdge;
    if (barred) return ErrorId::MachineStopped;
    if (isMotion(command.kind)) {
        if (const ErrorId bad = admitMotion(view, command); bad != ErrorId::None) return bad;
    }
    if (const ErrorId bad = admitKind(view, command); bad != ErrorId::None) return bad;
    if (mustQueue(view, command) && view.queued >= view.traits->queueDepth) {
        return ErrorId::BufferFull;
    }
    return command;
}

bool mustQueue(const AxisView& view, const Command& command) noexcept {
    return isMotion(command.kind) && command.bufferMode != BufferMode::Aborting && view.inMotion();
}

bool doneAtOnce(const AxisView& view, const Command& command) noexcept {
    switch (command.kind) {
        case CommandKind::Halt:
            return view.state == AxisState::Standstill;
        case CommandKind::Stop:
            return view.atRest && view.state != AxisState::Homing;
        case CommandKind::Reset:
            return view.state != AxisState::ErrorStop;
        case CommandKind::PowerOn:
        case CommandKind::PowerOff:
        case CommandKind::ReleaseStop:
        case CommandKind::Home:
        case CommandKind::MoveAbsolute:
        case CommandKind::MoveRelative:
        case CommandKind::MoveVelocity:
            break;
    }
    return false;
}

void noteAccepted(AxisView& view, const Command& command) noexcept {
    switch (command.kind) {
        case CommandKind::PowerOn:
            view.powerRequested = true;
            return;
        case CommandKind::PowerOff:
            notePowerOff(view);
            return;
        case CommandKind::Reset:
            return;
        case CommandKind::ReleaseStop:
            noteRelease(view, command);
            return;
        case CommandKind::Stop:
            noteStop(view, command);
            return;
        case CommandKind::Halt:
        case CommandKind::Home:
        case CommandKind::MoveAbsolute:
        case CommandKind::MoveRelative:
        case CommandKind::MoveVelocity:
            break;
    }
    if (doneAtOnce(view, command)) return;
    if (mustQueue(view, command)) {
        ++view.queued;
    } else {
        takeControl(view, command);
    }
}

}  // namespace takt::axis
