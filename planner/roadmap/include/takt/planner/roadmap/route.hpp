#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/core/units.hpp>
#include <takt/planner/roadmap/obstacles.hpp>
#include <vector>

namespace takt::planner::roadmap {

/// One axis of a route.
struct RouteAxis {
    core::Position low;  ///< its soft limits: below `high`, both finite
    core::Position high;
    core::Velocity velocity;  ///< the fastest it goes; above 0
};

/// How hard to look. Counted, never timed: the same numbers on every machine.
struct RouteEffort {
    std::uint32_t iterations{20000};  ///< of the tree search, over all attempts
    std::uint32_t attempts{12};  ///< searches with numbers of their own; the shortest result counts
    std::uint32_t shortcuts{150};  ///< tried on the result of each attempt
};

struct RouteRequest {
    Point start;  ///< one position for each axis
    Point goal;
    std::span<const RouteAxis> axes;  ///< 1 to Obstacles::MaxAxes
    /// The first so many axes are those whose motion counts as length of the path.
    std::size_t pathAxes{3};
    /// Corners are cut so far before and after them where there is room, in path length; 0 or more.
    core::Distance rounding{};
    std::uint64_t seed{1};
    RouteEffort effort{};
};

enum class RouteFault : std::uint8_t {
    None,
    BadRequest,          ///< numbers of axes differ, or a number is not finite or out of its range
    StartOutsideLimits,  ///< `which`: axis
    GoalOutsideLimits,   ///< `which`: axis
    StartInKeepOut,      ///< `which`: keep-out
    GoalInKeepOut,       ///< `which`: keep-out
    NoRoute,             ///< none found within the iterations allowed
};

struct RoutePoint {
    std::vector<double> position;
    /// The path may leave its straight lines so far before and after this point, in path length:
    /// the triangle between is free. 0 at both ends, and where there is no room: a stop there.
    core::Distance corner{};
};

struct RouteAnswer {
    RouteFault fault{RouteFault::None};
    std::size_t which{0};            ///< what a fault is about: number of an axis or keep-out
    std::vector<RoutePoint> points;  ///< start and goal included; empty with a fault
    core::Seconds length{};          ///< of the corners' polygon, each axis divided by its velocity
    std::uint32_t iterations{0};     ///< used by the tree search

    [[nodiscard]] bool ok() const noexcept { return fault == RouteFault::None; }
};

/// Looks for a way around the keep-outs, from rest to rest. The way is near the shortest where each
/// axis is measured by the time it needs at full speed. All lines and corner triangles of the
/// answer are free, exactly, not at samples.
///
/// The answer depends on the request only, not on the process, the machine or earlier calls. Not
/// for the cycle: it allocates and takes milliseconds.
[[nodiscard]] RouteAnswer planRoute(const RouteRequest& request, const Obstacles& obstacles);

}  // namespace takt::planner::roadmap
