#pragma once

#include <cstdint>
#include <takt/planner/roadmap/route.hpp>
#include <vector>

/// Random machines with keep-outs, and an independent judge of points.
namespace takt::planner::roadmap::test {

struct Scene {
    std::vector<RouteAxis> axes;
    std::vector<KeepOutParams> keepOuts;
    std::vector<double> start;
    std::vector<double> goal;
    std::uint64_t seed{0};

    [[nodiscard]] RouteRequest request() const;
};

/// Two axes with boxes and discs, or three with boxes, cylinders along any axis and walls with a
/// gap, and start and goal on either side, both free.
Scene randomScene(std::uint64_t seed, std::size_t axes);

/// How deep a point lies in a keep-out with its clearance: above 0 inside. Written from the
/// definition of a keep-out alone.
double depth(const KeepOutParams& keepOut, const std::vector<double>& point);
/// The largest depth of all; -infinity without keep-outs.
double depth(const Scene& scene, const std::vector<double>& point);

/// Every number of an answer, so that equal text means equal bits.
std::string textOf(const RouteAnswer& answer);

}  // namespace takt::planner::roadmap::test
