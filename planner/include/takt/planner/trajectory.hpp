#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <takt/planner/profile.hpp>
#include <vector>

namespace takt::planner {

namespace detail {
struct Group;
}

enum class Synchronisation : std::uint8_t {
    None,             ///< each axis as fast as it can
    Time,             ///< all arrive together
    TimeIfNecessary,  ///< axes whose target is at rest arrive when they can, the others together
    /// Together, and on a straight line where that takes no longer (by 1e-6): ways, velocities and
    /// accelerations of all axes are multiples of one vector, which velocity targets can have too.
    Phase,
    Line,  ///< together, and on a straight line wherever there is one, even if it takes longer
};

/// How near to a State target counts as there already. Zero: the numbers are taken as they are, but
/// for their rounding. One encoder count, say, saves a motion of a few microseconds for what nobody
/// can see.
struct Resolution {
    core::Distance position{};
    core::Velocity velocity{};
};

/// What one axis is to do. An axis that is not enabled stays where it starts.
struct AxisRequest {
    State from;
    Target target;
    Limits limits;
    bool enabled{true};
    Resolution resolution{};
};

struct Timing {
    Synchronisation synchronisation{Synchronisation::Time};
    core::Seconds cycle{};        ///< durations are multiples of it; zero: any duration
    core::Seconds minDuration{};  ///< the motion takes no less
};

/// Motion of 1 to 16 axes. Allocates at construction only.
///
///     Trajectory trajectory{3};
///     if (auto duration = trajectory.plan(requests, {}); duration.ok()) …
///     trajectory.sample(time, states);                        // once per cycle
class Trajectory {
public:
    static constexpr std::size_t maxAxes = 16;

    /// \pre 1 <= axes <= maxAxes
    explicit Trajectory(std::size_t axes);
    ~Trajectory();
    Trajectory(Trajectory&&) noexcept;
    Trajectory& operator=(Trajectory&&) noexcept;

    /// rt. Plans the fastest motion of all axes. A refused request leaves the trajectory as it was.
    /// \pre requests.size() == size()
    /// \return the duration, which is that of the last axis to arrive
    core::Result<core::Seconds, InputFault> plan(std::span<const AxisRequest> requests,
                                                 const Timing& timing) noexcept;

    /// rt. The states of all axes at `time`. \pre states.size() >= size()
    void sample(core::Seconds time, std::span<State> states) const noexcept;

    [[nodiscard]] std::size_t size() const noexcept { return current_.size(); }
    [[nodiscard]] core::Seconds duration() const noexcept { return duration_; }
    [[nodiscard]] const Profile& operator[](std::size_t axis) const noexcept {
        return current_[axis];
    }
    /// The axes move in proportion to each other.
    [[nodiscard]] bool isStraight() const noexcept { return straight_; }

private:
    [[nodiscard]] std::optional<double> write(Synchronisation wanted, bool& straight) noexcept;
    [[nodiscard]] std::optional<double> writeStraight(bool atAnyPrice, bool& straight) noexcept;

    std::vector<Profile> current_;
    std::vector<Profile> next_;
    std::unique_ptr<detail::Group> work_;
    core::Seconds duration_{};
    bool straight_{false};
};

}  // namespace takt::planner
