#include <algorithm>
#include <cmath>
#include <takt/core/trigonometry.hpp>

#include "barrier.hpp"

namespace takt::planner::detail {

/// What the limits of a cell allow at constant speed, and how fast that may change along the way.
void BarrierSolver::findCeilings() noexcept {
    const std::size_t n = c_.size();
    ceilings_.assign(n, {unlimited, unlimited, unlimited});
    for (const Row& row : rows_->rows) {
        Ceiling& ceiling = ceilings_[row.coefficient + 1];
        if (row.acceleration) ceiling.x = std::min(ceiling.x, row.xMax);
        for (std::size_t k = row.firstTerm; k < row.endTerm; ++k) {
            const Term& t = rows_->terms[k];
            const double a = std::min(t.high, t.low);
            const double v = core::cubeRoot(t.jerk / std::fabs(t.q3));
            if (t.q2 != 0.0) ceiling.x = std::min(ceiling.x, a / std::fabs(t.q2));
            if (t.q3 != 0.0) ceiling.x = std::min(ceiling.x, v * v);
            if (t.q1 == 0.0) continue;
            ceiling.acceleration = std::min(ceiling.acceleration, a / std::fabs(t.q1));
            ceiling.jerk = std::min(ceiling.jerk, t.jerk / std::fabs(t.q1));
        }
    }
}

/// The greatest x a distance further on than `x`, with a part of acceleration and jerk. With full
/// jerk from rest x^(3/4) grows with the distance.
double BarrierSolver::climb(double x, double distance, const Ceiling& ceiling) noexcept {
    constexpr double kPart = 0.35;
    const double root = std::sqrt(x);
    const double y = root * std::sqrt(root) + 2.12 * kPart * std::sqrt(ceiling.jerk) * distance;
    const double byJerk = core::cubeRoot(y * y * y * y);
    return std::min({byJerk, x + 2.0 * kPart * ceiling.acceleration * distance, ceiling.x});
}

/// As fast as the ceilings let it with ramps up and down between them, and smoothed. In motion from
/// the given speed on; what that asks for too much is dealt with afterwards.
void BarrierSolver::guess() noexcept {
    const std::size_t n = c_.size();
    const auto& nodes = grid_->nodes;
    findCeilings();
    std::size_t fixed = 1;
    if (!section_->fromRest) {
        const double h = nodes[1] - nodes[0];
        c_[0] = section_->x0;
        c_[1] = section_->x0 + 0.5 * h * section_->slope0;
        fixed = 2;
    }
    const auto middle = [&](std::size_t i) { return 0.5 * (nodes[i - 1] + nodes[i]); };
    double x = section_->fromRest ? 0.0 : section_->x0;
    double s = section_->from;
    for (std::size_t i = fixed; i + 1 < n; ++i) {
        x = c_[i] = climb(x, middle(i) - s, ceilings_[i]);
        s = middle(i);
    }
    x = 0.0;
    s = section_->to;
    for (std::size_t i = n - 1; i-- > fixed;) {
        x = c_[i] = std::min(c_[i], climb(x, s - middle(i), ceilings_[i]));
        s = middle(i);
    }
    for (int round = 0; round < 4; ++round) {
        double before = c_[fixed];
        for (std::size_t i = fixed + 1; i + 2 < n; ++i) {
            const double mean = 0.25 * (before + 2.0 * c_[i] + c_[i + 1]);
            before = c_[i];
            c_[i] = std::min(mean, 1.3 * c_[i]);
        }
    }
    tieEnds(c_);
}

}  // namespace takt::planner::detail
