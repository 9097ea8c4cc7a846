#include "scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <takt/core/random.hpp>

namespace takt::planner::roadmap::test {

using core::Distance;
using core::Position;
using core::Velocity;

namespace {

constexpr double Size = 400.0;  // each axis runs from 0 to it

std::size_t integer(core::Random& random, std::size_t low, std::size_t high) {
    return low + static_cast<std::size_t>(random.upTo(high - low));
}

KeepOutSpan randomSpan(core::Random& random, std::size_t axis) {
    const double from = random.uniform(40.0, 320.0);
    return {axis, Position{from}, Position{from + random.uniform(20.0, 120.0)}};
}

KeepOutParams randomBox(core::Random& random, std::size_t axes) {
    KeepOutParams box;
    for (std::size_t axis = 0; axis < axes; ++axis) box.spans.push_back(randomSpan(random, axis));
    return box;
}

KeepOutParams randomCylinder(core::Random& random, std::size_t axes) {
    KeepOutParams cylinder;
    const std::size_t along = axes == 3 ? integer(random, 0, 2) : 2;
    cylinder.disc = KeepOutDisc{
        along == 0 ? 1U : 0U, along == 2 ? 1U : 2U, Position{random.uniform(80.0, 320.0)},
        Position{random.uniform(80.0, 320.0)}, Distance{random.uniform(15.0, 70.0)}};
    if (axes == 3) cylinder.spans.push_back(randomSpan(random, along));
    return cylinder;
}

/// A wall across the first axis, with a gap at one end of the second.
KeepOutParams randomWall(core::Random& random) {
    KeepOutParams wall;
    const double from = random.uniform(150.0, 230.0);
    wall.spans.push_back({0, Position{from}, Position{from + random.uniform(5.0, 20.0)}});
    KeepOutSpan across{1, {}, {}};
    if (random.uniform() < 0.5) {
        across.from = Position{-std::numeric_limits<double>::infinity()};
        across.to = Position{random.uniform(200.0, 340.0)};
    } else {
        across.from = Position{random.uniform(60.0, 200.0)};
        across.to = Position{std::numeric_limits<double>::infinity()};
    }
    wall.spans.push_back(across);
    return wall;
}

std::vector<double> freePoint(core::Random& random, const Scene& scene, double low, double high) {
    std::vector<double> point(scene.axes.size());
    do {
        for (double& value : point) value = random.uniform(10.0, Size - 10.0);
        point[0] = random.uniform(low, high);
    } while (depth(scene, point) > -1.0);
    return point;
}

}  // namespace

RouteRequest Scene::request() const {
    RouteRequest request;
    request.start = start;
    request.goal = goal;
    request.axes = axes;
    request.rounding = Distance{10.0};
    request.seed = seed;
    return request;
}

Scene randomScene(std::uint64_t seed, std::size_t axes) {
    core::Random random{seed};
    Scene scene;
    scene.seed = seed;
    const double speeds[] = {500.0, 800.0, 300.0};
    const bool even = random.uniform() < 0.5;
    for (std::size_t axis = 0; axis < axes; ++axis)
        scene.axes.push_back(
            {Position{0.0}, Position{Size}, Velocity{even ? 500.0 : speeds[axis]}});
    const std::size_t count = integer(random, 5, 10);
    for (std::size_t i = 0; i < count; ++i) {
        const bool box = random.uniform() < 0.5;
        scene.keepOuts.push_back(box ? randomBox(random, axes) : randomCylinder(random, axes));
    }
    if (random.uniform() < 0.5) scene.keepOuts.push_back(randomWall(random));
    for (KeepOutParams& keepOut : scene.keepOuts)
        keepOut.clearance = Distance{random.uniform(0.0, 8.0)};
    scene.start = freePoint(random, scene, 5.0, 120.0);
    scene.goal = freePoint(random, scene, 280.0, 395.0);
    return scene;
}

double depth(const KeepOutParams& keepOut, const std::vector<double>& point) {
    double least = std::numeric_limits<double>::infinity();
    const double clearance = keepOut.clearance.count();
    for (const KeepOutSpan& span : keepOut.spans) {
        const double p = point[span.axis];
        least =
            std::min({least, p - span.from.count() + clearance, span.to.count() + clearance - p});
    }
    if (keepOut.disc) {
        const KeepOutDisc& disc = *keepOut.disc;
        const double away = std::hypot(point[disc.firstAxis] - disc.firstCentre.count(),
                                       point[disc.secondAxis] - disc.secondCentre.count());
        least = std::min(least, disc.radius.count() + clearance - away);
    }
    return least;
}

double depth(const Scene& scene, const std::vector<double>& point) {
    double most = -std::numeric_limits<double>::infinity();
    for (const KeepOutParams& keepOut : scene.keepOuts)
        most = std::max(most, depth(keepOut, point));
    return most;
}

std::string textOf(const RouteAnswer& answer) {
    std::string text;
    char number[64];
    const auto add = [&](double value) {
        std::snprintf(number, sizeof number, "%a ", value);
        text += number;
    };
    add(static_cast<double>(answer.fault));
    add(static_cast<double>(answer.iterations));
    add(answer.length.count());
    for (const RoutePoint& point : answer.points) {
        for (const double value : point.position) add(value);
        add(point.corner.count());
    }
    return text + "\n";
}

}  // namespace takt::planner::roadmap::test
