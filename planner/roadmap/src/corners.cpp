#include "corners.hpp"

#include <algorithm>
#include <cmath>

namespace takt::planner::roadmap {

namespace {

/// One corner of a polyline between its neighbours, measured in path length.
class Corner {
public:
    Corner(Point before, Point point, Point after, const Metric& path)
        : before_{before},
          point_{point},
          after_{after},
          in_{path.distance(before, point)},
          out_{path.distance(point, after)} {}

    /// Half of the shorter leg: the rest belongs to the neighbours.
    [[nodiscard]] double most() const noexcept { return 0.5 * std::min(in_, out_); }

    /// The largest cut, up to `wanted`, whose triangle is free; 0 when there is next to none.
    [[nodiscard]] double room(const Obstacles& obstacles, double wanted) const {
        constexpr int Halvings = 20;
        constexpr double Negligible = 1e-3;
        const double limit = std::min(wanted, most());
        if (!(limit > 0.0) || triangleIsFree(obstacles, limit)) return std::max(limit, 0.0);
        double free = 0.0;
        double blocked = limit;
        for (int i = 0; i < Halvings; ++i) {
            const double middle = 0.5 * (free + blocked);
            (triangleIsFree(obstacles, middle) ? free : blocked) = middle;
        }
        return free < Negligible * limit ? 0.0 : free;
    }

    /// How far and where the corner goes so that a cut of `wanted` ends where it is now.
    [[nodiscard]] std::vector<double> outwards(double wanted) const {
        std::vector<double> shift(point_.size(), 0.0);
        if (!(in_ > 0.0 && out_ > 0.0)) return shift;
        const double cut = std::min(wanted, most());
        for (std::size_t i = 0; i < shift.size(); ++i) {
            const double inwards = (before_[i] - point_[i]) / in_ + (after_[i] - point_[i]) / out_;
            shift[i] = -0.5 * cut * inwards;
        }
        return shift;
    }

private:
    [[nodiscard]] bool triangleIsFree(const Obstacles& obstacles, double cut) const {
        return obstacles.isFree(point_, between(point_, before_, cut / in_),
                                between(point_, after_, cut / out_));
    }

    Point before_;
    Point point_;
    Point after_;
    double in_;
    double out_;
};

bool isWithinLimits(Point point, std::span<const RouteAxis> axes) noexcept {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        if (point[i] < axes[i].low.count() || point[i] > axes[i].high.count()) return false;
    }
    return true;
}

/// Moves a corner of the line outwards where that gives it more room.
void makeRoom(Polyline& line, std::size_t at, const Metric& path, const Obstacles& obstacles,
              const RouteRequest& request) {
    const double wanted = request.rounding.count();
    const Corner corner{line[at - 1], line[at], line[at + 1], path};
    const double room = corner.room(obstacles, wanted);
    if (room >= std::min(wanted, corner.most())) return;
    const std::vector<double> shift = corner.outwards(wanted);
    constexpr int Tries = 4;
    double share = 2.0;
    for (int i = 0; i < Tries; ++i) {
        share *= 0.5;
        std::vector<double> moved = line[at];
        for (std::size_t axis = 0; axis < moved.size(); ++axis) moved[axis] += share * shift[axis];
        if (!isWithinLimits(moved, request.axes) || !obstacles.isFree(line[at - 1], moved) ||
            !obstacles.isFree(moved, line[at + 1]))
            continue;
        const Corner there{line[at - 1], moved, line[at + 1], path};
        if (there.room(obstacles, wanted) <= room) continue;
        line[at] = std::move(moved);
        return;
    }
}

}  // namespace

std::vector<RoutePoint> roundCorners(Polyline line, const Obstacles& obstacles,
                                     const RouteRequest& request) {
    std::vector<double> factors(request.axes.size(), 0.0);
    std::fill_n(factors.begin(), std::min(request.pathAxes, factors.size()), 1.0);
    const Metric path{std::move(factors)};
    if (request.rounding.count() > 0.0) {
        for (std::size_t i = 1; i + 1 < line.size(); ++i)
            makeRoom(line, i, path, obstacles, request);
    }
    std::vector<RoutePoint> points;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool inner = i > 0 && i + 1 < line.size();
        const double corner = inner ? Corner{line[i - 1], line[i], line[i + 1], path}.room(
                                          obstacles, request.rounding.count())
                                    : 0.0;
        points.push_back({line[i], core::Distance{corner}});
    }
    return points;
}

}  // namespace takt::planner::roadmap
