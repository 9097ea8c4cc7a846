#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <takt/core/units.hpp>
#include <vector>

namespace takt::axis {

/// More axes than this no group has.
inline constexpr std::size_t MaxGroupAxes = 16;
/// The first of them are the Cartesian ones: in them the length of a path is measured.
inline constexpr std::size_t CartesianAxes = 3;

/// Limits of the motion along a path; the limits of every axis hold besides.
struct PathLimitParams {
    core::Velocity velocity{};
    core::Acceleration acceleration{};
    core::Acceleration deceleration{};
    core::Jerk jerk{};
};

/// Axes that move together on one path.
struct GroupParams {
    std::string name;
    std::string unit;               ///< of path length, "mm" or "deg"
    std::vector<std::size_t> axes;  ///< indices into the machine's axes, in the order of the places
    PathLimitParams limits;
    std::uint32_t queueDepth{32};    ///< commands that may wait, 1 to 32
    std::uint32_t latencyCycles{4};  ///< from a command to its first set-point: time for planning
    std::string origin;              ///< "machine.xml:60"
};

}  // namespace takt::axis
