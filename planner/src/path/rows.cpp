#include <algorithm>
#include <cmath>
#include <takt/core/trigonometry.hpp>

#include "section.hpp"

namespace takt::planner::detail {

namespace {

constexpr double kNothing = 1e-12;
/// Around a joint with jumps the motion itself has this share of the jerk limits, for as many
/// cycles on either side as a third difference reaches.
constexpr double kJerkShareAtJoint = 0.5;
constexpr double kCyclesAtJoint = 3.0;

/// A quadratic spline on the nodes of a grid, as sums of three coefficients.
class Spline {
public:
    explicit Spline(const Grid& grid) noexcept : nodes_{grid.nodes} {}

    /// x, x', x'' at a share of a cell.
    void weights(std::size_t cell, double share, Row& row) const noexcept {
        const double h = width(cell);
        const double before = cell == 0 ? 0.0 : width(cell - 1);
        const double after = cell + 2 == nodes_.size() ? 0.0 : width(cell + 1);
        const double left = 1.0 / (before + h);
        const double right = 1.0 / (h + after);
        const double slopeLeft[3] = {-2.0 * left, 2.0 * left, 0.0};
        const double slopeRight[3] = {0.0, -2.0 * right, 2.0 * right};
        const double valueLeft[3] = {h * left, before * left, 0.0};
        const double way = share * h;
        row.coefficient = static_cast<std::uint32_t>(cell);
        for (int k = 0; k < 3; ++k) {
            row.bend[k] = (slopeRight[k] - slopeLeft[k]) / h;
            row.slope[k] = slopeLeft[k] + way * row.bend[k];
            row.x[k] = valueLeft[k] + way * (slopeLeft[k] + 0.5 * way * row.bend[k]);
        }
    }

private:
    [[nodiscard]] double width(std::size_t cell) const noexcept {
        return nodes_[cell + 1] - nodes_[cell];
    }

    const std::vector<double>& nodes_;
};

class Maker {
public:
    Maker(const PathGeometry& geometry, const Section& section, const Grid& grid,
          const LimitSet& limits, Rows& out)
        : geometry_{geometry},
          section_{section},
          grid_{grid},
          limits_{limits},
          out_{out},
          spline_{grid} {}

    void make() {
        out_.rows.clear();
        out_.terms.clear();
        findJoints();
        if (!section_.fromRest) findStart();
        if (grid_.head > 0.0) makeRest(true);
        for (std::size_t cell = 0; cell < grid_.cells(); ++cell) makeCell(cell);
        makeRest(false);
        boundCoefficients();
    }

private:
    struct Joint {
        double s;
        double x;
        double around;
    };

    void findJoints();
    void findStart();
    void relaxAtStart(Row& row, double s);
    void makeCell(std::size_t cell);
    void boundCoefficients();
    void makeRest(bool head);
    void addRow(Row row, std::uint32_t piece, double s, bool first);
    void addTerms(std::uint32_t piece, const PathDerivatives& at, double jerkShare);
    [[nodiscard]] double jerkShareAt(double s) const noexcept;

