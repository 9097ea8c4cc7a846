#pragma once

#include <optional>

#include "scenes.hpp"

namespace takt::planner::roadmap::test {

/// Length (time at full speed) of a way over a grid of the scene, or nothing when the grid has
/// none.
///
/// Independent of the planner: A* over the neighbours of each cell, points and edges judged by
/// depth() at samples. Steps to 8 (26) neighbours are up to 8.3 % (12.9 %) longer than the straight
/// line, so the way found is then pulled straight; what is left is that the grid may have preferred
/// the other side of an obstacle whose two ways differ by less than that, and half a cell beside
/// each corner.
std::optional<double> gridLength(const Scene& scene, double cell);

}  // namespace takt::planner::roadmap::test
