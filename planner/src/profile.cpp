#include <takt/planner/profile.hpp>

#include "brake.hpp"
#include "closing.hpp"
#include "duration.hpp"
#include "profile_builder.hpp"
#include "validation.hpp"
#include "velocity_problem.hpp"

namespace takt::planner {

namespace {

using detail::Pieces;
using detail::Problem;

Problem problemOf(const State& from, const State& to, const Limits& limits) noexcept {
    const double p0 = from.position.count();
    const double pf = to.position.count();
    return {from.velocity.count(),
            from.acceleration.count(),
            to.velocity.count(),
            to.acceleration.count(),
            pf - p0,
            limits.maxVelocity.count(),
            limits.minVelocity.count(),
            limits.maxAcceleration.count(),
            limits.minAcceleration.count(),
            limits.jerk.count(),
            8.0 * detail::kEps * (std::fabs(p0) + std::fabs(pf))};
}

Profile planVelocity(const State& from, const Target& target, const Limits& limits) noexcept {
    Problem problem = problemOf(from, target.state, limits);
    Pieces pieces;
    detail::brakeAcceleration(problem, pieces);
    detail::fastestVelocity(problem, pieces);
    Profile profile;
    ProfileBuilder::withJerks(from, pieces, profile);
    State end = profile.end();
    end.velocity = target.state.velocity;
    end.acceleration = target.state.acceleration;
    ProfileBuilder::closeOn(end, profile);
    return profile;
}

}  // namespace

core::Result<Profile, PlanError> plan(const State& from, const Target& target,
                                      const Limits& limits) noexcept {
    if (const auto error = detail::findError(from, target, limits)) return *error;
    if (target.kind == TargetKind::Velocity) return planVelocity(from, target, limits);
    const Problem whole = problemOf(from, target.state, limits);
    Problem problem = whole;
    Pieces pieces;
    detail::brakePosition(problem, pieces);
    const detail::Possible answer = detail::fastest(problem);
    if (!answer.found) return PlanError::NoSolution;
    detail::piecesOf(problem, answer, pieces);
    Profile profile;
    if (detail::closeOnTarget(whole, pieces)) {
        ProfileBuilder::withJerksExactly(from, pieces, profile);
    } else {
        ProfileBuilder::withJerks(from, pieces, profile);
    }
    ProfileBuilder::closeOn(target.state, profile);
    return profile;
}

core::Result<Profile, PlanError> planStop(const State& from, const Limits& limits) noexcept {
    return plan(from, {TargetKind::Velocity, {from.position, {}, {}}}, limits);
}

}  // namespace takt::planner
