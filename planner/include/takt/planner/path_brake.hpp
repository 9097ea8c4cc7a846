#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <takt/planner/path_planner.hpp>

namespace takt::planner {

/// Brings a running motion to rest on its path, in the cycle: for halts, stops and faults.
///
/// From cycle to cycle it takes the hardest jerk from which it could still go over, within all
/// limits, to the planned feed made evenly slower. That keeps all limits for good, so there always
/// is a way on: at worst the planned motion itself, which stops at the end of its path and at every
/// stop on the way. Limits that are tighter than what the plan uses at a place give way to the plan
/// there.
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
    [[nodiscard]] const FeedState& state() const noexcept { return place_.feed; }

private:
    /// A feed beside the plan, and the time at which the plan is at the same place.
    struct Place {
        FeedState feed;
        double planTime;
    };
    struct Range {
        double low{-unlimited};
        double high{unlimited};
    };
    /// What the limits allow along the path at a moment.
    struct Room {
        Range acceleration;
        Range jerk;
        double steady;    ///< jerk along the path that the axes allow on a line
        double turning;   ///< radians per second
        double followed;  ///< acceleration of the plan, made evenly slower
        double safe;      ///< acceleration from which on nothing has to be taken back
    };

    [[nodiscard]] Place advanced(const Place& place, double jerk, double time) const noexcept;
    [[nodiscard]] Room roomAt(const Place& place) const noexcept;
    [[nodiscard]] Range rangeNow() const noexcept;
    [[nodiscard]] bool mayTake(double jerk) const noexcept;
    [[nodiscard]] bool recovers(Place place) const noexcept;
    [[nodiscard]] std::optional<double> choose(const Range& range) noexcept;
    [[nodiscard]] bool mayStopHere() const noexcept;
    void follow() noexcept;
    void rest(double s) noexcept;

    const PathMotion* motion_{nullptr};
    std::size_t axes_{0};
    std::array<PathAxisLimits, maxPathAxes> limits_{};
    PathFeed path_{};
    Place place_{};
    double restTime_{0.0};  ///< when the plan comes to rest, and where
    double restPlace_{0.0};
    bool landing_{false};
    bool atRest_{true};
};

}  // namespace takt::planner
