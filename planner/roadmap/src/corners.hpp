#pragma once

#include <takt/planner/roadmap/route.hpp>

#include "polyline.hpp"

namespace takt::planner::roadmap {

/// Finds how far each corner of a free polyline can be cut, up to `request.rounding`. Corners that
/// leave too little room are moved away from what they go around.
[[nodiscard]] std::vector<RoutePoint> roundCorners(Polyline line, const Obstacles& obstacles,
                                                   const RouteRequest& request);

}  // namespace takt::planner::roadmap
