#pragma once

#include <cstdint>
#include <limits>

#include "polyline.hpp"

namespace takt::planner::roadmap {

/// A problem of the tree search. Axes with the factor 0 have the same position in start and goal,
/// and keep it.
struct SearchProblem {
    const Obstacles& obstacles;
    const Metric& metric;
    std::span<const double> low;
    std::span<const double> high;
    Point start;
    Point goal;
};

struct SearchTry {
    std::uint64_t seed{0};
    std::uint32_t iterations{0};  ///< allowed
    double range{0.0};            ///< longest branch that is added in one step
    /// Where a way of this length is known, what cannot be on a shorter one is rarely looked at.
    double knownLength{std::numeric_limits<double>::infinity()};
};

struct SearchResult {
    Polyline line;                ///< empty when none was found
    std::uint32_t iterations{0};  ///< used
};

/// One bidirectional search (RRT-Connect), repeatable: all its random numbers come from the seed.
[[nodiscard]] SearchResult searchTree(const SearchProblem& problem, const SearchTry& attempt);

}  // namespace takt::planner::roadmap
