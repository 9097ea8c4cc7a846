#pragma once

#include <optional>
#include <takt/planner/profile.hpp>

namespace takt::planner {

/// Follows a moving target, a running master for example: gets to it as fast as its limits allow
/// and then runs with it. The target is taken to go on with the acceleration it has; while it does,
/// nothing is planned again. A target outside the limits is run after within them, and caught up
/// with once it lets itself be.
///
///     Tracker tracker{limits, Seconds{0.001}};
///     tracker.reset(whereTheAxisIs);
///     auto error = tracker.step(master, set);                 // every cycle
class Tracker {
public:
    /// \pre limits as for plan(), jerk finite, cycle > 0
    Tracker(const Limits& limits, core::Seconds cycle) noexcept : limits_{limits}, cycle_{cycle} {}

    /// rt. Forgets the motion.
    void reset(const State& state) noexcept;

    /// rt. Goes on by one cycle. \param target where the master is now \param set the axis' state
    /// in the next cycle \return NotFinite for a target that is not a number, InvalidLimits: the
    /// motion so far goes
    ///         on, and `set` is its next state; or nothing
    std::optional<PlanError> step(const State& target, State& set) noexcept;

    /// The axis runs with its target. Never while the target is outside the axis' limits.
    [[nodiscard]] bool isSynchronous() const noexcept { return synchronous_; }

private:
    [[nodiscard]] bool isAsPredicted(const State& target) const noexcept;
    [[nodiscard]] bool canBeFollowed(const State& target) const noexcept;
    [[nodiscard]] std::optional<PlanError> planAgain(const State& target) noexcept;

    Limits limits_;
    core::Seconds cycle_;
    Profile profile_{};
    double cyclesDone_{0.0};
    State target_{};  ///< as it was when the profile was planned
    bool leadsToTarget_{false};
    bool synchronous_{false};
};

}  // namespace takt::planner
