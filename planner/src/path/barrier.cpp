#include "barrier.hpp"

#include <algorithm>
#include <cmath>

namespace takt::planner::detail {

namespace {

/// The duration is within this part of the best for the grid and its limits.
constexpr double kGap = 1e-3;
constexpr int kMostSteps = 120;
constexpr int kMostPhaseOneSteps = 80;
constexpr double kBarrierFall = 0.2;
/// Of the way to the nearest limit.
constexpr double kApproach = 0.9;

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

/// Gradient and matrix in (x, x', x'') of one row, and their mixture with the relaxation.
struct Local {
    double g[3]{};
    double h[6]{};  ///< xx, xs, xb, ss, sb, bb
    double mixed[3]{};
    double relaxG{0.0};
    double relaxH{0.0};

    /// The barrier in front of slack = relax * limit - value; `d` is its gradient in (x, x', x'').
    void add(double barrier, double slack, double dx, double ds, double db, double limit) noexcept {
        const double w = 1.0 / slack;
        const double f = barrier * w;
        const double ff = f * w;
        g[0] -= f * dx;
        g[1] -= f * ds;
        g[2] -= f * db;
        h[0] += ff * dx * dx;
        h[1] += ff * dx * ds;
        h[2] += ff * dx * db;
        h[3] += ff * ds * ds;
        h[4] += ff * ds * db;
        h[5] += ff * db * db;
        relaxG -= f * limit;
        relaxH += ff * limit * limit;
        mixed[0] += ff * limit * dx;
        mixed[1] += ff * limit * ds;
        mixed[2] += ff * limit * db;
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

double BarrierSolver::greatestUse(std::span<const double> c) const noexcept {
    double most = 0.0;
    for (const Row& row : rows_->rows) {
        const Point p = pointAt(row, c);
        if (!(p.x > 0.0)) return unlimited;
        if (row.acceleration) most = std::max(most, p.x / row.xMax);
        const double root = std::sqrt(p.x);
        for (std::size_t k = row.firstTerm; k < row.endTerm; ++k) {
            const Term& t = rows_->terms[k];
            if (row.acceleration) {
                const double a = pull(t, p);
                most = std::max(most, a > 0.0 ? a / t.high : -a / t.low);
            }
            most = std::max(most, std::fabs(jolt(t, p)) * root / t.jerk);
        }
    }
    return most;
}

/// As near both ends as from rest and to it, and so slow that no limit is used by more than half:
/// all uses fall at least in proportion to x.
void BarrierSolver::startFromRest() noexcept {
    const std::size_t n = c_.size();
    const double a = section_->from;
    const double b = section_->to;
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double s = 0.5 * (grid_->nodes[i - 1] + grid_->nodes[i]);
        const double l = s - a;
        const double r = b - s;
        // l^(4/3) near the beginning and r^(4/3) near the end, without roots of roots.
        const double rise = l * std::sqrt(std::sqrt(l * std::sqrt(l)));
        const double fall = r * std::sqrt(std::sqrt(r * std::sqrt(r)));
        c_[i] = rise * fall / (rise + fall);
    }
    tieEnds(c_);
    const double use = greatestUse(c_);
    for (double& c : c_) c *= 0.5 / use;
}

/// From the given speed down along the way; what that asks for too much is dealt with afterwards.
void BarrierSolver::startInMotion() noexcept {
    const std::size_t n = c_.size();
    const double h = grid_->nodes[1] - grid_->nodes[0];
    c_[0] = section_->x0;
    c_[1] = section_->x0 + 0.5 * h * section_->slope0;
    const double length = section_->to - section_->from;
    for (std::size_t i = 2; i + 1 < n; ++i) {
        const double s = 0.5 * (grid_->nodes[i - 1] + grid_->nodes[i]);
        const double r = (section_->to - s) / length;
        c_[i] = section_->x0 * r * std::sqrt(std::sqrt(r * std::sqrt(r)));
    }
    tieEnds(c_);
}

void BarrierSolver::addRow(const Row& row, double objective, double barrier,
                           double relax) noexcept {
    const Point p = pointAt(row, c_);
    const double root = std::sqrt(p.x);
    const double w = 1.0 / root;
    Local local;
    if (row.time > 0.0) {
        const double f = objective * row.time * w / p.x;
        local.g[0] -= 0.5 * f;
        local.h[0] += 0.75 * f / p.x;
    }
    local.add(barrier, p.x, 1.0, 0.0, 0.0, 0.0);
    if (row.acceleration && row.xMax < unlimited)
        local.add(barrier, relax * row.xMax - p.x, -1.0, 0.0, 0.0, row.xMax);
    for (std::size_t k = row.firstTerm; k < row.endTerm; ++k) {
        const Term& t = rows_->terms[k];
        if (row.acceleration) {
            const double a = pull(t, p);
            if (t.high < unlimited)
                local.add(barrier, relax * t.high - a, -t.q2, -0.5 * t.q1, 0.0, t.high);
            if (t.low < unlimited)
                local.add(barrier, relax * t.low + a, t.q2, 0.5 * t.q1, 0.0, t.low);
        }
        if (!(t.jerk < unlimited)) continue;
        const double limit = t.jerk * w;
        const double fall = -0.5 * relax * limit / p.x;
        const double j = jolt(t, p);
        local.add(barrier, relax * limit - j, fall - t.q3, -1.5 * t.q2, -0.5 * t.q1, limit);
        local.add(barrier, relax * limit + j, fall + t.q3, 1.5 * t.q2, 0.5 * t.q1, limit);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = row.x[i];
        const double s = row.slope[i];
        const double b = row.bend[i];
        const std::size_t at = row.coefficient + i;
        gradient_[at] += local.g[0] * x + local.g[1] * s + local.g[2] * b;
        relaxColumn_[at] += local.mixed[0] * x + local.mixed[1] * s + local.mixed[2] * b;
        const double hx = local.h[0] * x + local.h[1] * s + local.h[2] * b;
        const double hs = local.h[1] * x + local.h[3] * s + local.h[4] * b;
        const double hb = local.h[2] * x + local.h[4] * s + local.h[5] * b;
        for (std::size_t k = i; k < 3; ++k)
            matrix_.at(at, k - i) += hx * row.x[k] + hs * row.slope[k] + hb * row.bend[k];
    }
    relaxGradient_ += local.relaxG;
    relaxCurvature_ += local.relaxH;
}

/// The outer coefficients are multiples of their neighbours: their shares go to those.
void BarrierSolver::foldEnds() noexcept {
    const std::size_t n = c_.size();
    if (section_->fromRest) {
        const double f = 1.0 / headTie_;
        matrix_.at(1, 0) += 2.0 * f * matrix_.at(0, 1) + f * f * matrix_.at(0, 0);
        matrix_.at(1, 1) += f * matrix_.at(0, 2);
        gradient_[1] += f * gradient_[0];
        relaxColumn_[1] += f * relaxColumn_[0];
    }
    const double f = 1.0 / tailTie_;
    matrix_.at(n - 2, 0) += 2.0 * f * matrix_.at(n - 2, 1) + f * f * matrix_.at(n - 1, 0);
    matrix_.at(n - 3, 1) += f * matrix_.at(n - 3, 2);
    gradient_[n - 2] += f * gradient_[n - 1];
    relaxColumn_[n - 2] += f * relaxColumn_[n - 1];
}

void BarrierSolver::assemble(double objective, double barrier, double relax) noexcept {
    matrix_.reset(c_.size());
    std::fill(gradient_.begin(), gradient_.end(), 0.0);
    std::fill(relaxColumn_.begin(), relaxColumn_.end(), 0.0);
    relaxGradient_ = 0.0;
    relaxCurvature_ = 0.0;
    for (const Row& row : rows_->rows) addRow(row, objective, barrier, relax);
    foldEnds();
    ++steps_;
}

double BarrierSolver::slope() const noexcept {
    double sum = 0.0;
    for (std::size_t i = first_; i < last_; ++i) sum += gradient_[i] * step_[i];
    return sum;
}

bool BarrierSolver::inside(const Row& row, std::span<const double> c, double relax) const noexcept {
    const Point p = pointAt(row, c);
    if (!(p.x > 0.0)) return false;
    if (row.acceleration && !(p.x < relax * row.xMax)) return false;
    const double root = std::sqrt(p.x);
    for (std::size_t k = row.firstTerm; k < row.endTerm; ++k) {
        const Term& t = rows_->terms[k];
        if (row.acceleration) {
            const double a = pull(t, p);
            if (!(a < relax * t.high && a > -relax * t.low)) return false;
        }
        if (!(std::fabs(jolt(t, p)) * root < relax * t.jerk)) return false;
    }
    return true;
}

double BarrierSolver::reach(double relax, double relaxStep) const noexcept {
    double part = 1.0 / kApproach;
    auto& trial = const_cast<std::vector<double>&>(trial_);
    std::size_t row = 0;
    const auto place = [&] {
        for (std::size_t i = 0; i < c_.size(); ++i) trial[i] = c_[i] + part * step_[i];
    };
    place();
    // A row that has been found inside is looked at again when the step has become shorter only
    // because its limits need not be convex.
    std::size_t good = 0;
    const std::size_t count = rows_->rows.size();
    while (good < count && part > 1e-9) {
        if (inside(rows_->rows[row], trial, relax + part * relaxStep)) {
            ++good;
            row = row + 1 == count ? 0 : row + 1;
        } else {
            part *= 0.8;
            place();
            good = 0;
        }
    }
    return part > 1e-9 ? kApproach * part : 0.0;
}

void BarrierSolver::move(double part) noexcept {
    for (std::size_t i = 0; i < c_.size(); ++i) c_[i] += part * step_[i];
}

/// Until all limits are kept: their common relaxation is the objective.
bool BarrierSolver::findInside() noexcept {
    double relax = greatestUse(c_);
    if (!(relax < unlimited)) return false;
    if (relax < 0.999) return true;
    relax *= 1.2;
    double barrier = relax / limitCount_;
    std::vector<double> column(c_.size());
    for (int i = 0; i < kMostPhaseOneSteps; ++i) {
        assemble(0.0, barrier, relax);
        std::copy(relaxColumn_.begin(), relaxColumn_.end(), column.begin());
        if (!matrix_.factor(first_, last_)) return false;
        std::fill(step_.begin(), step_.end(), 0.0);
        for (std::size_t k = first_; k < last_; ++k) step_[k] = -gradient_[k];
        matrix_.solve(first_, last_, step_);
        matrix_.solve(first_, last_, column);
        double direct = relaxCurvature_;
        double right = -(1.0 + relaxGradient_);
        for (std::size_t k = first_; k < last_; ++k) {
            direct -= relaxColumn_[k] * column[k];
            right -= relaxColumn_[k] * step_[k];
        }
        if (!(direct > 0.0)) return false;
        const double relaxStep = right / direct;
        for (std::size_t k = first_; k < last_; ++k) step_[k] -= relaxStep * column[k];
        tieEnds(step_);
        if (!section_->fromRest) step_[0] = step_[1] = 0.0;
        const double part = reach(relax, relaxStep);
        if (part == 0.0) return false;
        move(part);
        relax += part * relaxStep;
        const double use = greatestUse(c_);
        if (use < 0.998) return true;
        if (part > 0.3) barrier *= kBarrierFall;
        if (barrier * limitCount_ < 1e-6) return false;
    }
    return false;
}

bool BarrierSolver::improve() noexcept {
    double time = duration();
    double barrier = time / limitCount_;
    for (int i = 0; i < kMostSteps; ++i) {
        assemble(1.0, barrier, 1.0);
        if (!matrix_.factor(first_, last_)) return false;
        std::fill(step_.begin(), step_.end(), 0.0);
        for (std::size_t k = first_; k < last_; ++k) step_[k] = -gradient_[k];
        matrix_.solve(first_, last_, step_);
        tieEnds(step_);
        if (!section_->fromRest) step_[0] = step_[1] = 0.0;
        const double decrement = -slope() / barrier;
        const double part = reach(1.0, 0.0);
        move(part);
        time = duration();
        if (part == 0.0) return true;
        if (part > 0.5 || decrement < 1.0) {
            if (barrier * limitCount_ < kGap * time) return true;
            barrier *= kBarrierFall;
        }
    }
    return true;
}

bool BarrierSolver::solve(const Section& section, const Grid& grid, const Rows& rows) {
    section_ = &section;
    grid_ = &grid;
    rows_ = &rows;
    steps_ = 0;
    const std::size_t n = grid.cells() + 2;
    c_.assign(n, 0.0);
    step_.assign(n, 0.0);
    gradient_.assign(n, 0.0);
    relaxColumn_.assign(n, 0.0);
    trial_.assign(n, 0.0);
    first_ = section.fromRest ? 1 : 2;
    last_ = n - 1;
    if (first_ >= last_) return false;
    // The slope at the outer node is 4/3 x over the length to rest, both ways.
    const double h0 = grid.nodes[1] - grid.nodes[0];
    const double h1 = grid.nodes[grid.cells()] - grid.nodes[grid.cells() - 1];
    headTie_ = section.fromRest ? 1.0 + 2.0 / 3.0 * h0 / grid.head : 1.0;
    tailTie_ = 1.0 + 2.0 / 3.0 * h1 / grid.tail;
    limitCount_ = 0.0;
    for (const Row& row : rows.rows)
        limitCount_ += 2.0 + (row.acceleration ? 4.0 : 2.0) * (row.endTerm - row.firstTerm);
    if (section.fromRest) {
        startFromRest();
    } else {
        startInMotion();
        if (!findInside()) return false;
    }
    return improve();
}

}  // namespace takt::planner::detail
