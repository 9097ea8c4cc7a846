#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <takt/planner/path_feed.hpp>
#include <takt/planner/path_geometry.hpp>

namespace takt::planner {

/// Limits of one axis, each positive and finite, for both directions.
struct PathAxisLimits {
    core::Velocity velocity;
    core::Acceleration acceleration;
    core::Jerk jerk;
};

/// A path and the feed along it: what the cycle evaluates. Made by a PathPlanner.
struct PathMotion {
    PathMotion(const PathSpace& space, std::size_t maxElements, core::Seconds cycle)
        : geometry{space, maxElements}, feed{cycle} {}

    PathGeometry geometry;
    FeedProfile feed;
};

/// rt. Positions, velocities and accelerations of the axes for a state of the feed.
struct PathAxisState {
    core::Position position;
    core::Velocity velocity;
    core::Acceleration acceleration;
};
void axesAt(const PathGeometry& geometry, const FeedState& feed,
            std::span<PathAxisState> out) noexcept;

/// Plans the feed over a window of elements: near time-optimal, with limits of velocity,
/// acceleration and jerk along the path and of every axis, to rest at its end. Every plan has been
/// checked by differences of its positions from cycle to cycle before it is handed out.
///
/// A job: takes milliseconds, allocates, and is bounded by counted iterations. The same request
/// gives the same plan, bit for bit.
///
///     PathPlanner planner{{3, 3}, limits, cycle};
///     planner.plan(elements, motion);                       // from rest, cycle 0 of `motion`
///     …                                                     // motion.feed.at(k) in the cycle
///     planner.extend(motion, k + latency, more, next);      // `next` begins in that cycle
class PathPlanner {
public:
    /// \pre limits.size() == space.axes
    PathPlanner(const PathSpace& space, std::span<const PathAxisLimits> limits, core::Seconds cycle,
                std::size_t maxElements = 32);
    ~PathPlanner();
    PathPlanner(PathPlanner&&) noexcept;
    PathPlanner& operator=(PathPlanner&&) noexcept;

    /// A motion of the right size for this planner.
    [[nodiscard]] PathMotion motion() const;

    /// Plans from rest at the start of the first element. A refused request leaves `out` undefined.
    /// \return the cycles until it rests, or why there is no plan
    core::Result<std::uint64_t, PathError> plan(std::span<const PathElement> elements,
                                                PathMotion& out);

    /// Plans again from where `running` is in cycle `from`, with more elements behind its end:
    /// `out` begins in that cycle with that state. Elements that are left by then are dropped. The
    /// end of `running` gets the transition it asks for if that begins after the state; where no
    /// feed is found for it, it stays the stop that it was.
    /// \param joint in the place of the transition that the end of `running` was given
    /// \pre out is not running; more may be empty: then only what has been left is dropped
    core::Result<std::uint64_t, PathError> extend(const PathMotion& running, std::uint64_t from,
                                                  std::span<const PathElement> more,
                                                  PathMotion& out,
                                                  std::optional<Transition> joint = std::nullopt);

    /// What the last successful plan took, for reports.
    struct Effort {
        std::size_t cells{0};
        int newtonSteps{0};
        int attempts{0};
    };
    [[nodiscard]] const Effort& effort() const noexcept;

private:
    struct Work;
    std::unique_ptr<Work> work_;
};

}  // namespace takt::planner
