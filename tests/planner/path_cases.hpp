#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <takt/planner/path_planner.hpp>
#include <vector>

#include "problems.hpp"

/// Random paths and an independent judge of motions along them, in long double.
namespace takt::planner::test {

struct PathCase {
    PathSpace space;
    std::vector<PathAxisLimits> limits;
    std::vector<PathElement> elements;
    double cycle;
};

PathPoint point(std::initializer_list<double> coordinates);
PathElement lineTo(const PathSpace& space, std::initializer_list<double> from,
                   std::initializer_list<double> to);
PathAxisLimits axisLimits(double v, double a, double j);

/// Lines and arcs of many sizes with all kinds of transitions, in two to five axes.
PathCase randomPath(Random& random, int elements);
/// A connected chain of random elements that goes on from `from`.
std::vector<PathElement> randomChain(Random& random, const PathSpace& space, PathPoint from,
                                     int elements);

/// A closed square, corner by corner, each with the same transition.
std::vector<PathElement> squareLaps(const PathSpace& space, double side, int laps,
                                    const Transition& transition, double velocity);

/// A trace of positions, one row of all axes per cycle, and the place on the path.
struct Trace {
    std::size_t axes{0};
    std::vector<std::vector<double>> rows;
    std::vector<double> s;

    void add(const PathGeometry& geometry, double at, double shift = 0.0);
};

/// The whole motion with a few cycles of rest on both sides.
Trace traceOf(const PathMotion& motion);

/// The greatest use of the axes' limits in a trace: 1 at the limit. By differences from row to row.
struct Use {
    double velocity{0.0};
    double acceleration{0.0};
    double jerk{0.0};
    bool monotone{true};

    [[nodiscard]] double most() const;
};
Use useOf(const Trace& trace, std::span<const PathAxisLimits> limits, double cycle);

/// The least time for a path at any jerk: the bound of second order on a fine grid, by independent
/// code.
double secondOrderTime(const PathGeometry& geometry, std::span<const PathAxisLimits> limits);

}  // namespace takt::planner::test
