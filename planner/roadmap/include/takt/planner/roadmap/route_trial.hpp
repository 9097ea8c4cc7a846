#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/core/units.hpp>
#include <takt/planner/path_planner.hpp>
#include <takt/planner/roadmap/route.hpp>
#include <vector>

namespace takt::planner::roadmap {

/// The route as path elements, each a straight line that rounds the corner at its end as far as the
/// route allows. Points that coincide make no element.
/// \param feed limits along the path
/// \pre route.ok()
[[nodiscard]] std::vector<PathElement> elementsOf(const RouteAnswer& route, const PathSpace& space,
                                                  const PathFeed& feed);

/// What a route is tried with: a whole motion, from rest to rest.
struct TrialRequest {
    PathSpace space{};
    std::span<const PathAxisLimits> limits;  ///< one for each axis
    PathFeed feed{};
    core::Seconds cycle{1e-3};
};

enum class TrialFault : std::uint8_t {
    None,
    NoMotion,   ///< no motion along it keeps the limits
    Collision,  ///< a position of the motion lies in a keep-out
};

struct TrialResult {
    TrialFault fault{TrialFault::None};
    std::size_t keepOut{0};  ///< with Collision: which one
    core::Seconds duration{};
};

/// Plans the motion along a route and looks at its position in every cycle: the last look before a
/// route is handed out. A route that has no length takes no time.
/// \pre route.ok()
[[nodiscard]] TrialResult tryRoute(const RouteAnswer& route, const TrialRequest& request,
                                   const Obstacles& obstacles);

}  // namespace takt::planner::roadmap
