#include "barrier.hpp"

#include <algorithm>
#include <cmath>
#include <takt/core/trigonometry.hpp>

namespace takt::planner::detail {

namespace {

/// The duration is within this part of the best for the grid and its limits.
constexpr double kGap = 1e-3;
constexpr int kMostSteps = 80;
/// Of the way to the nearest limit.
constexpr double kApproach = 0.9;
/// A use of the limits with which the search for the fastest may begin.
constexpr double kInside = 0.99995;

struct Point {
    double x;
    double slope;
    double bend;
};

Point pointAt(const Row& row, std::span<const double> c) noexcept {
    Point p{0.0, 0.0, 0.0};
    for (std::size_t k = 0; k < 3; ++k) {
        const double v = c[row.coefficient + k];
        p.x += row.x[k] * v;
        p.slope += row.slope[k] * v;
        p.bend += row.bend[k] * v;
    }
    return p;
}

double pull(const Term& t, const Point& p) noexcept {
    return 0.5 * t.q1 * p.slope + t.q2 * p.x;
}

double jolt(const Term& t, const Point& p) noexcept {
    return t.q3 * p.x + 1.5 * t.q2 * p.slope + 0.5 * t.q1 * p.bend;
}

/// A limit in the form slack >= 0, with the gradient of the slack.
struct Limit {
    double slack;
    double dx;
    double ds;
    double db;
    double dr;  ///< with respect to the relaxation
};

/// Calls `f` for every limit at a row, always in the same order.
template <typename F>
void forEachLimit(const Row& row, std::span<const Term> terms, const Point& p, double relax,
                  F&& f) noexcept {
    f(Limit{p.x, 1.0, 0.0, 0.0, 0.0});
    const double w = 1.0 / std::sqrt(p.x);
    if (row.acceleration) f(Limit{relax * row.xMax - p.x, -1.0, 0.0, 0.0, row.xMax});
    for (std::size_t k = row.firstTerm; k < row.endTerm; ++k) {
        const Term& t = terms[k];
        if (row.acceleration) {
            const double a = pull(t, p);
            if (t.high < unlimited) f(Limit{relax * t.high - a, -t.q2, -0.5 * t.q1, 0.0, t.high});
            if (t.low < unlimited) f(Limit{relax * t.low + a, t.q2, 0.5 * t.q1, 0.0, t.low});
        }
        if (!(t.jerk < unlimited)) continue;
        const double limit = t.jerk * w;
        const double fall = -0.5 * relax * limit / p.x;
        const double j = jolt(t, p);
        f(Limit{relax * limit - j, fall - t.q3, -1.5 * t.q2, -0.5 * t.q1, limit});
        f(Limit{relax * limit + j, fall + t.q3, 1.5 * t.q2, 0.5 * t.q1, limit});
    }
}

/// Gradient and matrix in (x, x', x'') of one row, and their mixture with the relaxation.
struct Local {
    double g[3]{};
    double h[6]{};  ///< xx, xs, xb, ss, sb, bb
    double mixed[3]{};

