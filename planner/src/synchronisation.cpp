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

/// The next duration to be tried where one was not possible.
double following(const AxisPlan& plan, double duration, double cycle) noexcept {
    const double next = roundedUp(plan.firstPossible(duration), cycle);
    if (next > duration) return next;
    const double later = roundedUp(duration * (1.0 + kClip), cycle);
    return later > duration ? later : duration + cycle;
}

}  // namespace

bool writeFirstFrom(const AxisPlan& plan, double atLeast, double cycle, Profile& out) noexcept {
    double duration = roundedUp(std::max(atLeast, plan.duration()), cycle);
    for (int attempt = 0; attempt < kMostDurations; ++attempt) {
        if (plan.writeLasting(duration, out)) return true;
        duration = following(plan, duration, cycle);
    }
    return false;
}

double slowest(const Group& group) noexcept {
    double least = group.minDuration;
    for (std::size_t i = 0; i < group.requests.size(); ++i) {
        if (group.requests[i].enabled) least = std::max(least, group.plans[i].duration());
    }
    return roundedUp(least, group.cycle);
}

namespace {

/// The profile of an axis that need not wait for others.
void writeOwn(const Group& group, std::size_t axis, double atLeast, Profile& out) noexcept {
    const AxisPlan& plan = group.plans[axis];
    if (!writeFirstFrom(plan, atLeast, group.cycle, out)) plan.writeFastest(out);
}

}  // namespace

double writeEach(const Group& group, std::span<Profile> out) noexcept {
    double longest = 0.0;
    for (std::size_t i = 0; i < group.requests.size(); ++i) {
        if (!group.requests[i].enabled) {
            out[i] = Profile::holding(group.requests[i].from);
            continue;
        }
        writeOwn(group, i, group.minDuration, out[i]);
        longest = std::max(longest, out[i].duration().count());
    }
    return longest;
}

std::optional<double> writeTogether(const Group& group, bool ifNecessary,
                                    std::span<Profile> out) noexcept {
    double duration = slowest(group);
    const std::size_t axes = group.requests.size();
    for (int attempt = 0; attempt < kMostDurations; ++attempt) {
        double next = duration;
        for (std::size_t i = 0; i < axes && next <= duration; ++i) {
            const AxisRequest& request = group.requests[i];
            if (!request.enabled) {
                out[i] = Profile::holding(request.from);
            } else if (ifNecessary && atRest(request)) {
                writeOwn(group, i, 0.0, out[i]);
            } else if (!group.plans[i].writeLasting(duration, out[i])) {
                next = following(group.plans[i], duration, group.cycle);
            }
        }
        if (next <= duration) return duration;
        duration = next;
    }
    return std::nullopt;
}

}  // namespace takt::planner::detail
