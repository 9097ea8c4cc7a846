#pragma once

#include <cstdint>
#include <optional>
#include <takt/axis/axis_view.hpp>
#include <takt/axis/command.hpp>
#include <takt/core/time.hpp>
#include <takt/planner/profile.hpp>

namespace takt::axis {

/// The trajectory of one axis: plans a command from the present set state and steps it cycle by
/// cycle.
///
///     motion.begin(command);                      // plans, changes nothing that has been sent
///     each cycle: state = motion.next(); … ; motion.accept(state);
///
/// A profile of duration D takes ceil(D / T) steps; the last one is the target exactly.
class Motion {
public:
    Motion(const AxisTraits& traits, core::Duration cycle) noexcept;

    /// rt. Stands at `position`, whatever was before.
    void hold(core::Position position) noexcept;

    /// rt. Plans a Halt, Stop or move from the present set state.
    /// \return None; or why there is no such motion, and the running one goes on:
    ///   TargetOutsideSWLimit, LimitExceeded  the target (of a relative move) is outside
    ///   SWLimitReached      the command's deceleration does not stop before a software limit
    ///   ProfileNotFeasible  the planner has no answer
    [[nodiscard]] ErrorId begin(const Command& command) noexcept;

    /// rt. Plans the shortest stop with the axis' stop dynamics. \return false when there is none
    [[nodiscard]] bool beginStop() noexcept;

    /// rt. The set state of the next cycle. A velocity move that would pass a software limit turns
    /// into a stop at it here, see limitHit().
    [[nodiscard]] planner::State next() noexcept;
    /// rt. `state` has become the set state.
    void accept(const planner::State& state) noexcept;
    /// rt. A state from outside the profile, for the emergency ramp; at rest when it does not move.
    void force(core::Position position, core::Velocity velocity) noexcept;

    /// rt. A state from the axis' group; never at rest before hold() or a plan of its own.
    void lead(const planner::State& state) noexcept;

    [[nodiscard]] const planner::State& set() const noexcept { return set_; }
    /// The last step of the profile has been made.
    [[nodiscard]] bool finished() const noexcept { return step_ >= steps_; }
    /// Stands, with nothing left to do.
    [[nodiscard]] bool resting() const noexcept { return resting_; }
    /// The velocity move was turned into a stop at a software limit.
    [[nodiscard]] bool limitHit() const noexcept { return limitHit_; }
    /// Where the last position move goes, or where the last stop ended.
    [[nodiscard]] core::Position target() const noexcept { return target_; }
    [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }

private:
    friend struct AxisTestAccess;

    /// Where the shortest stop ends, and how far out it goes before.
    struct Stop {
        core::Position end;
        core::Position lowest;
        core::Position highest;
    };

    [[nodiscard]] bool turnsOnTheWay(const Dynamics& dynamics, double wanted,
                                     std::optional<core::Position> target) const noexcept;
    [[nodiscard]] ErrorId beginPosition(core::Position target, const Dynamics& dynamics) noexcept;
    [[nodiscard]] ErrorId beginVelocity(const Dynamics& dynamics) noexcept;
    [[nodiscard]] ErrorId beginBraking(const Dynamics& dynamics) noexcept;
    [[nodiscard]] core::Position moduloTarget(const Command& command,
                                              const Dynamics& dynamics) noexcept;
    [[nodiscard]] Dynamics holdingVelocity(const Dynamics& dynamics) const noexcept;
    [[nodiscard]] std::optional<Stop> stopFrom(const planner::State& from,
                                               const Dynamics& dynamics) const noexcept;
    /// The profile passes a software limit, and goes farther out than the axis is.
    [[nodiscard]] bool leavesUpward(const planner::Profile& profile) const noexcept;
    [[nodiscard]] bool leavesDownward(const planner::Profile& profile) const noexcept;
    void guardVelocity(const Dynamics& dynamics) noexcept;
    [[nodiscard]] bool passesGuard(const planner::State& state) const noexcept;
    void turnToLimit() noexcept;
    void run(const planner::Profile& profile) noexcept;
    [[nodiscard]] planner::State stateAt(std::uint64_t step) const noexcept;
    [[nodiscard]] planner::Limits braking(const Dynamics& dynamics) const noexcept;
    [[nodiscard]] planner::Limits moving(const Dynamics& dynamics, bool forward,
                                         bool turns) const noexcept;
    [[nodiscard]] bool underWay() const noexcept {
        return set_.velocity != core::Velocity{} || set_.acceleration != core::Acceleration{};
    }

    const AxisTraits* traits_;
    double cycle_;  ///< seconds
    planner::State set_{};
    planner::Profile profile_{};
    std::uint64_t step_{0};
    std::uint64_t steps_{0};
    core::Position target_{};
    bool resting_{true};
    bool endsAtRest_{true};
    bool backward_{false};  ///< direction of the present or last motion
    bool limitHit_{false};
    // Watch on a software limit during a velocity move.
    bool guarded_{false};
    bool guardEarly_{false};  ///< the limit comes before the velocity is reached
    core::Position guard_{};
    core::Distance stopDistance_{};  ///< from the commanded velocity to rest
    Dynamics guardDynamics_{};
};

}  // namespace takt::axis
