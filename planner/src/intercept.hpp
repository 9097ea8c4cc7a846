#pragma once

#include <takt/planner/profile.hpp>

namespace takt::planner::detail {

/// The fastest way to a target that keeps its velocity, within the limits: seen from it, that is a
/// move to rest. NotFinite, InvalidLimits as plan(); InvalidLimits too if the target is not inside
/// the velocity limits.
[[nodiscard]] core::Result<Profile, PlanError> interceptUniform(const State& from,
                                                                const State& target,
                                                                const Limits& limits) noexcept;

/// The fastest way to a target that keeps its acceleration until that would take it out of the
/// velocity limits. NoSolution if it is not caught up with in some million times `shortest`.
/// \param shortest duration of interest; positive
[[nodiscard]] core::Result<Profile, PlanError> interceptAccelerated(const State& from,
                                                                    const State& target,
                                                                    const Limits& limits,
                                                                    double shortest) noexcept;

}  // namespace takt::planner::detail
