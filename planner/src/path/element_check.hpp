#pragma once

#include <optional>
#include <takt/planner/path_element.hpp>

namespace takt::planner::detail {

/// What is wrong with the space or the ends of an element, or nothing.
[[nodiscard]] std::optional<PathError> checkPoints(const PathSpace& space, const PathPoint& from,
                                                   const PathPoint& to) noexcept;

}  // namespace takt::planner::detail
