#pragma once

#include "duration.hpp"

namespace takt::planner::detail {

/// The fastest change of velocity and acceleration; position and its limits play no part.
/// \return its duration
double fastestVelocity(const Problem& problem, Pieces& out) noexcept;

/// The least possible duration of the velocity problem that is not below `notBefore`.
[[nodiscard]] double firstPossibleVelocity(const Problem& problem, double notBefore) noexcept;

/// Durations at which the problem may begin or cease to be possible.
void velocityMarks(const Problem& problem, Marks& out) noexcept;

/// A change of velocity that takes exactly `duration`; false if that is not possible.
[[nodiscard]] bool velocityLasting(const Problem& problem, double duration, Pieces& out) noexcept;

}  // namespace takt::planner::detail
