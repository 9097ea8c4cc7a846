#pragma once

#include <cstddef>
#include <span>
#include <takt/planner/trajectory.hpp>
#include <vector>

namespace takt::planner {

/// Motion through a list of positions without a stop between them, to rest at the last. Velocities
/// and accelerations in the waypoints are searched for; each leg is then as fast as they allow.
///
/// Allocates at construction only. Planning takes milliseconds: it is a job, not for the cycle. It
/// tries a number of variants that depends on the request only, so the same request gives the same
/// motion.
///
///     WaypointTrajectory path{3, 20};
///     auto duration = path.plan(from, points, limits);        // points: x0 y0 z0 x1 y1 z1 …
///     path.sample(time, states);
class WaypointTrajectory {
public:
    /// \pre 1 <= axes <= Trajectory::maxAxes, maxPoints >= 1
    WaypointTrajectory(std::size_t axes, std::size_t maxPoints);

    /// A refused request leaves the trajectory as it was.
    /// \param points positions of all axes, point after point
    /// \pre from.size() == limits.size() == axes, points.size() a multiple of it and not more than
    /// maxPoints
    core::Result<core::Seconds, InputFault> plan(std::span<const State> from,
                                                 std::span<const core::Position> points,
                                                 std::span<const Limits> limits) noexcept;

    /// rt. The states of all axes at `time`. \pre states.size() >= axes
    void sample(core::Seconds time, std::span<State> states) const noexcept;

    [[nodiscard]] core::Seconds duration() const noexcept { return duration_; }
    /// Number of legs; leg i ends at point i.
    [[nodiscard]] std::size_t size() const noexcept { return legs_; }
    [[nodiscard]] const Trajectory& operator[](std::size_t leg) const noexcept {
        return kept_[leg];
    }
    /// When point i is passed.
    [[nodiscard]] core::Seconds passing(std::size_t point) const noexcept {
        return passing_[point];
    }

private:
    /// The states in all points, the start first, and the durations of the legs between them.
    struct Search {
        std::vector<State> states;
        std::vector<double> durations;
        std::vector<AxisRequest> requests;
        std::vector<State> trial;
    };

    void guess(std::span<const Limits> limits) noexcept;
    void guessPoint(std::size_t point, std::span<const Limits> limits) noexcept;
    [[nodiscard]] double legDuration(std::size_t leg, std::span<const Limits> limits) noexcept;
    [[nodiscard]] bool tryTrial(std::size_t point, std::span<const Limits> limits) noexcept;
    [[nodiscard]] bool improve(std::size_t point, double step,
                               std::span<const Limits> limits) noexcept;
    [[nodiscard]] bool stretch(std::size_t point, double step,
                               std::span<const Limits> limits) noexcept;
    void requestLeg(std::size_t leg, std::span<const Limits> limits) noexcept;
    [[nodiscard]] State& at(std::size_t point, std::size_t axis) noexcept {
        return search_.states[point * axes_ + axis];
    }

    std::size_t axes_;
    std::size_t maxPoints_;
    std::size_t points_{0};
    std::size_t legs_{0};
    core::Seconds duration_{};
    std::vector<Trajectory> kept_;
    std::vector<Trajectory> next_;
    std::vector<core::Seconds> passing_;
    Trajectory probe_;
    Search search_;
};

}  // namespace takt::planner
