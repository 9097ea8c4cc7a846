#pragma once

#include <optional>
#include <takt/planner/profile.hpp>

namespace takt::planner::detail {

/// What is wrong with a request, if anything.
[[nodiscard]] std::optional<PlanError> findError(const State& from, const Target& target,
                                                 const Limits& limits) noexcept;

}  // namespace takt::planner::detail
