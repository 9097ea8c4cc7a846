#pragma once

#include <cstdint>
#include <takt/axis/command.hpp>
#include <takt/axis/group_command.hpp>

/// Enumerations of PLCopen Motion Control parts 1 and 4, names and numbers as recommended there.
namespace takt::plcopen {

enum class MC_DIRECTION : std::uint8_t {
    mcPositiveDirection = 1,
    mcShortestWay = 2,
    mcNegativeDirection = 3,
    mcCurrentDirection = 4,
};

enum class MC_BUFFER_MODE : std::uint8_t {
    mcAborting = 0,
    mcBuffered = 1,
    mcBlendingLow = 2,
    mcBlendingPrevious = 3,
    mcBlendingNext = 4,
    mcBlendingHigh = 5,
};

enum class MC_COORD_SYSTEM : std::uint8_t { mcACS = 1, mcMCS = 2, mcPCS = 3 };

enum class MC_TRANSITION_MODE : std::uint8_t {
    mcTMNone = 0,
    mcTMStartVelocity = 1,
    mcTMConstantVelocity = 2,
    mcTMCornerDistance = 3,
    mcTMMaxCornerDeviation = 4,
};

enum class MC_CIRC_MODE : std::uint8_t { mcBorder = 0, mcCenter = 1, mcRadius = 2 };

enum class MC_CIRC_PATHCHOICE : std::uint8_t { mcClockwise = 0, mcCounterClockwise = 1 };

/// rt. All enumerations carry the standard's numbers.
[[nodiscard]] constexpr axis::Direction toAxis(MC_DIRECTION direction) noexcept {
    return static_cast<axis::Direction>(direction);
}
[[nodiscard]] constexpr axis::BufferMode toAxis(MC_BUFFER_MODE mode) noexcept {
    return static_cast<axis::BufferMode>(mode);
}
[[nodiscard]] constexpr axis::CoordSystem toAxis(MC_COORD_SYSTEM system) noexcept {
    return static_cast<axis::CoordSystem>(system);
}
[[nodiscard]] constexpr axis::TransitionMode toAxis(MC_TRANSITION_MODE mode) noexcept {
    return static_cast<axis::TransitionMode>(mode);
}
[[nodiscard]] constexpr axis::CircMode toAxis(MC_CIRC_MODE mode) noexcept {
    return static_cast<axis::CircMode>(mode);
}
[[nodiscard]] constexpr axis::CircPathChoice toAxis(MC_CIRC_PATHCHOICE choice) noexcept {
    return static_cast<axis::CircPathChoice>(choice);
}

}  // namespace takt::plcopen
