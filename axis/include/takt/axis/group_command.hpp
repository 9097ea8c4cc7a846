#pragma once

#include <array>
#include <cstdint>
#include <takt/axis/command.hpp>
#include <takt/axis/group_params.hpp>
#include <takt/core/units.hpp>

namespace takt::axis {

struct AxisTraits;

enum class GroupCommandKind : std::uint8_t {
    AddAxis,
    RemoveAxis,
    UngroupAll,
    Enable,
    Disable,
    Reset,
    ReleaseStop,  ///< Execute of the MC_GroupStop named by `replaces` fell
    Stop,
    Halt,
    MoveDirect,
    MoveLinear,
    MoveCircular,
};

/// MC_COORD_SYSTEM, numbers as in the standard.
enum class CoordSystem : std::uint8_t { Acs = 1, Mcs = 2, Pcs = 3 };

/// MC_TRANSITION_MODE, numbers as in the standard.
enum class TransitionMode : std::uint8_t {
    None = 0,
    StartVelocity = 1,
    ConstantVelocity = 2,
    CornerDistance = 3,
    MaxCornerDeviation = 4,
};

/// MC_CIRC_MODE and MC_CIRC_PATHCHOICE, numbers as in the standard.
enum class CircMode : std::uint8_t { Border = 0, Center = 1, Radius = 2 };
enum class CircPathChoice : std::uint8_t { Clockwise = 0, CounterClockwise = 1 };

/// One number for each place of a group.
using GroupPoint = std::array<double, MaxGroupAxes>;

/// How a blending command goes on from the one before it.
struct Transition {
    TransitionMode mode{TransitionMode::None};
    double parameter{0.0};      ///< corner distance or deviation
    core::Velocity velocity{};  ///< bound in the contour; 0 = none
};

struct Arc {
    CircMode mode{CircMode::Border};
    CircPathChoice choice{CircPathChoice::Clockwise};
    double tolerance{0.0};  ///< largest difference of the radii
    GroupPoint aux{};
};

/// What a program asks of a group. Blocks fill it; admit() completes it.
struct GroupCommand {
    CommandId id{CommandId::None};
    CommandId replaces{CommandId::None};  ///< previous command of the same block instance
    GroupCommandKind kind{GroupCommandKind::Halt};
    BufferMode bufferMode{BufferMode::Aborting};
    CoordSystem coordSystem{CoordSystem::Acs};
    bool relative{false};             ///< points count from where the command begins
    std::uint8_t place{0};            ///< AddAxis (0 = the next free one), RemoveAxis; from 1
    const AxisTraits* axis{nullptr};  ///< AddAxis
    Dynamics dynamics{};
    Transition transition{};
    Arc arc{};
    GroupPoint point{};  ///< target or distance
};

/// Takes the group's motion: Halt and the moves. Stop is a kind of its own.
[[nodiscard]] constexpr bool isMotion(GroupCommandKind kind) noexcept {
    return kind >= GroupCommandKind::Halt;
}
/// Runs on a path that is planned ahead and can be blended.
[[nodiscard]] constexpr bool isPath(GroupCommandKind kind) noexcept {
    return kind == GroupCommandKind::MoveLinear || kind == GroupCommandKind::MoveCircular;
}

}  // namespace takt::axis
