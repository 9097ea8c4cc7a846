#pragma once

#include "problem.hpp"

namespace takt::planner::detail {

/// Closes a profile on the position of its target where rounding alone would miss it. An
/// acceleration of one ulp that is left over at the beginning of a long piece of constant velocity
/// adds up: a piece of that acceleration over the jerk, some 1e-20 s, takes it away. What is then
/// left is made up by the length of the long piece. `problem` is the one before any braking.
/// \return true if the pieces are of that kind: they have to be summed up as DoubleDouble
bool closeOnTarget(const Problem& problem, Pieces& pieces) noexcept;

}  // namespace takt::planner::detail
