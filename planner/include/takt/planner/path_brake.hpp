#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <takt/planner/path_planner.hpp>

namespace takt::planner {

/// Brings a running motion to rest on its path, in the cycle: for halts, stops and faults.
///
/// It slows down the clock of the planned feed, so every position is one of the path, and where it
/// goes slower than planned, all that curvature asks for becomes less. The planned motion itself
/// stops at the end of its path and at every stop on the way; the brake is never later than that.
/// Limits that are tighter than what the plan uses at a place give way to the plan there.
///
///     brake.start(motion, k, stopLimits, pathLimits);
///     FeedState next = brake.step();                        // every cycle until isAtRest()
class PathBrake {
public:
    /// rt. Takes over in the state that `motion` has in `cycle`; the first step() is the cycle
    /// after it. `motion` is looked at until the brake is at rest. Of `path`, deceleration and jerk
    /// count.
    /// \pre limits.size() == axes of the motion
    void start(const PathMotion& motion, std::uint64_t cycle,
               std::span<const PathAxisLimits> limits, const PathFeed& path) noexcept;

    /// rt. Other limits while braking: a stop after a halt, say.
    void setLimits(std::span<const PathAxisLimits> limits, const PathFeed& path) noexcept;

    /// rt. Goes on by one cycle. Bounded work.
    FeedState step() noexcept;

    [[nodiscard]] bool isAtRest() const noexcept { return atRest_; }
    [[nodiscard]] const FeedState& state() const noexcept { return state_; }

private:
    /// The clock of the plan: its time, its rate and the derivative of that in real time.
    struct Clock {
        double time;
        double rate;
        double rate1;
    };
    struct Range {
        double low;
        double high;
    };
    /// What the clock may do at a moment.
    struct Room {
        Range rate1;  ///< by the accelerations
        Range rate2;  ///< by the jerks
    };

    [[nodiscard]] Room roomAt(const Clock& clock) const noexcept;
    [[nodiscard]] Range rangeNow() const noexcept;
    [[nodiscard]] bool recovers(Clock clock) const noexcept;
    [[nodiscard]] double choose(const Range& range) noexcept;
    [[nodiscard]] bool mayStopHere() const noexcept;
    [[nodiscard]] FeedState stateOf(const Clock& clock) const noexcept;
    void rest(double time) noexcept;

    const PathMotion* motion_{nullptr};
    std::size_t axes_{0};
    std::array<PathAxisLimits, maxPathAxes> limits_{};
    PathFeed path_{};
    Clock clock_{};
    double restTime_{0.0};  ///< of the plan
    FeedState state_{};
    bool landing_{false};
    bool atRest_{true};
};

}  // namespace takt::planner
