#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <takt/core/result.hpp>
#include <takt/core/units.hpp>

/// Jerk-limited, time-optimal motion of one axis.
namespace takt::planner {

/// Position, velocity and acceleration at one instant.
struct State {
    core::Position position;
    core::Velocity velocity;
    core::Acceleration acceleration;
};

/// Limits by direction: minVelocity and minAcceleration are negative, the others positive.
///
/// An infinite jerk makes the motion second order: the acceleration may jump, and those of start
/// and target are ignored. Infinite accelerations as well make it first order: the velocity may
/// jump. Infinite velocities switch that limit off for velocity targets.
struct Limits {
    core::Velocity maxVelocity;
    core::Velocity minVelocity;
    core::Acceleration maxAcceleration;
    core::Acceleration minAcceleration;
    core::Jerk jerk;
};

enum class TargetKind : std::uint8_t {
    State,     ///< reach position, velocity and acceleration
    Velocity,  ///< reach velocity and acceleration, wherever that is
};

struct Target {
    TargetKind kind{TargetKind::State};
    State state;
};

enum class PlanError : std::uint8_t {
    NotFinite,      ///< a number of state, target or limits is NaN, or infinite where it may not be
    InvalidLimits,  ///< a limit is zero or has the wrong sign
    TargetNotViable,  ///< target velocity or acceleration outside the limits, or not to be held
    NoSolution,       ///< numerically without an answer; never for a viable problem
    OutOfRange,       ///< a position range would have to be left (planWithin)
};

/// The number of a request that an error is about.
enum class InputField : std::uint8_t {
    None,
    StartPosition,
    StartVelocity,
    StartAcceleration,
    TargetPosition,
    TargetVelocity,
    TargetAcceleration,
    MaxVelocity,
    MinVelocity,
    MaxAcceleration,
    MinAcceleration,
    Jerk,
    Cycle,
    MinDuration,
    Waypoint,
    Axes,
};

/// What is wrong with a request: which number of which axis (0 for a single one).
struct InputFault {
    PlanError error;
    InputField field;
    std::uint8_t axis;
};

/// A piece of constant jerk. It begins at `start` of the profile with the state `from`.
struct Segment {
    core::Seconds start;
    core::Seconds duration;
    State from;
    core::Jerk jerk;
};

/// Motion as up to `capacity` pieces of constant jerk. Before its beginning a profile is its first
/// state; after its end it goes on with the target's velocity and acceleration (a target at rest
/// stays). Trivially copyable, no heap.
class Profile {
public:
    static constexpr std::size_t capacity = 20;

    /// A profile of no duration that stays in `state`.
    static Profile holding(State state) noexcept;

    [[nodiscard]] core::Seconds duration() const noexcept { return duration_; }
    [[nodiscard]] const State& end() const noexcept { return end_; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] const Segment& operator[](std::size_t i) const noexcept { return segments_[i]; }

private:
    friend class ProfileBuilder;

    std::array<Segment, capacity> segments_{};
    std::uint8_t size_{0};
    core::Seconds duration_{};
    State end_{};
};

/// rt. The fastest motion from `from` to `target` within `limits`. A start outside the limits is
/// brought inside first. Bounded time, no allocation; nothing is kept between calls.
[[nodiscard]] core::Result<Profile, PlanError> plan(const State& from, const Target& target,
                                                    const Limits& limits) noexcept;

/// rt. The state at `time` after the beginning; exactly the target at and after the end of a
/// profile whose target is at rest.
[[nodiscard]] State sample(const Profile& profile, core::Seconds time) noexcept;

/// rt. What is wrong with a request, or nothing: plan() refuses it with the same error.
[[nodiscard]] std::optional<InputFault> findFault(const State& from, const Target& target,
                                                  const Limits& limits) noexcept;

/// rt. The shortest way to standstill: velocity and acceleration zero.
[[nodiscard]] core::Result<Profile, PlanError> planStop(const State& from,
                                                        const Limits& limits) noexcept;

}  // namespace takt::planner
