#include <algorithm>
#include <array>
#include <takt/planner/roadmap/route_trial.hpp>

namespace takt::planner::roadmap {

namespace {

PathPoint pathPoint(const RoutePoint& point) {
    PathPoint out;
    std::transform(point.position.begin(), point.position.end(), out.begin(),
                   [](double value) { return core::Position{value}; });
    return out;
}

/// The positions are those of lines and of blends within corner triangles, apart from rounding: a
/// path that touches a keep-out may lie so far within it.
constexpr double Rounding = 1e-9;

/// A keep-out that a point lies in by more than rounding.
std::optional<std::size_t> collision(const Obstacles& obstacles, Point point) {
    const auto touched = obstacles.around(point);
    if (!touched) return std::nullopt;
    // A point on the surface leaves it by a step of the rounding along some axis.
    std::array<double, Obstacles::MaxAxes> beside{};
    std::copy(point.begin(), point.end(), beside.begin());
    for (std::size_t axis = 0; axis < point.size(); ++axis) {
        for (const double step : {-Rounding, Rounding}) {
            beside[axis] = point[axis] + step;
            if (!obstacles.around(Point{beside}.first(point.size()))) return std::nullopt;
        }
        beside[axis] = point[axis];
    }
    return touched;
}

}  // namespace

std::vector<PathElement> elementsOf(const RouteAnswer& route, const PathSpace& space,
                                    const PathFeed& feed) {
    std::vector<PathElement> elements;
    for (std::size_t i = 1; i < route.points.size(); ++i) {
        const PathElementResult made =
            line(space, pathPoint(route.points[i - 1]), pathPoint(route.points[i]));
        if (!made.ok()) continue;
        PathElement element = made.value();
        element.feed = feed;
        const core::Distance corner = route.points[i].corner;
        if (corner > core::Distance{}) {
            element.transition.mode = TransitionMode::CornerDistance;
            element.transition.size = corner;
        }
        elements.push_back(element);
    }
    return elements;
}

TrialResult tryRoute(const RouteAnswer& route, const TrialRequest& request,
                     const Obstacles& obstacles) {
    TrialResult result;
    const std::vector<PathElement> elements = elementsOf(route, request.space, request.feed);
    if (elements.empty()) return result;
    PathPlanner planner{request.space, request.limits, request.cycle, elements.size()};
    PathMotion motion = planner.motion();
    const auto cycles = planner.plan(elements, motion);
    if (!cycles.ok()) {
        result.fault = TrialFault::NoMotion;
        return result;
    }
    result.duration = request.cycle * static_cast<double>(cycles.value());
    PathDerivatives at;
    for (std::uint64_t cycle = 0; cycle <= cycles.value(); ++cycle) {
        motion.geometry.evaluate(motion.feed.at(cycle).s, at);
        const auto hit = collision(obstacles, Point{at.q}.first(request.space.axes));
        if (!hit) continue;
        result.fault = TrialFault::Collision;
        result.keepOut = *hit;
        return result;
    }
    return result;
}

}  // namespace takt::planner::roadmap
