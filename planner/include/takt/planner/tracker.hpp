#pragma once

#include <takt/planner/profile.hpp>

namespace takt::planner {

/// Follows a moving target, a running master for example: gets to it as fast as its limits allow
/// and then runs with it. The target is taken to go on with the acceleration it has; while it does,
/// nothing is planned again.
///
///     Tracker tracker{limits, Seconds{0.001}};
///     tracker.reset(whereTheAxisIs);
///     State set = tracker.step(master);                       // every cycle
class Tracker {
public:
    /// \pre limits as for plan(), cycle > 0
    Tracker(const Limits& limits, core::Seconds cycle) noexcept : limits_{limits}, cycle_{cycle} {}

    /// rt. Forgets the motion.
    void reset(const State& state) noexcept;

    /// rt. The state of the axis in the next cycle. \param target where the master is now
    /// \return NotFinite for a target that is not a number, InvalidLimits; the motion goes on as it
    /// was
    core::Result<State, PlanError> step(const State& target) noexcept;

    /// The axis runs with its target, which stays within the axis' limits.
    [[nodiscard]] bool isSynchronous() const noexcept { return synchronous_; }

private:
    [[nodiscard]] bool isAsPredicted(const State& target) const noexcept;
    [[nodiscard]] core::Result<Profile, PlanError> intercept(const State& from,
                                                             const State& target) const noexcept;

    Limits limits_;
    core::Seconds cycle_;
    Profile profile_{};
    double cyclesDone_{0.0};
    State target_{};  ///< as it was when the profile was planned
    bool planned_{false};
    bool synchronous_{false};
};

}  // namespace takt::planner
