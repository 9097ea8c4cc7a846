#include <algorithm>
#include <cmath>
#include <takt/axis/admit.hpp>
#include <takt/axis/motion.hpp>
#include <takt/planner/profile_query.hpp>
#include <takt/planner/take_over.hpp>

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

/// A gentle jerk must not let the velocity pass the axis' limit: the motion so far has kept it, so
/// its own jerk is enough.
Dynamics Motion::holdingVelocity(const Dynamics& dynamics) const noexcept {
    const LimitParams& l = traits_->limits;
    Dynamics d = dynamics;
    d.jerk = planner::takeOverJerk(set_, braking(dynamics), std::max(l.jerk, l.stopJerk));
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
    if (leavesUpward(profile.value()) || leavesDownward(profile.value())) {
        return beginStop() ? ErrorId::None : ErrorId::ProfileNotFeasible;
    }
    run(profile.value());
    return ErrorId::None;
}

/// Whether the way in the direction `wanted`, to `target` if it ends, has a turn in it.
bool Motion::turnsOnTheWay(const Dynamics& dynamics, double wanted,
                           std::optional<Position> target) const noexcept {
    if (!underWay()) return false;
    const auto stop = stopFrom(set_, dynamics);
    if (!stop) return true;
    const double present =
        set_.velocity == Velocity{} ? set_.acceleration.count() : set_.velocity.count();
    const double rest = (stop->end - set_.position).count();
    if (present * wanted < 0.0 || rest * wanted < 0.0) return true;
    if (!target) return false;
    return wanted > 0.0 ? stop->highest > *target : stop->lowest < *target;
}

ErrorId Motion::beginPosition(Position target, const Dynamics& dynamics) noexcept {
    if (const ErrorId bad = checkTarget(*traits_, target); bad != ErrorId::None) return bad;
    const bool forward = target >= set_.position;
    const bool turns = turnsOnTheWay(dynamics, (target - set_.position).count(), target);
    const auto profile = planner::plan(set_, {planner::TargetKind::State, restAt(target)},
                                       moving(dynamics, forward, turns));
    if (!profile.ok()) return ErrorId::ProfileNotFeasible;
    if (leavesUpward(profile.value()) || leavesDownward(profile.value())) {
        return ErrorId::SWLimitReached;
    }
    run(profile.value());
    target_ = target;
    return ErrorId::None;
}

ErrorId Motion::beginVelocity(const Dynamics& dynamics) noexcept {
    const Velocity wanted = dynamics.velocity;
    const bool turns = turnsOnTheWay(dynamics, wanted.count(), std::nullopt);
    const bool forward =
        set_.velocity == Velocity{} ? wanted >= Velocity{} : set_.velocity > Velocity{};
    Dynamics d = dynamics;
    d.velocity = traits_->limits.velocity;
    const auto profile =
        planner::plan(set_, {planner::TargetKind::Velocity, {Position{}, wanted, Acceleration{}}},
                      moving(d, forward, turns));
    if (!profile.ok()) return ErrorId::ProfileNotFeasible;
    // In the direction it will go for ever the limit is watched step by step, see next().
    const bool leaves = (wanted <= Velocity{} && leavesUpward(profile.value())) ||
                        (wanted >= Velocity{} && leavesDownward(profile.value()));
    if (leaves) return ErrorId::SWLimitReached;
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
    stopDistance_ = stop->end - Position{};
    guarded_ = true;
    const Position reached = profile_.end().position + stopDistance_;
    guardEarly_ = wanted > Velocity{} ? reached > guard_ : reached < guard_;
}

bool Motion::passesGuard(const State& state) const noexcept {
    const bool up = guardDynamics_.velocity > Velocity{};
    Position farthest = state.position + stopDistance_;
    if (!finished()) {
        if (!guardEarly_) return false;
        const auto stop = stopFrom(state, guardDynamics_);
        if (!stop) return true;
        farthest = up ? stop->highest : stop->lowest;
    }
    return up ? farthest > guard_ : farthest < guard_;
}

void Motion::turnToLimit() noexcept {
    Dynamics d = guardDynamics_;
    const bool forward = d.velocity > Velocity{};
    d.velocity = Velocity{std::max(std::abs(d.velocity.count()), std::abs(set_.velocity.count()))};
    const auto profile = planner::plan(set_, {planner::TargetKind::State, restAt(guard_)},
                                       moving(d, forward, false));
    const bool fits =
        profile.ok() && !leavesUpward(profile.value()) && !leavesDownward(profile.value());
    if (fits) {
        run(profile.value());
    } else {
        guarded_ = false;
        if (!beginStop()) return;  // then the set position itself is watched
    }
    limitHit_ = true;
    step_ = 1;
}

State Motion::next() noexcept {
    if (resting_) return set_;
    ++step_;
    State state = stateAt(step_);
    if (guarded_ && passesGuard(state)) {
        turnToLimit();
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

void Motion::lead(const State& state) noexcept {
    hold(state.position);
    set_ = state;
    resting_ = false;
    if (state.velocity > Velocity{}) backward_ = false;
    if (state.velocity < Velocity{}) backward_ = true;
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

std::optional<Motion::Stop> Motion::stopFrom(const State& from,
                                             const Dynamics& dynamics) const noexcept {
    const auto profile = planner::planStop(from, braking(dynamics));
    if (!profile.ok()) return std::nullopt;
    const planner::PositionExtremes extremes = planner::extremesOf(profile.value());
    return Stop{profile.value().end().position, extremes.lowest, extremes.highest};
}

bool Motion::leavesUpward(const planner::Profile& profile) const noexcept {
    const auto& limit = traits_->limits.softPositive;
    if (!limit) return false;
    // Half a count is rounding. A start outside is no offence, going farther out is.
    const Position highest = planner::extremesOf(profile).highest;
    return highest > *limit + traits_->resolution / 2.0 && highest > set_.position;
}

bool Motion::leavesDownward(const planner::Profile& profile) const noexcept {
    const auto& limit = traits_->limits.softNegative;
    if (!limit) return false;
    const Position lowest = planner::extremesOf(profile).lowest;
    return lowest < *limit - traits_->resolution / 2.0 && lowest < set_.position;
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
        const Position farthest = stop ? (up ? stop->highest : stop->lowest) : set_.position;
        const double braking = (farthest - set_.position).count();
        const double missing = up ? braking - travel : travel - braking;
        if (missing > 0.0) travel += (up ? period : -period) * std::ceil(missing / period);
    }
    return Position{from + travel};
}

}  // namespace takt::axis
