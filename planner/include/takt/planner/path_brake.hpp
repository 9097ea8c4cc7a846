#pragma once

#include <array>
#include <span>
#include <takt/planner/path_planner.hpp>

namespace takt::planner {

/// Brings a running motion to rest on its path, in the cycle: for halts, stops and faults.
///
/// It slows the clock of the planned feed, so every position is one of the path, and where it goes
/// slower than planned, all that curvature asks for becomes less. The planned motion itself stops
/// at the end of its path, and at every stop on the way; the brake is never later than that. Limits
/// that are tighter than what the plan uses at a place give way to the plan there.
///
///     brake.start(motion, k, stopLimits, pathLimits);
///     FeedState next = brake.step();                        // every cycle until isAtRest()
class PathBrake {
public:
    /// rt. Takes over in the state that `motion` has in `cycle`. `motion` is looked at until the
    /// brake is at rest. \pre limits.size() == axes of the motion
    void start(const PathMotion& motion, std::uint64_t cycle,
               std::span<const PathAxisLimits> limits, const PathFeed& path) noexcept;

    /// rt. Goes on by one cycle. Bounded work.
    FeedState step() noexcept;

    /// rt. New limits while braking: a stop after a halt, say.
    void tighten(std::span<const PathAxisLimits> limits, const PathFeed& path) noexcept;

    [[nodiscard]] bool isAtRest() const noexcept { return atRest_; }
    [[nodiscard]] const FeedState& state() const noexcept { return state_; }

private:
    /// The clock of the plan: its time, and how fast and how evenly it runs.
    struct Clock {
        double time;
        double rate;
        double rate1;
    };
    struct Range {
        double low;
        double high;
    };

    [[nodiscard]] Range curbs(const Clock& clock) const noexcept;
    [[nodiscard]] bool recovers(Clock clock) const noexcept;
    [[nodiscard]] FeedState stateOf(const Clock& clock) const noexcept;

    const PathMotion* motion_{nullptr};
    std::array<PathAxisLimits, maxPathAxes> limits_{};
    PathFeed path_{};
    Clock clock_{};
    FeedState state_{};
    bool atRest_{true};
};

}  // namespace takt::planner
