#include <takt/planner/profile.hpp>

#include "axis_plan.hpp"

namespace takt::planner {

core::Result<Profile, PlanError> plan(const State& from, const Target& target,
                                      const Limits& limits) noexcept {
    if (const auto fault = findFault(from, target, limits)) return fault->error;
    detail::AxisPlan axis;
    axis.begin(from, target, limits, {});
    if (!(axis.duration() >= 0.0)) return PlanError::NoSolution;
    Profile profile;
    axis.writeFastest(profile);
    return profile;
}

core::Result<Profile, PlanError> planStop(const State& from, const Limits& limits) noexcept {
    return plan(from, {TargetKind::Velocity, {from.position, {}, {}}}, limits);
}

}  // namespace takt::planner
