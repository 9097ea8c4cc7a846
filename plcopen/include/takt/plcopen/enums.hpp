#pragma once

#include <cstdint>
#include <takt/axis/command.hpp>

/// Enumerations of PLCopen Motion Control part 1, names and numbers as recommended there.
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

/// rt. Both enumerations carry the standard's numbers.
[[nodiscard]] constexpr axis::Direction toAxis(MC_DIRECTION direction) noexcept {
    return static_cast<axis::Direction>(direction);
}
[[nodiscard]] constexpr axis::BufferMode toAxis(MC_BUFFER_MODE mode) noexcept {
    return static_cast<axis::BufferMode>(mode);
}

}  // namespace takt::plcopen
