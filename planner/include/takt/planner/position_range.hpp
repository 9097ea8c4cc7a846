#pragma once

#include <takt/planner/profile.hpp>

namespace takt::planner {

/// Positions that may not be left on the way, both ends included.
struct PositionRange {
    core::Position lowest;
    core::Position highest;
};

/// rt. A fast motion to a State target that never leaves the range: the fastest one if that stays
/// inside, else the fastest that does with lower velocity limits, else by way of a stop. \return
/// OutOfRange where start or target lie outside, where the axis cannot even stop inside, or where
///         the target's velocity needs a longer run-up than there is
[[nodiscard]] core::Result<Profile, PlanError> planWithin(const State& from, const Target& target,
                                                          const Limits& limits,
                                                          const PositionRange& range) noexcept;

}  // namespace takt::planner
