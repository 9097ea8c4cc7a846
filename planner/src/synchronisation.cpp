#include "synchronisation.hpp"

#include <cmath>

#include "profile_builder.hpp"

namespace takt::planner::detail {

namespace {

/// Two gaps an axis and some for rounding.
constexpr int kMostDurations = 64;

/// The next whole number of cycles; what is a whole number but for rounding stays.
double roundedUp(double duration, double cycle) noexcept {
    if (!(cycle > 0.0)) return duration;
    return cycle * std::ceil(duration / cycle * (1.0 - kClip));
}

bool atRest(const AxisRequest& request) noexcept {
    return request.target.kind == TargetKind::State &&
           request.target.state.velocity.count() == 0.0 &&
           request.target.state.acceleration.count() == 0.0;
}

/// The least duration from `atLeast` on of one axis.
double leastOf(const Group& group, std::size_t axis, double atLeast) noexcept {
    double duration = roundedUp(std::max(atLeast, group.plans[axis].duration()), group.cycle);
    for (int i = 0; i < kMostDurations; ++i) {
        const double next = roundedUp(group.plans[axis].firstPossible(duration), group.cycle);
        if (next <= duration) break;
        duration = next;
    }
    return duration;
}

/// Writes the profile of an axis for a duration that leastOf() has found.
bool writeOne(const Group& group, std::size_t axis, double duration, Profile& out) noexcept {
    return group.plans[axis].writeLasting(duration, out);
}

}  // namespace

double writeEach(const Group& group, std::span<Profile> out) noexcept {
    double longest = 0.0;
    for (std::size_t i = 0; i < group.requests.size(); ++i) {
        if (!group.requests[i].enabled) {
            out[i] = Profile::holding(group.requests[i].from);
            continue;
        }
        const double least = std::max(group.minDuration, group.plans[i].duration());
        const double rounded = roundedUp(least, group.cycle);
        double duration = rounded;
        if (!writeOne(group, i, duration, out[i])) {
            duration = leastOf(group, i, rounded);
            if (!writeOne(group, i, duration, out[i])) group.plans[i].writeFastest(out[i]);
        }
        longest = std::max(longest, out[i].duration().count());
    }
    return longest;
}

std::optional<double> writeTogether(const Group& group, double atLeast, bool ifNecessary,
                                    std::span<Profile> out) noexcept {
    double duration = atLeast;
    const std::size_t axes = group.requests.size();
    for (std::size_t i = 0; i < axes; ++i) {
        if (group.requests[i].enabled) duration = std::max(duration, group.plans[i].duration());
    }
    duration = roundedUp(duration, group.cycle);
    for (int attempt = 0; attempt < kMostDurations; ++attempt) {
        double next = duration;
        for (std::size_t i = 0; i < axes && next <= duration; ++i) {
            const AxisRequest& request = group.requests[i];
            if (!request.enabled) {
                out[i] = Profile::holding(request.from);
            } else if (ifNecessary && atRest(request)) {
                group.plans[i].writeFastest(out[i]);
            } else if (!writeOne(group, i, duration, out[i])) {
                next = roundedUp(group.plans[i].firstPossible(duration), group.cycle);
                if (!(next > duration)) next = roundedUp(duration * (1.0 + kClip), group.cycle);
                if (!(next > duration)) next = duration + group.cycle;
            }
        }
        if (next <= duration) return duration;
        duration = next;
    }
    return std::nullopt;
}

namespace {

/// The four vectors of a request that have to be parallel besides the distances.
double component(const AxisRequest& request, int which) noexcept {
    switch (which) {
        case 0:
            return request.from.velocity.count();
        case 1:
            return request.from.acceleration.count();
        case 2:
            return request.target.state.velocity.count();
        default:
            return request.target.state.acceleration.count();
    }
}

double distanceOf(const AxisRequest& request) noexcept {
    return (request.target.state.position - request.from.position).count();
}

/// What rounding of the positions may do to a distance, relative to the longest one.
double roundingOf(const AxisRequest& request, double longest) noexcept {
    const double sum =
        std::fabs(request.target.state.position.count()) + std::fabs(request.from.position.count());
    return kClip + 4.0 * kEps * sum / longest;
}

bool parallel(std::span<const AxisRequest> requests, const Line& line, std::size_t leader,
              double longest) noexcept {
    for (int which = 0; which < 4; ++which) {
        const double scale = component(requests[leader], which) / line.share[leader];
        for (std::size_t i = 0; i < requests.size(); ++i) {
            if (!requests[i].enabled) continue;
            const double expected = scale * line.share[i];
            const double got = component(requests[i], which);
            const double slack = std::fabs(scale) * roundingOf(requests[i], longest);
            if (!(std::fabs(got - expected) <= slack)) return false;
        }
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

}  // namespace

std::optional<Line> findLine(std::span<const AxisRequest> requests) noexcept {
    std::size_t leader = requests.size();
    double longest = 0.0;
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (!requests[i].enabled) continue;
        if (requests[i].target.kind != TargetKind::State) return std::nullopt;
        const double distance = std::fabs(distanceOf(requests[i]));
        if (distance > longest) {
            longest = distance;
            leader = i;
        }
    }
    if (leader == requests.size()) return std::nullopt;
    Line line{requests[leader], {}};
    const double way = distanceOf(requests[leader]);
    for (std::size_t i = 0; i < requests.size(); ++i) {
        line.share[i] = requests[i].enabled ? distanceOf(requests[i]) / way : 0.0;
    }
    if (!parallel(requests, line, leader, longest)) return std::nullopt;
    line.request.limits = limitsAlong(requests, line);
    return line;
}

std::optional<double> writeLine(Group& group, const Line& line, double atMost,
                                std::span<Profile> out) noexcept {
    if (findFault(line.request.from, line.request.target, line.request.limits)) return std::nullopt;
    AxisPlan& plan = group.line;
    plan.begin(line.request.from, line.request.target, line.request.limits,
               line.request.resolution);
    if (!(plan.duration() >= 0.0)) return std::nullopt;
    double least = group.minDuration;
    for (std::size_t i = 0; i < group.requests.size(); ++i) {
        if (group.requests[i].enabled) least = std::max(least, group.plans[i].duration());
    }
    // A straight line that takes longer than the slowest axis by no more than rounding is as fast.
    const double limit = std::max(atMost, roundedUp(least * (1.0 + 1e-9), group.cycle));
    double duration = roundedUp(std::max(group.minDuration, plan.duration()), group.cycle);
    Profile leader;
    for (int i = 0; i < kMostDurations && !plan.writeLasting(duration, leader); ++i) {
        const double next = roundedUp(plan.firstPossible(duration), group.cycle);
        duration = next > duration ? next : duration * (1.0 + kClip) + group.cycle;
    }
    if (leader.end().position != line.request.target.state.position) return std::nullopt;
    if (!(duration <= limit)) return std::nullopt;
    for (std::size_t i = 0; i < group.requests.size(); ++i) {
        const AxisRequest& request = group.requests[i];
        if (!request.enabled) {
            out[i] = Profile::holding(request.from);
            continue;
        }
        ProfileBuilder::scaled(leader, line.share[i], request.from, request.target.state, out[i]);
    }
    return duration;
}

}  // namespace takt::planner::detail
