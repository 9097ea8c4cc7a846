#pragma once

#include "duration.hpp"

/// Motion without a jerk limit: pieces of constant acceleration. The accelerations of start and
/// target are ignored. The same two curves of extremal profiles as in third order, all in closed
/// form.
namespace takt::planner::detail {

/// Brings a velocity outside the limits back at full deceleration.
void brakeSecondOrder(Problem& problem, Pieces& out) noexcept;

/// The fastest way to the target. \pre the start is viable (brakeSecondOrder)
double fastestSecondOrder(const Problem& problem, Pieces& out) noexcept;

/// The least possible duration >= notBefore.
[[nodiscard]] double firstPossibleSecondOrder(const Problem& problem, double notBefore) noexcept;

/// Durations at which the target may begin or cease to be possible.
void secondOrderMarks(const Problem& problem, Marks& out) noexcept;

/// A profile that takes exactly `duration`; false if that is not possible.
[[nodiscard]] bool lastingSecondOrder(const Problem& problem, double duration,
                                      Pieces& out) noexcept;

}  // namespace takt::planner::detail
