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

/// The profile of an axis with the first possible duration from `atLeast` on, in whole cycles.
/// False if there is none.
[[nodiscard]] bool writeFirstFrom(const AxisPlan& plan, double atLeast, double cycle,
                                  Profile& out) noexcept;

/// What the slowest axis takes at least, in whole cycles.
[[nodiscard]] double slowest(const Group& group) noexcept;

/// Every axis for itself. \return the longest duration
double writeEach(const Group& group, std::span<Profile> out) noexcept;

/// All axes in the same duration, the first that is possible for all. \param ifNecessary axes with
/// targets at rest keep their own duration
std::optional<double> writeTogether(const Group& group, bool ifNecessary,
                                    std::span<Profile> out) noexcept;

}  // namespace takt::planner::detail
