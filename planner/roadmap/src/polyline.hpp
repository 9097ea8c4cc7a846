#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <takt/planner/roadmap/obstacles.hpp>
#include <vector>

namespace takt::planner::roadmap {

using Polyline = std::vector<std::vector<double>>;

/// Measures distances with a factor for each axis; 0 leaves an axis out.
class Metric {
public:
    explicit Metric(std::vector<double> factors) : factors_{std::move(factors)} {}

    [[nodiscard]] std::size_t axes() const noexcept { return factors_.size(); }
    [[nodiscard]] double factor(std::size_t axis) const noexcept { return factors_[axis]; }
    [[nodiscard]] double distance(Point a, Point b) const noexcept {
        return distance(a.data(), b.data());
    }
    [[nodiscard]] double distance(const double* a, const double* b) const noexcept {
        double sum = 0.0;
        for (std::size_t i = 0; i < factors_.size(); ++i) {
            const double d = (a[i] - b[i]) * factors_[i];
            sum += d * d;
        }
        return std::sqrt(sum);
    }
    [[nodiscard]] double length(const Polyline& line) const noexcept {
        double sum = 0.0;
        for (std::size_t i = 1; i < line.size(); ++i) sum += distance(line[i - 1], line[i]);
        return sum;
    }

private:
    std::vector<double> factors_;
};

[[nodiscard]] inline std::vector<double> between(Point a, Point b, double share) {
    std::vector<double> point(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) point[i] = a[i] + share * (b[i] - a[i]);
    return point;
}

}  // namespace takt::planner::roadmap
