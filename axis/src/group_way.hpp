#pragma once

#include <takt/axis/group_command.hpp>
#include <takt/planner/path_element.hpp>

namespace takt::axis {

/// rt. The axes of a group as a path sees them.
[[nodiscard]] planner::PathSpace pathSpace(std::size_t axes) noexcept;
[[nodiscard]] planner::PathPoint pathPoint(const GroupPoint& point) noexcept;

/// rt. The geometry of a resolved linear or circular motion, without feed and transition.
[[nodiscard]] planner::PathElementResult elementOf(const GroupCommand& command,
                                                   const GroupPoint& from,
                                                   std::size_t axes) noexcept;

/// rt. What a block answers where there is no such geometry.
[[nodiscard]] ErrorId errorOf(planner::PathError error) noexcept;

}  // namespace takt::axis
