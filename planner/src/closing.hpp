#pragma once

#include "problem.hpp"

namespace takt::planner::detail {

/// Closes a profile on the position of its target where rounding alone would miss it. An
/// acceleration of one ulp that is left over at the beginning of a long piece of constant velocity
/// adds up; the length of that piece is put right by as much. `problem` is the one before any
/// braking.
bool closeOnTarget(const Problem& problem, Pieces& pieces) noexcept;

}  // namespace takt::planner::detail
