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

    /// rt. Where the command goes if it begins now. \pre isPositioning(command.kind)
    [[nodiscard]] core::Position goalOf(const Command& command) const noexcept;

    /// rt. Plans a Halt, Stop or move from the present set state.
    /// \param joint the speed at which a move to a position passes its end, see atJoint(); as much
    ///        of it as can be reached
    /// \return None; or why there is no such motion, and the running one goes on:
    ///   TargetOutsideSWLimit, LimitExceeded  the target (of a relative move) is outside
    ///   SWLimitReached      the command's deceleration does not stop before a software limit
    ///   ProfileNotFeasible  the planner has no answer; an end velocity needs a longer run-up
    [[nodiscard]] ErrorId begin(const Command& command, core::Velocity joint = {}) noexcept;

    /// rt. Plans the running move to a position anew, so that it passes its end at `joint`. Where
    /// that cannot be had the motion goes on as it is.
    void changeJoint(const Command& running, core::Velocity joint) noexcept;
    /// rt. The next set state lies behind the end of a move that passes it: pass() is due.
    [[nodiscard]] bool atJoint() const noexcept { return joint_ > 0.0 && step_ + 1 >= steps_; }
    /// rt. The speed at which the running move passes its end; 0 = it ends at rest.
    [[nodiscard]] core::Velocity joint() const noexcept { return core::Velocity{joint_}; }
    /// rt. Goes on with `next` from exactly the end of the running move, at the moment between two
    /// cycles in which that is passed. \return as begin() \pre atJoint()
    [[nodiscard]] ErrorId pass(const Command& next, core::Velocity joint) noexcept;

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

    /// What a motion towards a position may use, and where it may be on the way.
    struct Way {
        core::Position target;
        bool forward;
        core::Position outermost;  ///< against the direction of the way
        planner::Limits limits;
    };

    [[nodiscard]] static bool keepsTo(const Way& way, const planner::Profile& profile,
                                      core::Distance tolerance) noexcept;
    [[nodiscard]] bool turnsOnTheWay(const Dynamics& dynamics, double wanted,
                                     std::optional<core::Position> target) const noexcept;
    [[nodiscard]] ErrorId beginPosition(core::Position target, const Dynamics& dynamics) noexcept;
    [[nodiscard]] ErrorId beginMove(const Command& command, core::Position goal,
                                    const Dynamics& dynamics, core::Velocity joint) noexcept;
    [[nodiscard]] ErrorId beginContinuous(core::Position goal, core::Velocity endVelocity,
                                          const Dynamics& dynamics) noexcept;
    /// A way to `target` that passes it at the speed `end`, or a little less where that cannot be
    /// reached.
    [[nodiscard]] bool beginPassing(core::Position target, const Dynamics& dynamics,
                                    double end) noexcept;
    /// The same in two parts: at the commanded velocity until a last change up to `end`.
    [[nodiscard]] bool beginStaged(const Way& way, double end) noexcept;
    [[nodiscard]] bool beginDirect(const Way& way, double end) noexcept;
    [[nodiscard]] double reachable(const Way& way, double end) const noexcept;
    [[nodiscard]] ErrorId beginVelocity(const Dynamics& dynamics) noexcept;
    [[nodiscard]] ErrorId beginBraking(const Dynamics& dynamics) noexcept;
    [[nodiscard]] core::Position moduloTarget(const Command& command,
                                              const Dynamics& dynamics) const noexcept;
    [[nodiscard]] Way wayTo(core::Position target, const Dynamics& dynamics) const noexcept;
    [[nodiscard]] Dynamics holdingVelocity(const Dynamics& dynamics) const noexcept;
    [[nodiscard]] std::optional<Stop> stopFrom(const planner::State& from,
                                               const Dynamics& dynamics) const noexcept;
    /// The profile passes a software limit, and goes farther out than the axis is.
    [[nodiscard]] bool leavesUpward(const planner::Profile& profile) const noexcept;
    [[nodiscard]] bool leavesDownward(const planner::Profile& profile) const noexcept;
    void guardVelocity(const Dynamics& dynamics, core::Velocity wanted) noexcept;
    [[nodiscard]] bool passesGuard(const planner::State& state) const noexcept;
    void turnToLimit() noexcept;
    void run(const planner::Profile& profile) noexcept;
    void start() noexcept;
    void startAt(double lead) noexcept;
    void runStaged(const planner::Profile& first, const planner::Profile& second) noexcept;
    [[nodiscard]] const planner::State& end() const noexcept {
        return staged_ ? second_.end() : profile_.end();
    }
    [[nodiscard]] core::Seconds duration() const noexcept;
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
    planner::Profile second_{};  ///< behind profile_, when staged_
    bool staged_{false};
    double lead_{0.0};   ///< seconds of the profile at step 0; negative: it begins later
    double joint_{0.0};  ///< speed at the end
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
