#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <takt/core/units.hpp>
#include <vector>

namespace takt::planner::roadmap {

/// What a keep-out covers of one axis. It reaches as far as the axis does where nothing is said.
struct KeepOutSpan {
    std::size_t axis{0};  ///< place of the axis in its group
    core::Position from{-std::numeric_limits<double>::infinity()};
    core::Position to{std::numeric_limits<double>::infinity()};
};

/// A disc in the plane of two axes: with spans of further axes, a cylinder.
struct KeepOutDisc {
    std::size_t firstAxis{0};
    std::size_t secondAxis{1};
    core::Position firstCentre{};
    core::Position secondCentre{};
    core::Distance radius{};  ///< above 0
};

/// A region that the axes must not enter: everything that lies within all of its spans and, if it
/// has one, within its disc. Spans alone make a box. Axes that it does not name may be anywhere.
struct KeepOutParams {
    std::string name;
    std::vector<KeepOutSpan> spans;  ///< each axis once, from below to
    std::optional<KeepOutDisc> disc;
    /// How far the axes stay away from it: size of the tool, play, and so on; 0 or more. It is kept
    /// along each axis of a span and radially around the disc, so not less in any direction.
    core::Distance clearance{};
    std::string origin;  ///< "machine.xml:90"
};

/// The keep-outs of one group of axes.
struct ObstacleParams {
    std::size_t group{0};  ///< place among the machine's groups
    std::vector<KeepOutParams> keepOuts;
    std::uint32_t latencyCycles{100};  ///< from a program's order to its answer, at least
    std::string origin;                ///< "machine.xml:88"
};

}  // namespace takt::planner::roadmap
