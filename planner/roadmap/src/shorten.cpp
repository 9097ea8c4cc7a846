#include "shorten.hpp"

#include <algorithm>

namespace takt::planner::roadmap {

namespace {

/// From each point straight to the last one that can be reached so.
void dropPoints(Polyline& line, const Obstacles& obstacles) {
    Polyline kept;
    kept.push_back(line.front());
    std::size_t here = 0;
    while (here + 1 < line.size()) {
        std::size_t next = line.size() - 1;
        while (next > here + 1 && !obstacles.isFree(line[here], line[next])) --next;
        kept.push_back(line[next]);
        here = next;
    }
    line = std::move(kept);
}

/// A place on the polyline: on the leg after point `leg`.
struct Place {
    std::size_t leg{0};
    std::vector<double> point;
};

Place placeAt(const Polyline& line, const Metric& metric, double length) {
    std::size_t leg = 0;
    double rest = length;
    for (; leg + 2 < line.size(); ++leg) {
        const double step = metric.distance(line[leg], line[leg + 1]);
        if (rest <= step) break;
        rest -= step;
    }
    const double step = metric.distance(line[leg], line[leg + 1]);
    const double share = step > 0.0 ? std::min(rest / step, 1.0) : 0.0;
    return {leg, between(line[leg], line[leg + 1], share)};
}

void join(Polyline& line, Place first, Place second) {
    const auto begin = line.begin() + static_cast<std::ptrdiff_t>(first.leg) + 1;
    const auto end = line.begin() + static_cast<std::ptrdiff_t>(second.leg) + 1;
    const auto place = line.erase(begin, end);
    line.insert(place, {std::move(first.point), std::move(second.point)});
}

/// Cuts a corner where half, a quarter … of its legs can be cut off, and says so.
bool cutCorner(Polyline& line, std::size_t at, const Obstacles& obstacles) {
    constexpr int Tries = 6;
    double share = 1.0;
    for (int i = 0; i < Tries; ++i) {
        share *= 0.5;
        std::vector<double> before = between(line[at], line[at - 1], share);
        std::vector<double> after = between(line[at], line[at + 1], share);
        if (!obstacles.isFree(before, after)) continue;
        line[at] = std::move(before);
        line.insert(line.begin() + static_cast<std::ptrdiff_t>(at) + 1, std::move(after));
        return true;
    }
    return false;
}

void cutCorners(Polyline& line, const Obstacles& obstacles) {
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        if (cutCorner(line, i, obstacles)) ++i;
    }
}

}  // namespace

void shorten(Polyline& line, const Obstacles& obstacles, const Metric& metric, core::Random& random,
             std::uint32_t tries) {
    constexpr std::uint32_t Batch = 25;
    dropPoints(line, obstacles);
    for (std::uint32_t i = 0; i < tries && line.size() > 2; ++i) {
        const double length = metric.length(line);
        double from = random.uniform(0.0, length);
        double to = random.uniform(0.0, length);
        if (from > to) std::swap(from, to);
        Place first = placeAt(line, metric, from);
        Place second = placeAt(line, metric, to);
        const bool shorter = first.leg < second.leg;
        if (shorter && obstacles.isFree(first.point, second.point))
            join(line, std::move(first), std::move(second));
        if (i % Batch == Batch - 1) {
            cutCorners(line, obstacles);
            dropPoints(line, obstacles);
        }
    }
    dropPoints(line, obstacles);
}

}  // namespace takt::planner::roadmap
