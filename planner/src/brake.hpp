#pragma once

#include "problem.hpp"

namespace takt::planner::detail {

/// At most two pieces that bring a start state which is outside the limits, or bound to leave them,
/// back inside as fast as the jerk allows; `problem` then begins where they end.
void brakePosition(Problem& problem, Pieces& out) noexcept;

/// The same where velocity is not limited: only the acceleration is brought back.
void brakeAcceleration(Problem& problem, Pieces& out) noexcept;

}  // namespace takt::planner::detail
