#include <algorithm>
#include <cmath>
#include <takt/axis/group_motion.hpp>
#include <takt/planner/profile_query.hpp>

namespace takt::axis {

using planner::FeedState;
using planner::State;

namespace {

/// A duration this little (relative to a cycle) above a whole number of cycles is rounding.
constexpr double kStepTolerance = 1e-9;

/// A brake on a path keeps its limits at the moments of the cycles; between them differences of
/// positions may be a little larger, for which this is kept back.
constexpr double kBrakeShare = 0.99;

/// No bound but those of the axes.
constexpr Dynamics kFree{core::Velocity{}, core::Acceleration{planner::unlimited},
                         core::Acceleration{planner::unlimited}, core::Jerk{planner::unlimited}};

std::uint64_t stepsFor(core::Seconds duration, double cycle) noexcept {
    const double cycles = duration.count() / cycle;
    return static_cast<std::uint64_t>(std::ceil(std::max(0.0, cycles - kStepTolerance)));
}

}  // namespace

GroupMotion::GroupMotion(core::Duration cycle) noexcept
    : cycle_{std::chrono::duration<double>(cycle).count()}, direct_{MaxGroupAxes} {}

void GroupMotion::begin(std::span<const AxisTraits* const> members,
                        const GroupPoint& positions) noexcept {
    axes_ = members.size();
    std::copy(members.begin(), members.end(), members_.begin());
    for (std::size_t i = 0; i < axes_; ++i) {
        states_[i] = {core::Position{positions[i]}, core::Velocity{}, core::Acceleration{}};
    }
    rest();
}

void GroupMotion::rest() noexcept {
    course_ = Course::Rest;
    path_ = nullptr;
    feed_ = {};
    for (State& state : states_) {
        state.velocity = core::Velocity{};
        state.acceleration = core::Acceleration{};
    }
}

void GroupMotion::runPath(const planner::PathMotion& path) noexcept {
    course_ = Course::Path;
    path_ = &path;
    index_ = 0;
    feed_ = path.feed.at(0);
}

ErrorId GroupMotion::runDirect(const GroupPoint& target, const Dynamics& dynamics) noexcept {
    std::array<planner::AxisRequest, MaxGroupAxes> requests{};
    for (std::size_t i = 0; i < axes_; ++i) {
        const LimitParams& l = members_[i]->limits;
        const auto v = std::min(dynamics.velocity, l.velocity);
        const auto up = std::min(dynamics.acceleration, l.acceleration);
        const auto down = std::min(dynamics.deceleration, l.deceleration);
        const bool forward = target[i] >= states_[i].position.count();
        requests[i].from = states_[i];
        requests[i].target = {planner::TargetKind::State,
                              {core::Position{target[i]}, core::Velocity{}, core::Acceleration{}}};
        requests[i].limits = {v, -v, forward ? up : down, forward ? -down : -up,
                              std::min(dynamics.jerk, l.jerk)};
    }
    planner::Timing timing;
    timing.cycle = core::Seconds{cycle_};
    for (std::size_t i = axes_; i < MaxGroupAxes; ++i) requests[i].enabled = false;
    const auto duration = direct_.plan(requests, timing);
    if (!duration.ok()) return ErrorId::ProfileNotFeasible;
    course_ = Course::Direct;
    index_ = 0;
    steps_ = stepsFor(duration.value(), cycle_);
    return ErrorId::None;
}

planner::Limits GroupMotion::brakeLimits(std::size_t axis, const Dynamics& dynamics,
                                         bool byAxes) const noexcept {
    const LimitParams& l = members_[axis]->limits;
    const auto a = std::min(byAxes ? l.stopDeceleration : l.deceleration, dynamics.deceleration);
    const auto j = std::min(byAxes ? l.stopJerk : l.jerk, dynamics.jerk);
    return {l.velocity, -l.velocity, a, -a, j};
}

void GroupMotion::brake(const Dynamics& dynamics, bool byAxes) noexcept {
    if (resting()) return;
    if (course_ == Course::Path || course_ == Course::BrakePath) {
        brakeOnPath(dynamics, byAxes);
    } else {
        brakeDirect(dynamics, byAxes);
    }
}

void GroupMotion::brakeOnPath(const Dynamics& dynamics, bool byAxes) noexcept {
    std::array<planner::PathAxisLimits, MaxGroupAxes> limits{};
    for (std::size_t i = 0; i < axes_; ++i) {
        const planner::Limits l = brakeLimits(i, kFree, byAxes);
        limits[i] = {l.maxVelocity, l.maxAcceleration * kBrakeShare, l.jerk * kBrakeShare};
    }
    planner::PathFeed feed;
    feed.deceleration = dynamics.deceleration * kBrakeShare;
    feed.jerk = dynamics.jerk * kBrakeShare;
    if (course_ == Course::Path) {
        brake_.start(*path_, index_, {limits.data(), axes_}, feed);
    } else {
        brake_.setLimits({limits.data(), axes_}, feed);
    }
    course_ = Course::BrakePath;
}

/// Off a path there is nothing to stay on: each axis as fast as it may.
void GroupMotion::brakeDirect(const Dynamics& dynamics, bool byAxes) noexcept {
    steps_ = 0;
    for (std::size_t i = 0; i < axes_; ++i) {
        stops_[i] = stopOf(i, dynamics, byAxes);
        steps_ = std::max(steps_, stepsFor(stops_[i].duration(), cycle_));
    }
    index_ = 0;
    course_ = Course::BrakeDirect;
}

planner::Profile GroupMotion::stopOf(std::size_t axis, const Dynamics& dynamics,
                                     bool byAxes) const noexcept {
    const LimitParams& l = members_[axis]->limits;
    const auto inside = [&l](const planner::Profile& profile) {
        const planner::PositionExtremes extremes = planner::extremesOf(profile);
        return (!l.softPositive || extremes.highest <= *l.softPositive) &&
               (!l.softNegative || extremes.lowest >= *l.softNegative);
    };
    // The motion itself would have ended at its target: no stop goes farther.
    const core::Position target = direct_[axis].end().position;
    const bool forward = target >= states_[axis].position;
    const auto endsInTime = [target, forward](const planner::Profile& profile) {
        const core::Position end = profile.end().position;
        return forward ? end <= target : end >= target;
    };
    for (const Dynamics& tried : {dynamics, kFree}) {
        const auto stop = planner::planStop(states_[axis], brakeLimits(axis, tried, byAxes));
        if (stop.ok() && inside(stop.value()) && endsInTime(stop.value())) return stop.value();
    }
    // A stop too gentle for a software limit is made as hard as the axis may.
    const auto hard = planner::planStop(states_[axis], brakeLimits(axis, kFree, true));
    return hard.ok() ? hard.value() : planner::Profile::holding(states_[axis]);
}

void GroupMotion::step() noexcept {
    switch (course_) {
        case Course::Rest:
            return;
        case Course::Path:
            ++index_;
            stepPath(path_->feed.at(index_));
            if (index_ >= path_->feed.cycles()) arrive();
            return;
        case Course::BrakePath:
            stepPath(brake_.step());
            if (brake_.isAtRest()) rest();
            return;
        case Course::Direct:
            return stepDirect();
        case Course::BrakeDirect:
            return stepBrakeDirect();
    }
}

void GroupMotion::stepPath(const FeedState& next) noexcept {
    travelled_ += core::Distance{next.s - feed_.s};
    feed_ = next;
    std::array<planner::PathAxisState, MaxGroupAxes> states;
    planner::axesAt(path_->geometry, feed_, {states.data(), axes_});
    for (std::size_t i = 0; i < axes_; ++i) {
        states_[i] = {states[i].position, states[i].velocity, states[i].acceleration};
    }
}

/// The end of the path is exactly what was programmed, without the rounding of the way to it.
void GroupMotion::arrive() noexcept {
    const planner::PathGeometry& path = path_->geometry;
    const planner::PathPoint& end = path.element(path.elementCount() - 1).to;
    for (std::size_t i = 0; i < axes_; ++i) states_[i].position = end[i];
    rest();
}

void GroupMotion::stepDirect() noexcept {
    ++index_;
    direct_.sample(core::Seconds{static_cast<double>(index_) * cycle_}, states_);
    if (index_ < steps_) return;
    for (std::size_t i = 0; i < axes_; ++i) states_[i] = direct_[i].end();
    rest();
}

void GroupMotion::stepBrakeDirect() noexcept {
    ++index_;
    for (std::size_t i = 0; i < axes_; ++i) {
        states_[i] =
            planner::sample(stops_[i], core::Seconds{static_cast<double>(index_) * cycle_});
        if (index_ >= steps_) states_[i] = stops_[i].end();
    }
    if (index_ >= steps_) rest();
}

GroupPoint GroupMotion::positions() const noexcept {
    GroupPoint point{};
    for (std::size_t i = 0; i < axes_; ++i) point[i] = states_[i].position.count();
    return point;
}

}  // namespace takt::axis
