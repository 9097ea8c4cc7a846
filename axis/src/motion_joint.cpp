#include <algorithm>
#include <cmath>
#include <takt/axis/admit.hpp>
#include <takt/axis/motion.hpp>
#include <takt/planner/profile_query.hpp>

#include "look_ahead.hpp"

/// Moves that pass their end without stopping there.
#include <takt/planner/speed_change.hpp>

namespace takt::axis {

using core::Acceleration;
using core::Distance;
using core::Position;
using core::Seconds;
using core::Velocity;
using planner::State;

namespace {

/// A profile may be this part of a count beside its way: rounding.
constexpr double kWayTolerance = 0.01;

State passing(Position position, bool forward, double speed) noexcept {
    return {position, Velocity{forward ? speed : -speed}, Acceleration{}};
}

planner::Limits upTo(planner::Limits limits, double speed) noexcept {
    limits.maxVelocity = std::max(limits.maxVelocity, Velocity{speed});
    limits.minVelocity = -limits.maxVelocity;
    return limits;
}

planner::RampLimits speedingUp(const planner::Limits& limits, bool forward) noexcept {
    const Acceleration a = forward ? limits.maxAcceleration : -limits.minAcceleration;
    return {a.count(), limits.jerk.count()};
}

}  // namespace

Seconds Motion::duration() const noexcept {
    return staged_ ? profile_.duration() + second_.duration() : profile_.duration();
}

ErrorId Motion::beginMove(const Command& command, Position goal, const Dynamics& dynamics,
                          Velocity joint) noexcept {
    if (isEndless(command.kind)) return beginContinuous(goal, command.endVelocity, dynamics);
    if (const ErrorId bad = checkTarget(*traits_, goal); bad != ErrorId::None) return bad;
    if (joint > Velocity{} && beginPassing(goal, dynamics, joint.count())) return ErrorId::None;
    return beginPosition(goal, dynamics);
}

ErrorId Motion::beginContinuous(Position goal, Velocity endVelocity,
                                const Dynamics& dynamics) noexcept {
    if (const ErrorId bad = checkTarget(*traits_, goal); bad != ErrorId::None) return bad;
    const bool forward = goal >= set_.position;
    const bool goesOn = endVelocity != Velocity{} && (endVelocity > Velocity{}) == forward;
    if (goesOn) {
        // Exactly this velocity: a run-up the other way is not what anybody expects.
        const Way way = wayTo(goal, dynamics);
        const double end = std::abs(endVelocity.count());
        if (!(end > dynamics.velocity.count() && beginStaged(way, end)) && !beginDirect(way, end)) {
            return ErrorId::ProfileNotFeasible;
        }
    } else {
        const bool turns = endVelocity != Velocity{} ||
                           turnsOnTheWay(dynamics, (goal - set_.position).count(), goal);
        const auto profile =
            planner::plan(set_, {planner::TargetKind::State, {goal, endVelocity, Acceleration{}}},
                          upTo(moving(dynamics, forward, turns), std::abs(endVelocity.count())));
        if (!profile.ok()) return ErrorId::ProfileNotFeasible;
        if (leavesUpward(profile.value()) || leavesDownward(profile.value())) {
            return ErrorId::SWLimitReached;
        }
        run(profile.value());
    }
    joint_ = 0.0;  // the command stays in control behind its position
    target_ = goal;
    endsAtRest_ = endVelocity == Velocity{};
    guardVelocity(dynamics, endVelocity);
    return ErrorId::None;
}

void Motion::changeJoint(const Command& running, Velocity joint) noexcept {
    // What is planned can be kept; only more is worth a new plan.
    constexpr double kWorthIt = 1.0 + 1e-9;
    if (finished() || joint.count() <= joint_ * kWorthIt) return;
    const Position goal = target_;
    // Without success the running profile is left alone, so nothing needs to be put back.
    static_cast<void>(beginPassing(goal, holdingVelocity(running.dynamics), joint.count()));
}

ErrorId Motion::pass(const Command& next, Velocity joint) noexcept {
    const double late = static_cast<double>(step_ + 1) * cycle_ + lead_ - duration().count();
    // The new motion begins at the joint itself, not at the last set-point before it.
    const State before = set_;
    set_ = end();
    const Dynamics dynamics = holdingVelocity(next.dynamics);
    ErrorId bad = ErrorId::None;
    if (next.kind == CommandKind::MoveVelocity) {
        bad = beginVelocity(dynamics);
    } else {
        bad = beginMove(next, goalFrom(*traits_, next, set_.position, backward_), dynamics, joint);
    }
    if (bad == ErrorId::None) startAt(std::max(0.0, late) - cycle_);
    set_ = before;
    return bad;
}

Motion::Way Motion::wayTo(Position target, const Dynamics& dynamics) const noexcept {
    const bool forward = target >= set_.position;
    const bool turns = turnsOnTheWay(dynamics, (target - set_.position).count(), std::nullopt);
    Way way{target, forward, set_.position, moving(dynamics, forward, turns)};
    if (turns) {
        // Still going the other way: it may go on until it has braked.
        if (const auto stop = stopFrom(set_, dynamics)) {
            way.outermost = forward ? std::min(way.outermost, stop->lowest)
                                    : std::max(way.outermost, stop->highest);
        }
    }
    return way;
}

bool Motion::keepsTo(const Way& way, const planner::Profile& profile, Distance tolerance) noexcept {
    const planner::PositionExtremes seen = planner::extremesOf(profile);
    const Position low = way.forward ? way.outermost : way.target;
    const Position high = way.forward ? way.target : way.outermost;
    return seen.lowest >= low - tolerance && seen.highest <= high + tolerance;
}

double Motion::reachable(const Way& way, double end) const noexcept {
    const double sign = way.forward ? 1.0 : -1.0;
    const double v = sign * set_.velocity.count();
    const double a = sign * set_.acceleration.count();
    const planner::RampLimits up = speedingUp(way.limits, way.forward);
    // The present acceleration as part of a ramp that began (or will begin) without one.
    const double t = a / up.jerk;
    const double base = v - a * t / 2.0;
    const double travelled = base * t + up.jerk * t * t * t / 6.0;
    const double room = std::abs((way.target - set_.position).count()) * (1.0 - 1e-9) + travelled;
    return planner::fastestWithin(room, base, end, up);
}

bool Motion::beginDirect(const Way& way, double end) noexcept {
    const auto profile =
        planner::plan(set_, {planner::TargetKind::State, passing(way.target, way.forward, end)},
                      upTo(way.limits, end));
    if (!profile.ok() || !keepsTo(way, profile.value(), traits_->resolution * kWayTolerance)) {
        return false;
    }
    if (leavesUpward(profile.value()) || leavesDownward(profile.value())) return false;
    run(profile.value());
    joint_ = end;
    endsAtRest_ = false;
    return true;
}

bool Motion::beginStaged(const Way& way, double end) noexcept {
    const double sign = way.forward ? 1.0 : -1.0;
    const double cruise = way.limits.maxVelocity.count();
    const planner::RampLimits up = speedingUp(way.limits, way.forward);
    const Position meet =
        way.target - Distance{sign * planner::rampDistance(cruise, end, up) * (1.0 + 1e-9)};
    if (sign * (meet - set_.position).count() <= 0.0) return false;
    const Distance tolerance = traits_->resolution * kWayTolerance;
    const State joint = passing(meet, way.forward, cruise);
    const auto first = planner::plan(set_, {planner::TargetKind::State, joint}, way.limits);
    Way toMeet = way;
    toMeet.target = meet;
    if (!first.ok() || !keepsTo(toMeet, first.value(), tolerance)) return false;
    const auto second =
        planner::plan(joint, {planner::TargetKind::State, passing(way.target, way.forward, end)},
                      upTo(way.limits, end));
    if (!second.ok() || !keepsTo(way, second.value(), tolerance)) return false;
    if (leavesUpward(first.value()) || leavesDownward(first.value())) return false;
    runStaged(first.value(), second.value());
    joint_ = end;
    endsAtRest_ = false;
    return true;
}

bool Motion::beginPassing(Position target, const Dynamics& dynamics, double end) noexcept {
    const Way way = wayTo(target, dynamics);
    if (way.target == set_.position) return false;
    double speed = reachable(way, end);
    if (speed > dynamics.velocity.count() && beginStaged(way, speed)) return true;
    // What is reachable has been worked out from the present acceleration alone; a motion taken
    // over from a harder command may need a little more room.
    for (const double share : {1.0, 0.999, 0.99, 0.9, 0.5}) {
        if (speed * share > 0.0 && beginDirect(way, speed * share)) return true;
    }
    return false;
}

}  // namespace takt::axis
