#include <algorithm>
#include <limits>
#include <optional>

#include "shorten.hpp"

namespace takt::planner::roadmap {

namespace {

/// Products of directions, each axis by its factor.
double product(const Metric& metric, Point a, Point b, Point c, Point d) {
    double sum = 0.0;
    for (std::size_t i = 0; i < metric.axes(); ++i)
        sum += (b[i] - a[i]) * (d[i] - c[i]) * metric.factor(i) * metric.factor(i);
    return sum;
}

/// Where the legs a-b and d-c, made longer beyond b and c, come nearest to each other.
std::optional<std::vector<double>> meeting(const Metric& metric, Point a, Point b, Point c,
                                           Point d) {
    const double uu = product(metric, a, b, a, b);
    const double uv = product(metric, a, b, d, c);
    const double vv = product(metric, d, c, d, c);
    const double uw = product(metric, a, b, a, d);
    const double vw = product(metric, d, c, a, d);
    const double determinant = uu * vv - uv * uv;
    constexpr double Parallel = 1e-9;
    if (!(determinant > Parallel * uu * vv)) return std::nullopt;
    const double along = (uw * vv - uv * vw) / determinant;
    const double back = (uv * uw - uu * vw) / determinant;
    if (!(along > 1.0) || !(back > 1.0)) return std::nullopt;
    return between(between(a, b, along), between(d, c, back), 0.5);
}

bool isWithin(Point point, Point low, Point high) noexcept {
    for (std::size_t i = 0; i < point.size(); ++i) {
        if (point[i] < low[i] || point[i] > high[i]) return false;
    }
    return true;
}

}  // namespace

void mergeCorners(Polyline& line, const Obstacles& obstacles, const Metric& metric, Point low,
                  Point high, double most) {
    double spare = most - metric.length(line);
    while (line.size() > 3) {
        double least = spare;
        std::size_t place = 0;
        std::vector<double> corner;
        for (std::size_t i = 1; i + 2 < line.size(); ++i) {
            const auto candidate = meeting(metric, line[i - 1], line[i], line[i + 1], line[i + 2]);
            if (!candidate || !isWithin(*candidate, low, high)) continue;
            const double added =
                metric.distance(line[i - 1], *candidate) +
                metric.distance(*candidate, line[i + 2]) - metric.distance(line[i - 1], line[i]) -
                metric.distance(line[i], line[i + 1]) - metric.distance(line[i + 1], line[i + 2]);
            if (!(added < least) || !obstacles.isFree(line[i - 1], *candidate) ||
                !obstacles.isFree(*candidate, line[i + 2]))
                continue;
            least = added;
            place = i;
            corner = *candidate;
        }
        if (place == 0) return;
        spare -= least;
        line[place] = std::move(corner);
        line.erase(line.begin() + static_cast<std::ptrdiff_t>(place) + 1);
    }
}

}  // namespace takt::planner::roadmap
