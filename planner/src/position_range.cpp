#include <cmath>
#include <optional>
#include <takt/planner/position_range.hpp>
#include <takt/planner/profile_query.hpp>

#include "profile_builder.hpp"

namespace takt::planner {

namespace {

constexpr int kVelocitySteps = 24;

bool isInside(core::Position p, const PositionRange& range) noexcept {
    const double slack =
        8.0 * detail::kEps * (std::fabs(range.lowest.count()) + std::fabs(range.highest.count()));
    return p.count() >= range.lowest.count() - slack && p.count() <= range.highest.count() + slack;
}

bool isInside(const Profile& profile, const PositionRange& range) noexcept {
    const PositionExtremes extremes = extremesOf(profile);
    return isInside(extremes.lowest, range) && isInside(extremes.highest, range);
}

std::optional<Profile> fastestInside(const State& from, const Target& target, const Limits& limits,
                                     const PositionRange& range) noexcept {
    const auto result = plan(from, target, limits);
    if (!result.ok() || !isInside(result.value(), range)) return std::nullopt;
    return result.value();
}

/// The target must stay viable, and the start must not be braked harder than needed.
Limits slower(const Limits& limits, const State& from, const State& to, double factor) noexcept {
    const auto reach = [&](const State& s, double sign) {
        const double a = s.acceleration.count();
        const double v = s.velocity.count() * sign;
        return v + 0.5 * a * a / limits.jerk.count();
    };
    Limits l = limits;
    const double up =
        std::max({limits.maxVelocity.count() * factor, reach(from, 1.0), reach(to, 1.0)});
    const double down =
        std::max({-limits.minVelocity.count() * factor, reach(from, -1.0), reach(to, -1.0)});
    l.maxVelocity = std::min(limits.maxVelocity, core::Velocity{up});
    l.minVelocity = std::max(limits.minVelocity, core::Velocity{-down});
    return l;
}

void keepFaster(std::optional<Profile>& best, const std::optional<Profile>& other) noexcept {
    if (other && (!best || other->duration() < best->duration())) best = other;
}

}  // namespace

core::Result<Profile, PlanError> planWithin(const State& from, const Target& target,
                                            const Limits& limits,
                                            const PositionRange& range) noexcept {
    if (std::isnan(range.lowest.count()) || std::isnan(range.highest.count())) {
        return PlanError::NotFinite;
    }
    const auto direct = plan(from, target, limits);
    if (!direct.ok() || isInside(direct.value(), range)) return direct;
    if (!isInside(from.position, range)) return PlanError::OutOfRange;
    if (target.kind == TargetKind::State && !isInside(target.state.position, range)) {
        return PlanError::OutOfRange;
    }
    std::optional<Profile> best;
    for (int i = 1; i < kVelocitySteps; ++i) {
        const double factor = 1.0 - static_cast<double>(i) / kVelocitySteps;
        keepFaster(best,
                   fastestInside(from, target, slower(limits, from, target.state, factor), range));
    }
    const auto stop = planStop(from, limits);
    if (stop.ok() && isInside(stop.value(), range)) {
        const auto onward = fastestInside(stop.value().end(), target, limits, range);
        Profile both;
        if (onward && ProfileBuilder::joined(stop.value(), *onward, both)) keepFaster(best, both);
    }
    if (!best) return PlanError::OutOfRange;
    return *best;
}

}  // namespace takt::planner