    void add(const Limit& l, double first, double second) noexcept {
        g[0] -= first * l.dx;
        g[1] -= first * l.ds;
        g[2] -= first * l.db;
        h[0] += second * l.dx * l.dx;
        h[1] += second * l.dx * l.ds;
        h[2] += second * l.dx * l.db;
        h[3] += second * l.ds * l.ds;
        h[4] += second * l.ds * l.db;
        h[5] += second * l.db * l.db;
        const double r = second * l.dr;
        mixed[0] += r * l.dx;
        mixed[1] += r * l.ds;
        mixed[2] += r * l.db;
    }
};

}  // namespace

void BarrierSolver::tieEnds(std::span<double> c) const noexcept {
    if (section_->fromRest) c[0] = c[1] / headTie_;
    c[c.size() - 1] = c[c.size() - 2] / tailTie_;
}

double BarrierSolver::duration() const noexcept {
    double sum = 0.0;
    for (const Row& row : rows_->rows) {
        if (row.time > 0.0) sum += row.time / std::sqrt(pointAt(row, c_).x);
    }
    return sum;
}

double BarrierSolver::greatestUse() const noexcept {
    double most = 0.0;
    for (const Row& row : rows_->rows) {
        const Point p = pointAt(row, c_);
        if (!(p.x > 0.0)) return unlimited;
        if (row.acceleration) most = std::max(most, p.x / row.xMax);
        const double root = std::sqrt(p.x);
        for (std::size_t k = row.firstTerm; k < row.endTerm; ++k) {
            const Term& t = rows_->terms[k];
            const double a = pull(t, p);
            if (row.acceleration) most = std::max(most, a > 0.0 ? a / t.high : -a / t.low);
            most = std::max(most, std::fabs(jolt(t, p)) * root / t.jerk);
        }
    }
    return most;
}

void BarrierSolver::assemble(const Goal& goal) noexcept {
    matrix_.reset(c_.size());
    std::fill(gradient_.begin(), gradient_.end(), 0.0);
    std::fill(column_.begin(), column_.end(), 0.0);
    relaxGradient_ = goal.relaxing ? 1.0 : 0.0;
    relaxCurvature_ = 0.0;
    std::size_t index = 0;
    for (const Row& row : rows_->rows) {
        const Point p = pointAt(row, c_);
        Local local;
        if (row.time > 0.0) {
            const double f = goal.duration * row.time / (std::sqrt(p.x) * p.x);
            local.g[0] -= 0.5 * f;
            local.h[0] += 0.75 * f / p.x;
        }
        forEachLimit(row, rows_->terms, p, relax_, [&](const Limit& l) {
            const double w = 1.0 / l.slack;
            const double first = barrier_ * w;
            const double second = multipliers_[index++] * w;
            local.add(l, first, second);
            relaxGradient_ -= first * l.dr;
            relaxCurvature_ += second * l.dr * l.dr;
        });
        for (std::size_t i = 0; i < 3; ++i) {
            const double x = row.x[i];
            const double s = row.slope[i];
            const double b = row.bend[i];
            const std::size_t at = row.coefficient + i;
            gradient_[at] += local.g[0] * x + local.g[1] * s + local.g[2] * b;
            column_[at] += local.mixed[0] * x + local.mixed[1] * s + local.mixed[2] * b;
            const double hx = local.h[0] * x + local.h[1] * s + local.h[2] * b;
            const double hs = local.h[1] * x + local.h[3] * s + local.h[4] * b;
            const double hb = local.h[2] * x + local.h[4] * s + local.h[5] * b;
            for (std::size_t k = i; k < 3; ++k)
                matrix_.at(at, k - i) += hx * row.x[k] + hs * row.slope[k] + hb * row.bend[k];
        }
    }
    foldEnds();
    ++steps_;
}

/// The outer coefficients are multiples of their neighbours: their shares go to those.
void BarrierSolver::foldEnds() noexcept {
    const std::size_t n = c_.size();
    if (section_->fromRest) {
        const double f = 1.0 / headTie_;
        matrix_.at(1, 0) += 2.0 * f * matrix_.at(0, 1) + f * f * matrix_.at(0, 0);
        matrix_.at(1, 1) += f * matrix_.at(0, 2);
        gradient_[1] += f * gradient_[0];
        column_[1] += f * column_[0];
    }
    const double f = 1.0 / tailTie_;
    matrix_.at(n - 2, 0) += 2.0 * f * matrix_.at(n - 2, 1) + f * f * matrix_.at(n - 1, 0);
    matrix_.at(n - 3, 1) += f * matrix_.at(n - 3, 2);
    gradient_[n - 2] += f * gradient_[n - 1];
    column_[n - 2] += f * column_[n - 1];
}

/// Newton's step for coefficients, relaxation and multipliers.
bool BarrierSolver::findStep(const Goal& goal) noexcept {
    if (!matrix_.factor(first_, last_)) return false;
    std::fill(step_.begin(), step_.end(), 0.0);
    for (std::size_t k = first_; k < last_; ++k) step_[k] = -gradient_[k];
    matrix_.solve(first_, last_, step_);
    pressure_ = 0.0;
    for (std::size_t k = first_; k < last_; ++k) pressure_ -= gradient_[k] * step_[k];
    relaxStep_ = 0.0;
    if (goal.relaxing) {
        // One more unknown that all limits share: a border of the banded matrix.
        std::vector<double>& border = gradient_;
        std::copy(column_.begin(), column_.end(), border.begin());
        matrix_.solve(first_, last_, border);
        double direct = relaxCurvature_;
        double right = -relaxGradient_;
        for (std::size_t k = first_; k < last_; ++k) {
            direct -= column_[k] * border[k];
            right -= column_[k] * step_[k];
        }
        if (!(direct > 0.0)) return false;
        relaxStep_ = right / direct;
        for (std::size_t k = first_; k < last_; ++k) step_[k] -= relaxStep_ * border[k];
    }
    tieEnds(step_);
    std::size_t index = 0;
    for (const Row& row : rows_->rows) {
        const Point p = pointAt(row, c_);
        const Point d = pointAt(row, step_);
        forEachLimit(row, rows_->terms, p, relax_, [&](const Limit& l) {
            const double change = l.dx * d.x + l.ds * d.slope + l.db * d.bend + l.dr * relaxStep_;
            const double z = multipliers_[index];
            multiplierSteps_[index++] = (barrier_ - z * change) / l.slack - z;
        });
    }
    return true;
}

bool BarrierSolver::inside(const Row& row, double part) const noexcept {
    Point p = pointAt(row, c_);
    const Point d = pointAt(row, step_);
    p = {p.x + part * d.x, p.slope + part * d.slope, p.bend + part * d.bend};
    if (!(p.x > 0.0)) return false;
    const double relax = relax_ + part * relaxStep_;
    bool good = true;
    forEachLimit(row, rows_->terms, p, relax,
                 [&](const Limit& l) { good = good && l.slack > 0.0; });
    return good;
}

double BarrierSolver::reach() noexcept {
    double part = 1.0 / kApproach;
    std::size_t row = 0;
    std::size_t good = 0;
    const std::size_t count = rows_->rows.size();
    // A row that was found inside is looked at again once the step has become shorter, because
    // limits of jerk need not be convex.
    while (good < count && part > 1e-9) {
        if (inside(rows_->rows[row], part)) {
            ++good;
            row = row + 1 == count ? 0 : row + 1;
        } else {
            part *= 0.85;
            good = 0;
        }
    }
    return part > 1e-9 ? kApproach * part : 0.0;
}

double BarrierSolver::move(double part) noexcept {
    double dual = 1.0;
    for (std::size_t i = 0; i < multipliers_.size(); ++i) {
        if (multiplierSteps_[i] < 0.0)
            dual = std::min(dual, -kApproach * multipliers_[i] / multiplierSteps_[i]);
    }
    for (std::size_t i = 0; i < c_.size(); ++i) c_[i] += part * step_[i];
    relax_ += part * relaxStep_;
    double sum = 0.0;
    std::size_t index = 0;
    for (const Row& row : rows_->rows) {
        forEachLimit(row, rows_->terms, pointAt(row, c_), relax_, [&](const Limit& l) {
            double& z = multipliers_[index];
            z += dual * multiplierSteps_[index++];
            sum += z * l.slack;
        });
    }
    return sum / static_cast<double>(index);
}

bool BarrierSolver::minimise(const Goal& goal) noexcept {
    std::size_t count = 0;
    for (const Row& row : rows_->rows)
        forEachLimit(row, rows_->terms, pointAt(row, c_), relax_, [&](const Limit&) { ++count; });
    const auto limits = static_cast<double>(count);
    multipliers_.resize(count);
    multiplierSteps_.resize(count);
    barrier_ = (goal.relaxing ? relax_ : goal.duration * duration()) / limits;
    std::size_t index = 0;
    for (const Row& row : rows_->rows) {
        forEachLimit(row, rows_->terms, pointAt(row, c_), relax_,
                     [&](const Limit& l) { multipliers_[index++] = barrier_ / l.slack; });
    }
    for (int i = 0; i < kMostSteps; ++i) {
        assemble(goal);
        if (!findStep(goal)) return !goal.relaxing;
        const double part = reach();
        if (part == 0.0) return !goal.relaxing;
        const double mean = move(part);
        if (goal.relaxing) {
            if (greatestUse() < kInside) return true;
            if (mean * limits < 1e-4) return false;
        } else if (mean * limits < kGap * duration()) {
            return true;
        }
        const double rest = 1.0 - std::min(part, 1.0);
        barrier_ =
            std::max(mean * std::clamp(rest * rest, 0.1, 0.8), 0.3 * rest * pressure_ / limits);
    }
    return !goal.relaxing;
}

void BarrierSolver::prepare(const Section& section, const Grid& grid, const Rows& rows) {
    section_ = &section;
    grid_ = &grid;
    rows_ = &rows;
    steps_ = 0;
    const std::size_t n = grid.cells() + 2;
    for (std::vector<double>* v : {&c_, &step_, &gradient_, &column_}) v->assign(n, 0.0);
    first_ = section.fromRest ? 1 : 2;
    last_ = n - 1;
    // The slope at the outer node is 4/3 x over the length to rest, both ways.
    const double h0 = grid.nodes[1] - grid.nodes[0];
    const double h1 = grid.nodes[grid.cells()] - grid.nodes[grid.cells() - 1];
    headTie_ = section.fromRest ? 1.0 + 2.0 / 3.0 * h0 / grid.head : 1.0;
    tailTie_ = 1.0 + 2.0 / 3.0 * h1 / grid.tail;
    relax_ = 1.0;
    guess();
}

bool BarrierSolver::solve(const Section& section, const Grid& grid, const Rows& rows) {
    prepare(section, grid, rows);
    if (first_ >= last_) return false;
    const double use = greatestUse();
    if (section.fromRest) {
        // Uses go with x or, those of jerk, with x^(3/2).
        const double ratio = 0.5 / use;
        const double factor = ratio < 1.0 ? ratio : core::cubeRoot(ratio * ratio);
        for (double& c : c_) c *= factor;
    } else if (!(use < kInside)) {
        if (!(use < unlimited)) return false;
        relax_ = 1.2 * use;
        if (!minimise({0.0, true})) return false;
        relax_ = 1.0;
    }
    return minimise({1.0, false});
}

}  // namespace takt::planner::detail
