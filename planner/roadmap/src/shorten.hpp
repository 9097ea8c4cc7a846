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

}  // namespace takt::planner::roadmap
