#pragma once

#include <array>
#include <optional>
#include <span>
#include <takt/planner/trajectory.hpp>

#include "axis_plan.hpp"

namespace takt::planner::detail {

/// The plans of all axes of a request.
struct Group {
    std::span<const AxisRequest> requests;
    std::array<AxisPlan, Trajectory::maxAxes> plans;
    double cycle{0.0};
    double minDuration{0.0};
    AxisPlan line;
};

/// Every axis for itself. \return the longest duration
double writeEach(const Group& group, std::span<Profile> out) noexcept;

/// All axes in the same duration, the first from `atLeast` on that is possible for all. \param
/// ifNecessary axes with targets at rest keep their own duration
std::optional<double> writeTogether(const Group& group, double atLeast, bool ifNecessary,
                                    std::span<Profile> out) noexcept;

/// The one-axis problem along the straight line on which all states lie, if they do: the request of
/// the axis that goes farthest, with the limits of all, and the share of each axis in its way.
struct Line {
    AxisRequest request;
    std::array<double, Trajectory::maxAxes> share;
};
[[nodiscard]] std::optional<Line> findLine(std::span<const AxisRequest> requests) noexcept;

/// \return the duration, or nothing if it is not possible within `atMost`
std::optional<double> writeLine(Group& group, const Line& line, double atMost,
                                std::span<Profile> out) noexcept;

}  // namespace takt::planner::detail