    const PathGeometry& geometry_;
    const Section& section_;
    const Grid& grid_;
    const LimitSet& limits_;
    Rows& out_;
    Spline spline_;
    std::vector<Joint> joints_;
    double speedAtStart_{1.0};
    double pullAtStart_{1.0};
    double startLength_{0.0};
};

void Maker::findJoints() {
    for (std::size_t i = geometry_.pieceAt(section_.from); i + 1 < geometry_.pieceCount(); ++i) {
        const PathPiece& piece = geometry_.piece(i);
        const double s = piece.start + piece.length;
        if (s >= section_.to) break;
        const double x = jointLimit(geometry_, i, limits_);
        if (!(x < unlimited)) continue;
        // A bound that was only asked for needs no room; one from a jump does.
        const bool asked = x >= piece.endVelocity * piece.endVelocity;
        joints_.push_back({s, x, asked ? 0.0 : kCyclesAtJoint * limits_.cycle * std::sqrt(x)});
    }
}

/// A feed in motion may use its limits up to the share that it was planned with. So that there is
/// a way on, the limits begin half way between that and the whole, and fall to their share soon.
void Maker::findStart() {
    PathDerivatives at;
    geometry_.evaluate(grid_.pieces.front(), section_.from, at);
    const double v = std::sqrt(section_.x0);
    const PathFeed feed = geometry_.feedOf(grid_.pieces.front());
    const double s2 = 0.5 * section_.slope0;
    double speed = v / feed.velocity.count();
    double pull = std::max(s2 / feed.acceleration.count(), -s2 / feed.deceleration.count());
    double rise = 0.0;
    for (std::size_t i = 0; i < limits_.axes.size(); ++i) {
        const PathAxisLimits& axis = limits_.axes[i];
        speed = std::max(speed, std::fabs(at.d1[i]) * v / axis.velocity.count());
        const double a = at.d1[i] * s2 + at.d2[i] * section_.x0;
        pull = std::max(pull, std::fabs(a) / axis.acceleration.count());
        rise = std::max(rise, axis.acceleration.count() / axis.jerk.count());
    }
    speedAtStart_ = std::max(1.0, (0.5 + 0.5 * speed) / limits_.speedShare);
    pullAtStart_ = std::max(1.0, (0.5 + 0.5 * pull) / limits_.share);
    startLength_ = v * rise;
}

void Maker::relaxAtStart(Row& row, double s) {
    const double near = 1.0 - (s - section_.from) / startLength_;
    if (!(near > 0.0)) return;
    const double speed = 1.0 + (speedAtStart_ - 1.0) * near;
    const double pull = 1.0 + (pullAtStart_ - 1.0) * near;
    row.xMax *= speed * speed;
    for (std::size_t k = row.firstTerm; k < row.endTerm; ++k) {
        out_.terms[k].low *= pull;
        out_.terms[k].high *= pull;
        out_.terms[k].jerk *= pull;
    }
}

double Maker::jerkShareAt(double s) const noexcept {
    for (const Joint& joint : joints_) {
        if (std::fabs(s - joint.s) <= joint.around) return kJerkShareAtJoint;
    }
    return 1.0;
}

void Maker::addTerms(std::uint32_t piece, const PathDerivatives& at, double jerkShare) {
    const double f = limits_.share;
    bool straight = true;
    for (std::size_t i = 0; i < limits_.axes.size(); ++i)
        straight =
            straight && !(std::fabs(at.d2[i]) > kNothing) && !(std::fabs(at.d3[i]) > kNothing);
    if (straight) {
        const LineLimits line = lineLimits(geometry_, piece, at, limits_);
        out_.terms.push_back(
            {1.0, 0.0, 0.0, line.deceleration, line.acceleration, line.jerk * jerkShare});
        return;
    }
    for (std::size_t i = 0; i < limits_.axes.size(); ++i) {
        const double most =
            std::max({std::fabs(at.d1[i]), std::fabs(at.d2[i]), std::fabs(at.d3[i])});
        if (!(most > kNothing)) continue;
        const double a = limits_.axes[i].acceleration.count() * f;
        out_.terms.push_back(
            {at.d1[i], at.d2[i], at.d3[i], a, a, limits_.axes[i].jerk.count() * f * jerkShare});
    }
    const PathFeed feed = geometry_.feedOf(piece);
    if (feed.acceleration.count() < unlimited || feed.deceleration.count() < unlimited ||
        feed.jerk.count() < unlimited) {
        out_.terms.push_back({1.0, 0.0, 0.0, feed.deceleration.count() * f,
                              feed.acceleration.count() * f, feed.jerk.count() * f * jerkShare});
    }
}

void Maker::addRow(Row row, std::uint32_t piece, double s, bool first) {
    PathDerivatives at;
    geometry_.evaluate(piece, s, at);
    row.xMax = unlimited;
    if (row.acceleration) {
        row.xMax = lineLimits(geometry_, piece, at, limits_).x;
        for (const Joint& joint : joints_) {
            if (joint.s == s) row.xMax = std::min(row.xMax, joint.x);
        }
    }
    // The state at the start is given.
    if (first && !section_.fromRest) row.acceleration = false;
    row.firstTerm = static_cast<std::uint32_t>(out_.terms.size());
    addTerms(piece, at, jerkShareAt(s));
    row.endTerm = static_cast<std::uint32_t>(out_.terms.size());
    if (!section_.fromRest) relaxAtStart(row, s);
    out_.rows.push_back(row);
}

void Maker::makeCell(std::size_t cell) {
    const double left = grid_.nodes[cell];
    const double h = grid_.nodes[cell + 1] - left;
    const std::uint32_t piece = grid_.pieces[cell];
    const bool newPiece = cell + 1 < grid_.cells() && grid_.pieces[cell + 1] != piece;
    for (const double share : {0.0, 0.5, 1.0}) {
        Row row{};
        spline_.weights(cell, share, row);
        row.acceleration = share < 1.0 || newPiece || cell + 1 == grid_.cells();
        row.time = (share == 0.5 ? 4.0 : 1.0) * h / 6.0;
        const double s = share == 1.0 ? grid_.nodes[cell + 1] : left + share * h;
        addRow(row, piece, s, cell == 0 && share == 0.0);
    }
}

/// A spline stays below its coefficients. So the velocity keeps its limit between the points too.
void Maker::boundCoefficients() {
    std::vector<double> most(grid_.cells());
    for (std::size_t cell = 0; cell < most.size(); ++cell) {
        PathDerivatives at;
        geometry_.evaluate(grid_.pieces[cell], 0.5 * (grid_.nodes[cell] + grid_.nodes[cell + 1]),
                           at);
        most[cell] = lineLimits(geometry_, grid_.pieces[cell], at, limits_).x;
    }
    for (std::size_t i = 2; i + 2 < grid_.cells() + 2; ++i) {
        Row row{};
        row.coefficient = static_cast<std::uint32_t>(i);
        row.x[0] = 1.0;
        row.acceleration = true;
        row.xMax = std::min(most[i - 2], most[i - 1]);
        if (i < most.size()) row.xMax = std::min(row.xMax, most[i]);
        row.firstTerm = row.endTerm = static_cast<std::uint32_t>(out_.terms.size());
        if (!section_.fromRest) relaxAtStart(row, grid_.nodes[i - 1]);
        out_.rows.push_back(row);
    }
}

/// Constant jerk from or to rest: x goes with the distance to the power of 4/3, so there is one
/// unknown, and x, x' and x'' are multiples of it.
void Maker::makeRest(bool head) {
    const double length = head ? grid_.head : grid_.tail;
    const std::uint32_t piece = head ? grid_.pieces.front() : grid_.pieces.back();
    for (const double share : {0.125, 1.0}) {
        Row row{};
        const double root = core::cubeRoot(share);
        const std::size_t k = head ? 0 : 2;
        row.coefficient = static_cast<std::uint32_t>(head ? 0 : grid_.cells() - 1);
        row.x[k] = share * root;
        row.slope[k] = (head ? 4.0 : -4.0) / 3.0 * root / length;
        row.bend[k] = 4.0 / 9.0 / (root * root) / (length * length);
        row.acceleration = true;
        row.time = share == 1.0 ? 3.0 * length : 0.0;
        const double s = head ? section_.from + share * length : section_.to - share * length;
        addRow(row, piece, s, false);
    }
}

}  // namespace

void makeRows(const PathGeometry& geometry, const Section& section, const Grid& grid,
              const LimitSet& limits, Rows& out) {
    Maker{geometry, section, grid, limits, out}.make();
}

}  // namespace takt::planner::detail
