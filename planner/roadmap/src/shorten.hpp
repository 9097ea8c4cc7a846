#pragma once

#include <cstdint>
#include <takt/core/random.hpp>

#include "polyline.hpp"

namespace takt::planner::roadmap {

/// Makes a free polyline shorter: leaves out points, and joins points drawn at random where the
/// straight line between them is free. It stays free, its ends stay.
/// \param tries how many joints are drawn
void shorten(Polyline& line, const Obstacles& obstacles, const Metric& metric, core::Random& random,
             std::uint32_t tries);

/// Joins neighbouring corners into one where their outer legs, made longer, meet: fewer corners
/// with longer legs are passed faster. The line stays free, within the bounds and below `most` in
/// length.
void mergeCorners(Polyline& line, const Obstacles& obstacles, const Metric& metric, Point low,
                  Point high, double most);

}  // namespace takt::planner::roadmap
