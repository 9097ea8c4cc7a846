#include <algorithm>
#include <cmath>
#include <takt/axis/admit.hpp>
#include <takt/axis/motion.hpp>

namespace takt::axis {

using core::Acceleration;
using core::Distance;
using core::Position;
using core::Seconds;
using core::Velocity;
using planner::State;

namespace {

/// A duration this little (relative to a cycle) above a whole number of cycles is rounding.
constexpr double kStepTolerance = 1e-9;

Dynamics gentler(const Dynamics& dynamics) noexcept {
    Dynamics d = dynamics;
    d.acceleration = d.deceleration = std::min(d.acceleration, d.deceleration);
    return d;
}

State restAt(Position position) noexcept {
    return {position, Velocity{}, Acceleration{}};
}

}  // namespace

Motion::Motion(const AxisTraits& traits, core::Duration cycle) noexcept
    : traits_{&traits}, cycle_{std::chrono::duration<double>(cycle).count()} {}

void Motion::hold(Position position) noexcept {
    set_ = restAt(position);
    step_ = steps_ = 0;
    resting_ = true;
    endsAtRest_ = true;
    guarded_ = false;
    limitHit_ = false;
}

ErrorId Motion::begin(const Command& command) noexcept {
    const Dynamics dynamics = holdingVelocity(command.dynamics);
    switch (command.kind) {
        case CommandKind::MoveAbsolute: {
            const bool modulo = traits_->period > Distance{};
            return beginPosition(modulo ? moduloTarget(command, dynamics) : command.position,
                                 dynamics);
        }
        case CommandKind::MoveRelative:
            return beginPosition(set_.position + command.distance, dynamics);
        case CommandKind::MoveVelocity:
            return beginVelocity(dynamics);
        case CommandKind::Halt:
        case CommandKind::Stop:
            return beginBraking(dynamics);
        case CommandKind::PowerOn:
        case CommandKind::PowerOff:
        case CommandKind::Reset:
        case CommandKind::ReleaseStop:
        case CommandKind::Home:
            break;
    }
    return ErrorId::InvalidParameter;
}

/// Taking the present acceleration back with a gentle jerk gains velocity (a²/2j). Where that would
/// pass the axis' limit, the jerk is raised: the motion so far kept the limit, so its own jerk is
/// enough.
Dynamics Motion::holdingVelocity(const Dynamics& dynamics) const noexcept {
    Dynamics d = dynamics;
    const double a = set_.acceleration.count();
    if (a == 0.0) return d;
    const double limit = traits_->limits.velocity.count();
    const double v = set_.velocity.count();
    const double room = a > 0.0 ? limit - v : limit + v;
    const double hardest = std::max(traits_->limits.jerk, traits_->limits.stopJerk).count();
    const double needed = room > 0.0 ? std::min(a * a / (2.0 * room), hardest) : hardest;
    d.jerk = std::max(d.jerk, core::Jerk{needed});
    return d;
}

bool Motion::beginStop() noexcept {
    const LimitParams& l = traits_->limits;
    const Dynamics d =
        holdingVelocity({l.velocity, l.stopDeceleration, l.stopDeceleration, l.stopJerk});
    const auto profile = planner::planStop(set_, braking(d));
    if (!profile.ok()) return false;
    run(profile.value());
    return true;
}

ErrorId Motion::beginBraking(const Dynamics& dynamics) noexcept {
    const auto profile = planner::planStop(set_, braking(dynamics));
    if (!profile.ok()) return ErrorId::ProfileNotFeasible;
    // A stop too gentle for a software limit is made as hard as the axis may.
    if (limitPassed(profile.value().end().position)) {
        return beginStop() ? ErrorId::None : ErrorId::ProfileNotFeasible;
    }
    run(profile.value());
    return ErrorId::None;
}

/// Whether the way to go has a turn in it, and whether it stays inside the software limits until
/// there. `wanted` is the direction of travel, `target` where it ends, if it does.
ErrorId Motion::judgeWay(const Dynamics& dynamics, double wanted, std::optional<Position> target,
                         bool& turns) const noexcept {
    turns = false;
    if (!underWay()) return ErrorId::None;
    auto stop = stopFrom(set_, dynamics);
    if (!stop) return ErrorId::ProfileNotFeasible;
    const double present =
        set_.velocity == Velocity{} ? set_.acceleration.count() : set_.velocity.count();
    const double rest = (*stop - set_.position).count();
    turns = present * wanted < 0.0 || rest * wanted < 0.0;
    if (target) turns = turns || (*stop - *target).count() * wanted > 0.0;
    if (turns) {
        // The way back is planned with the smaller limit, so braking takes as long as that needs.
        stop = stopFrom(set_, gentler(dynamics));
        if (!stop) return ErrorId::ProfileNotFeasible;
    }
    return limitPassed(*stop) ? ErrorId::SWLimitReached : ErrorId::None;
}

ErrorId Motion::beginPosition(Position target, const Dynamics& dynamics) noexcept {
    if (const ErrorId bad = checkTarget(*traits_, target); bad != ErrorId::None) return bad;
    const bool forward = target >= set_.position;
    bool turns = false;
    const ErrorId way = judgeWay(dynamics, (target - set_.position).count(), target, turns);
    if (way != ErrorId::None) return way;
    const auto profile = planner::plan(set_, {planner::TargetKind::State, restAt(target)},
                                       moving(dynamics, forward, turns));
    if (!profile.ok()) return ErrorId::ProfileNotFeasible;
    run(profile.value());
    target_ = target;
    return ErrorId::None;
}

ErrorId Motion::beginVelocity(const Dynamics& dynamics) noexcept {
    const Velocity wanted = dynamics.velocity;
    bool turns = false;
    const ErrorId way = judgeWay(dynamics, wanted.count(), std::nullopt, turns);
    if (way != ErrorId::None) return way;
    const bool forward =
        set_.velocity == Velocity{} ? wanted >= Velocity{} : set_.velocity > Velocity{};
    Dynamics d = dynamics;
    d.velocity = traits_->limits.velocity;
    const auto profile =
        planner::plan(set_, {planner::TargetKind::Velocity, {Position{}, wanted, Acceleration{}}},
                      moving(d, forward, turns));
    if (!profile.ok()) return ErrorId::ProfileNotFeasible;
    run(profile.value());
    endsAtRest_ = wanted == Velocity{};
    guardVelocity(dynamics);
    return ErrorId::None;
}

void Motion::guardVelocity(const Dynamics& dynamics) noexcept {
    const Velocity wanted = dynamics.velocity;
    const auto& limit =
        wanted > Velocity{} ? traits_->limits.softPositive : traits_->limits.softNegative;
    if (wanted == Velocity{} || !limit) return;
    const auto stop = stopFrom({Position{}, wanted, Acceleration{}}, dynamics);
    if (!stop) return;  // then the set position itself is watched
    guard_ = *limit;
    guardDynamics_ = dynamics;
    stopDistance_ = *stop - Position{};
    guarded_ = true;
    const Position reached = profile_.end().position + stopDistance_;
    guardEarly_ = wanted > Velocity{} ? reached > guard_ : reached < guard_;
}

bool Motion::passesGuard(const State& state) const noexcept {
    std::optional<Position> stop;
    if (finished()) {
        stop = state.position + stopDistance_;
    } else if (guardEarly_) {
        stop = stopFrom(state, guardDynamics_);
    }
    if (!stop) return false;
    return guardDynamics_.velocity > Velocity{} ? *stop > guard_ : *stop < guard_;
}

void Motion::turnToLimit() noexcept {
    guarded_ = false;
    limitHit_ = true;
    Dynamics d = guardDynamics_;
    const bool forward = d.velocity > Velocity{};
    d.velocity = Velocity{std::max(std::abs(d.velocity.count()), std::abs(set_.velocity.count()))};
    const auto profile = planner::plan(set_, {planner::TargetKind::State, restAt(guard_)},
                                       moving(d, forward, false));
    if (profile.ok()) {
        run(profile.value());
        limitHit_ = true;
        target_ = guard_;
    } else if (beginStop()) {
        limitHit_ = true;
    }
}

State Motion::next() noexcept {
    if (resting_) return set_;
    ++step_;
    State state = stateAt(step_);
    if (guarded_ && passesGuard(state)) {
        turnToLimit();
        step_ = 1;
        state = stateAt(step_);
    }
    return state;
}

State Motion::stateAt(std::uint64_t step) const noexcept {
    if (step >= steps_ && endsAtRest_) return profile_.end();
    return planner::sample(profile_, Seconds{static_cast<double>(step) * cycle_});
}

void Motion::accept(const State& state) noexcept {
    if (state.velocity > Velocity{}) backward_ = false;
    if (state.velocity < Velocity{}) backward_ = true;
    set_ = state;
    if (finished() && endsAtRest_) resting_ = true;
}

void Motion::force(Position position, Velocity velocity) noexcept {
    hold(position);
    set_.velocity = velocity;
    resting_ = velocity == Velocity{};
}

void Motion::run(const planner::Profile& profile) noexcept {
    profile_ = profile;
    step_ = 0;
    const double cycles = profile.duration().count() / cycle_;
    steps_ = static_cast<std::uint64_t>(std::ceil(std::max(0.0, cycles - kStepTolerance)));
    target_ = profile.end().position;
    resting_ = false;
    endsAtRest_ = true;
    guarded_ = false;
    limitHit_ = false;
}

std::optional<Position> Motion::stopFrom(const State& from,
                                         const Dynamics& dynamics) const noexcept {
    const auto profile = planner::planStop(from, braking(dynamics));
    if (!profile.ok()) return std::nullopt;
    return profile.value().end().position;
}

std::optional<Position> Motion::limitPassed(Position stopsAt) const noexcept {
    const LimitParams& l = traits_->limits;
    if (l.softPositive && stopsAt > *l.softPositive && stopsAt > set_.position)
        return l.softPositive;
    if (l.softNegative && stopsAt < *l.softNegative && stopsAt < set_.position)
        return l.softNegative;
    return std::nullopt;
}

planner::Limits Motion::braking(const Dynamics& d) const noexcept {
    const Velocity v = traits_->limits.velocity;
    return {v, -v, d.deceleration, -d.deceleration, d.jerk};
}

planner::Limits Motion::moving(const Dynamics& d, bool forward, bool turns) const noexcept {
    // Speeding up and slowing down have limits of their own in the direction of travel. Where the
    // way turns, one sign of acceleration does both, so the smaller limit holds.
    Acceleration up = forward ? d.acceleration : d.deceleration;
    Acceleration down = forward ? d.deceleration : d.acceleration;
    if (turns) up = down = gentler(d).deceleration;
    return {d.velocity, -d.velocity, up, -down, d.jerk};
}

Position Motion::moduloTarget(const Command& command, const Dynamics& dynamics) noexcept {
    const double period = traits_->period.count();
    const double from = set_.position.count();
    // Way forward in [0, period); less than half a count either way is "there already".
    double forward = Scaling::foldInto(
        Scaling::foldInto(command.position.count(), period) - Scaling::foldInto(from, period),
        period);
    const double tolerance = traits_->resolution.count() / 2.0;
    const bool there = forward < tolerance || period - forward < tolerance;
    if (there && period - forward < tolerance) forward -= period;
    const double backward = there ? forward : forward - period;

    if (command.direction == Direction::ShortestWay) {
        return Position{from + (forward <= period / 2.0 ? forward : backward)};
    }
    bool up = command.direction == Direction::Positive;
    if (command.direction == Direction::Current) up = !backward_;
    double travel = up ? forward : backward;
    if (underWay()) {
        // Not to be stopped in time: as many more turns as braking takes.
        const auto stop = stopFrom(set_, dynamics);
        const double braking = stop ? (*stop - set_.position).count() : 0.0;
        const double missing = up ? braking - travel : travel - braking;
        if (missing > 0.0) travel += (up ? period : -period) * std::ceil(missing / period);
    }
    return Position{from + travel};
}

}  // namespace takt::axis
