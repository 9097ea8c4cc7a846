#pragma once

#include <optional>
#include <takt/core/fixed_vector.hpp>
#include <takt/planner/profile.hpp>

namespace takt::planner {

/// The outermost positions of a profile, from its beginning to its end.
struct PositionExtremes {
    core::Position lowest;
    core::Position highest;
    core::Seconds atLowest;
    core::Seconds atHighest;
};

/// rt. Where a profile is farthest out, and when first.
[[nodiscard]] PositionExtremes extremesOf(const Profile& profile) noexcept;

/// rt. When a profile first is at `position`, counted from its beginning, not before `notBefore`;
/// nothing if it never is. The motion after the end, with the target's velocity and acceleration,
/// does not count.
[[nodiscard]] std::optional<core::Seconds> firstTimeAt(const Profile& profile,
                                                       core::Position position,
                                                       core::Seconds notBefore = {}) noexcept;

/// Durations from `from` to `to`, both included; the last interval has no end.
struct DurationInterval {
    core::Seconds from;
    core::Seconds to;
};
using DurationIntervals = core::FixedVector<DurationInterval, 4>;

/// rt. All durations in which a target can be reached: not every duration above the least one is
/// possible when start and target move.
[[nodiscard]] core::Result<DurationIntervals, PlanError> possibleDurations(
    const State& from, const Target& target, const Limits& limits) noexcept;

/// rt. A profile of exactly this duration. NoSolution where possibleDurations() does not contain
/// it.
[[nodiscard]] core::Result<Profile, PlanError> planLasting(const State& from, const Target& target,
                                                           const Limits& limits,
                                                           core::Seconds duration) noexcept;

}  // namespace takt::planner
