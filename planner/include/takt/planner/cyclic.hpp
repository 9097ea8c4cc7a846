#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <takt/planner/trajectory.hpp>

namespace takt::planner {

/// What an axis is to do from now on.
struct Goal {
    Target target;
    Limits limits;
    bool enabled{true};
};

/// A trajectory that is stepped once per cycle and planned again only when the goals have changed,
/// never from the rounding of its own states.
///
///     CyclicGenerator generator{3, Seconds{0.001}};
///     generator.reset(whereTheAxesAre);
///     auto error = generator.step(goals, timing, states);     // every cycle
class CyclicGenerator {
public:
    /// \pre 1 <= axes <= Trajectory::maxAxes, cycle > 0
    CyclicGenerator(std::size_t axes, core::Seconds cycle);

    /// rt. Forgets the motion; the axes are at these states. \pre states.size() == axes
    void reset(std::span<const State> states) noexcept;

    /// rt. Goes on by one cycle. Goals that are refused change nothing: the motion goes on as it
    /// was, and its states are handed out all the same. \return what is wrong with the goals, or
    /// nothing
    std::optional<InputFault> step(std::span<const Goal> goals, const Timing& timing,
                                   std::span<State> states) noexcept;

    [[nodiscard]] const Trajectory& trajectory() const noexcept { return trajectory_; }
    /// Time since the motion was planned.
    [[nodiscard]] core::Seconds time() const noexcept { return cycle_ * cyclesDone_; }
    [[nodiscard]] bool isDone() const noexcept {
        return !moving_ || time() >= trajectory_.duration();
    }

private:
    [[nodiscard]] bool sameAsBefore(std::span<const Goal> goals,
                                    const Timing& timing) const noexcept;
    std::optional<InputFault> planAgain(std::span<const Goal> goals, const Timing& timing) noexcept;
    void sampleNow(std::span<State> states) const noexcept;

    Trajectory trajectory_;
    core::Seconds cycle_;
    double cyclesDone_{0.0};
    bool moving_{false};
    std::array<State, Trajectory::maxAxes> start_{};
    std::array<Goal, Trajectory::maxAxes> goals_{};
    Timing timing_{};
};

}  // namespace takt::planner
