#include "line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "profile_builder.hpp"

namespace takt::planner::detail {

namespace {

/// The vectors of a request that have to be parallel.
enum class Vector : std::uint8_t {
    Way,
    StartVelocity,
    StartAcceleration,
    TargetVelocity,
    TargetAcceleration,
};
constexpr std::array kVectors{Vector::Way, Vector::StartVelocity, Vector::StartAcceleration,
                              Vector::TargetVelocity, Vector::TargetAcceleration};

/// A component of a vector, and how far off it may be by rounding alone.
struct Component {
    double value;
    double grain;
};

Component wayOf(const AxisRequest& request) noexcept {
    if (request.target.kind == TargetKind::Velocity) return {0.0, 0.0};
    const State& to = request.target.state;
    return {(to.position - request.from.position).count(),
            positionGrain(request.from, to, request.limits)};
}

/// Velocities and accelerations of a motion go through all that the limits allow, and a sampled one
/// is as exact as that.
Component stateOf(double value, double range) noexcept {
    const double scale = std::isfinite(range) ? range : std::fabs(value);
    return {value, 16.0 * kEps * scale};
}

/// What a request of lower order does not look at is no obstacle.
Component componentOf(const AxisRequest& request, Vector vector) noexcept {
    if (vector == Vector::Way) return wayOf(request);
    const Limits& l = request.limits;
    const double velocities = (l.maxVelocity - l.minVelocity).count();
    const double accelerations = (l.maxAcceleration - l.minAcceleration).count();
    const bool third = std::isfinite(l.jerk.count());
    const bool second = third || std::isfinite(accelerations);
    const State& from = request.from;
    const State& to = request.target.state;
    switch (vector) {
        case Vector::Way:
            break;
        case Vector::StartVelocity:
            return stateOf(second ? from.velocity.count() : 0.0, velocities);
        case Vector::StartAcceleration:
            return stateOf(third ? from.acceleration.count() : 0.0, accelerations);
        case Vector::TargetVelocity:
            return stateOf(second ? to.velocity.count() : 0.0, velocities);
        case Vector::TargetAcceleration:
            return stateOf(third ? to.acceleration.count() : 0.0, accelerations);
    }
    return {0.0, 0.0};
}

/// How well a vector gives the direction of the line.
struct Direction {
    Vector vector{Vector::Way};
    std::size_t leader{0};
    double uncertainty{1.0};  ///< relative to the vector's length
};

Direction directionBy(std::span<const AxisRequest> requests, Vector vector) noexcept {
    Direction direction{vector, 0, 1.0};
    double longest = 0.0;
    double grain = 0.0;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (!requests[i].enabled) continue;
        const Component c = componentOf(requests[i], vector);
        grain = std::max(grain, c.grain);
        if (std::fabs(c.value) > longest) {
            longest = std::fabs(c.value);
            direction.leader = i;
        }
    }
    if (longest > grain) direction.uncertainty = grain / longest;
    return direction;
}

/// The way where it is long enough to be exact, else what is known best.
Direction bestDirection(std::span<const AxisRequest> requests) noexcept {
    Direction best = directionBy(requests, Vector::Way);
    if (best.uncertainty <= kClip) return best;
    for (const Vector vector : kVectors) {
        const Direction direction = directionBy(requests, vector);
        if (direction.uncertainty < best.uncertainty) best = direction;
    }
    return best;
}

bool parallel(std::span<const AxisRequest> requests, const Line& line, const Direction& direction,
              Vector vector) noexcept {
    const double scale = componentOf(requests[direction.leader], vector).value;
    const double relative = kClip + direction.uncertainty;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (!requests[i].enabled) continue;
        const Component c = componentOf(requests[i], vector);
        const double slack = std::fabs(scale) * relative + c.grain;
        if (!(std::fabs(c.value - scale * line.share[i]) <= slack)) return false;
    }
    return true;
}

/// The tightest limits along the line, in units of its leading axis.
Limits limitsAlong(std::span<const AxisRequest> requests, const Line& line) noexcept {
    const double inf = std::numeric_limits<double>::infinity();
    double vmax = inf;
    double vmin = -inf;
    double amax = inf;
    double amin = -inf;
    double jerk = inf;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const double e = line.share[i];
        if (!requests[i].enabled || e == 0.0) continue;
        const Limits& l = requests[i].limits;
        const bool same = e > 0.0;
        vmax = std::min(vmax, (same ? l.maxVelocity : l.minVelocity).count() / e);
        vmin = std::max(vmin, (same ? l.minVelocity : l.maxVelocity).count() / e);
        amax = std::min(amax, (same ? l.maxAcceleration : l.minAcceleration).count() / e);
        amin = std::max(amin, (same ? l.minAcceleration : l.maxAcceleration).count() / e);
        jerk = std::min(jerk, l.jerk.count() / std::fabs(e));
    }
    return {core::Velocity{vmax}, core::Velocity{vmin}, core::Acceleration{amax},
            core::Acceleration{amin}, core::Jerk{jerk}};
}

bool sameKind(std::span<const AxisRequest> requests, TargetKind kind) noexcept {
    return std::all_of(requests.begin(), requests.end(), [kind](const AxisRequest& request) {
        return !request.enabled || request.target.kind == kind;
    });
}

/// Where an axis is when the leading one has arrived.
State endOf(const AxisRequest& request, const Profile& leader, double share) noexcept {
    State end = request.target.state;
    end.acceleration = core::Acceleration{componentOf(request, Vector::TargetAcceleration).value};
    if (request.target.kind == TargetKind::State) return end;
    const core::Distance way =
        leader.size() == 0 ? core::Distance{} : leader.end().position - leader[0].from.position;
    end.position = request.from.position + way * share;
    return end;
}

}  // namespace

std::optional<Line> findLine(std::span<const AxisRequest> requests) noexcept {
    const Direction direction = bestDirection(requests);
    if (!(direction.uncertainty < 1.0)) return std::nullopt;
    Line line{requests[direction.leader], {}};
    if (!sameKind(requests, line.request.target.kind)) return std::nullopt;
    const double length = componentOf(line.request, direction.vector).value;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const double part = componentOf(requests[i], direction.vector).value;
        line.share[i] = requests[i].enabled ? part / length : 0.0;
    }
    for (const Vector vector : kVectors) {
        if (!parallel(requests, line, direction, vector)) return std::nullopt;
    }
    AxisRequest& leader = line.request;
    leader.from.acceleration =
        core::Acceleration{componentOf(leader, Vector::StartAcceleration).value};
    leader.target.state.acceleration =
        core::Acceleration{componentOf(leader, Vector::TargetAcceleration).value};
    leader.limits = limitsAlong(requests, line);
    return line;
}

bool planLine(Group& group, const Line& line, Profile& leader) noexcept {
    if (findFault(line.request.from, line.request.target, line.request.limits)) return false;
    AxisPlan& plan = group.line;
    plan.begin(line.request.from, line.request.target, line.request.limits,
               line.request.resolution);
    if (!(plan.duration() >= 0.0)) return false;
    return writeFirstFrom(plan, group.minDuration, group.cycle, leader);
}

void writeLine(const Group& group, const Line& line, const Profile& leader,
               std::span<Profile> out) noexcept {
    for (std::size_t i = 0; i < group.requests.size(); ++i) {
        const AxisRequest& request = group.requests[i];
        if (!request.enabled) {
            out[i] = Profile::holding(request.from);
            continue;
        }
        ProfileBuilder::scaled(leader, line.share[i], request.from,
                               endOf(request, leader, line.share[i]), out[i]);
    }
}

}  // namespace takt::planner::detail
