#pragma once

#include <array>
#include <optional>
#include <span>

#include "synchronisation.hpp"

namespace takt::planner::detail {

/// The one-axis problem along the straight line on which all states lie, if they do: the request of
/// the axis with the greatest share, with the limits of all, and every axis' share.
struct Line {
    AxisRequest request;
    std::array<double, Trajectory::maxAxes> share;
};

/// Ways, velocities and accelerations of all enabled axes are multiples of one vector, but for
/// their rounding. Nothing where they are not, or where nothing moves.
[[nodiscard]] std::optional<Line> findLine(std::span<const AxisRequest> requests) noexcept;

/// The fastest motion of the leading axis along the line, in whole cycles and not below the minimum
/// duration. \return false if there is none
[[nodiscard]] bool planLine(Group& group, const Line& line, Profile& leader) noexcept;

/// The motion of every axis that belongs to that of the leading one.
void writeLine(const Group& group, const Line& line, const Profile& leader,
               std::span<Profile> out) noexcept;

}  // namespace takt::planner::detail
