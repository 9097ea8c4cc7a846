#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/axis/group_command.hpp>
#include <takt/axis/group_view.hpp>
#include <takt/core/time.hpp>
#include <takt/planner/path_brake.hpp>
#include <takt/planner/path_planner.hpp>
#include <takt/planner/profile.hpp>
#include <takt/planner/trajectory.hpp>

namespace takt::axis {

/// The set states of a group's axes, cycle by cycle: on a planned path, on the way of a direct
/// motion, or braking from either.
///
///     motion.begin(members, positions);                       // at rest there
///     motion.runPath(planned);                                // or runDirect(…)
///     each cycle: motion.step(); … motion.states() …
class GroupMotion {
public:
    explicit GroupMotion(core::Duration cycle) noexcept;

    /// rt. Stands at `positions`. The members' limits are looked at until the next call.
    void begin(std::span<const AxisTraits* const> members, const GroupPoint& positions) noexcept;

    /// rt. Goes on with `path`, whose first state is the present one. It is looked at until the
    /// motion rests or goes on with another one.
    void runPath(const planner::PathMotion& path) noexcept;
    /// rt. All axes to `target` so that they arrive together. \pre resting()
    /// \return None; or why there is no such motion, and nothing changes
    [[nodiscard]] ErrorId runDirect(const GroupPoint& target, const Dynamics& dynamics) noexcept;
    /// rt. To rest, on the path where there is one. Infinite limits leave it to the axes, which
    /// then stop by their stop limits; `byAxes` = false keeps them inside their ordinary ones.
    void brake(const Dynamics& dynamics, bool byAxes) noexcept;

    /// rt. One cycle on.
    void step() noexcept;

    /// No motion is left.
    [[nodiscard]] bool resting() const noexcept { return course_ == Course::Rest; }
    [[nodiscard]] bool braking() const noexcept {
        return course_ == Course::BrakePath || course_ == Course::BrakeDirect;
    }
    /// On a path, not braking: the path, and the number of its state.
    [[nodiscard]] const planner::PathMotion* path() const noexcept {
        return course_ == Course::Path ? path_ : nullptr;
    }
    [[nodiscard]] std::uint64_t index() const noexcept { return index_; }
    [[nodiscard]] const planner::FeedState& feed() const noexcept { return feed_; }
    [[nodiscard]] std::span<const planner::State> states() const noexcept {
        return {states_.data(), axes_};
    }
    [[nodiscard]] GroupPoint positions() const noexcept;
    /// Length travelled on paths since the start of the machine.
    [[nodiscard]] core::Distance travelled() const noexcept { return travelled_; }

private:
    enum class Course : std::uint8_t { Rest, Path, Direct, BrakePath, BrakeDirect };

    void stepPath(const planner::FeedState& next) noexcept;
    void stepDirect() noexcept;
    void stepBrakeDirect() noexcept;
    void brakeOnPath(const Dynamics& dynamics, bool byAxes) noexcept;
    void brakeDirect(const Dynamics& dynamics, bool byAxes) noexcept;
    [[nodiscard]] planner::Profile stopOf(std::size_t axis, const Dynamics& dynamics,
                                          bool byAxes) const noexcept;
    void arrive() noexcept;
    void rest() noexcept;
    [[nodiscard]] planner::Limits brakeLimits(std::size_t axis, const Dynamics& dynamics,
                                              bool byAxes) const noexcept;

    double cycle_;  ///< seconds
    std::array<const AxisTraits*, MaxGroupAxes> members_{};
    std::size_t axes_{0};
    std::array<planner::State, MaxGroupAxes> states_{};
    Course course_{Course::Rest};
    std::uint64_t index_{0};  ///< of the present state, on a path or a direct way
    const planner::PathMotion* path_{nullptr};
    planner::FeedState feed_{};
    planner::PathBrake brake_;
    planner::Trajectory direct_;  ///< of all places; those without an axis are off
    std::array<planner::Profile, MaxGroupAxes> stops_{};
    std::uint64_t steps_{0};
    core::Distance travelled_{};
};

}  // namespace takt::axis
