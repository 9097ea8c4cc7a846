#include <algorithm>
#include <cmath>
#include <takt/planner/profile.hpp>
#include <takt/planner/profile_query.hpp>

#include "section.hpp"

namespace takt::planner::detail {

namespace {

/// Value and slope of the spline at the nodes.
struct Node {
    double x;
    double slope;
};

Node nodeAt(const Grid& grid, std::span<const double> c, std::size_t i) noexcept {
    const std::size_t cells = grid.cells();
    const double before = i == 0 ? 0.0 : grid.nodes[i] - grid.nodes[i - 1];
    const double after = i == cells ? 0.0 : grid.nodes[i + 1] - grid.nodes[i];
    const double width = before + after;
    return {(c[i] * after + c[i + 1] * before) / width, 2.0 * (c[i + 1] - c[i]) / width};
}

/// How long a piece takes for its length: Newton's method on s(t), which is monotone.
double durationOf(FeedPiece piece, double length, double endSpeed) {
    double t = 2.0 * length / (piece.from.s1 + endSpeed);
    piece.duration = unlimited;
    for (int i = 0; i < 30; ++i) {
        const FeedState at = evaluate(piece, t);
        const double step = (at.s - piece.from.s - length) / at.s1;
        t -= step;
        if (std::fabs(step) <= 1e-15 * t) break;
    }
    return t;
}

double addRestPiece(double start, double place, double length, double speed, bool fromRest,
                    FeedProfile& out) {
    // s = j t^3/6 and v = j t^2/2: t = 3 s/v.
    const double duration = 3.0 * length / speed;
    const double jerk = 2.0 * speed / (duration * duration);
    FeedPiece piece{start, duration, {place, 0.0, 0.0, jerk}, 0.0, true};
    if (!fromRest) piece.from = {place, speed, -jerk * duration, jerk};
    out.add(piece);
    return duration;
}

}  // namespace

void addPieces(const Section& section, const Grid& grid, std::span<const double> coefficients,
               FeedProfile& out) {
    double time = out.nextStart();
    Node left = nodeAt(grid, coefficients, 0);
    if (section.fromRest)
        time += addRestPiece(time, section.from, grid.head, std::sqrt(left.x), true, out);
    for (std::size_t i = 0; i < grid.cells(); ++i) {
        const Node right = nodeAt(grid, coefficients, i + 1);
        const double h = grid.nodes[i + 1] - grid.nodes[i];
        const double bend = 0.5 * (right.slope - left.slope) / h;
        const double v = std::sqrt(left.x);
        FeedPiece piece{time, 0.0, {grid.nodes[i], v, 0.5 * left.slope, bend * v}, bend, false};
        piece.duration = durationOf(piece, h, std::sqrt(right.x));
        out.add(piece);
        time += piece.duration;
        left = right;
    }
    addRestPiece(time, grid.nodes.back(), grid.tail, std::sqrt(left.x), false, out);
}

bool addStraight(const PathGeometry& geometry, const Section& section, const LimitSet& limits,
                 FeedProfile& out) {
    const std::size_t first = geometry.pieceAt(section.from);
    const PathPiece& piece = geometry.piece(first);
    if (piece.isBlend() || geometry.element(piece.element).kind != ElementKind::Line) return false;
    for (std::size_t i = first; i + 1 < geometry.pieceCount(); ++i) {
        if (geometry.piece(i + 1).start >= section.to) break;
        if (!isSameLine(geometry, i, i + 1, limits)) return false;
    }
    PathDerivatives at;
    geometry.evaluate(first, section.from, at);
    const LineLimits line = lineLimits(geometry, first, at, limits);
    const double v = std::sqrt(line.x);
    // Places count from the beginning of the section: small numbers round less.
    const State from{core::Position{0.0}, core::Velocity{std::sqrt(section.x0)},
                     core::Acceleration{0.5 * section.slope0}};
    const State to{core::Position{section.to - section.from}, {}, {}};
    const auto profile =
        planner::plan(from, {TargetKind::State, to},
                      {core::Velocity{v}, core::Velocity{-v}, core::Acceleration{line.acceleration},
                       core::Acceleration{-line.deceleration}, core::Jerk{line.jerk}});
    if (!profile.ok()) return false;
    const PositionExtremes extremes = extremesOf(profile.value());
    const double slack = 1e-12 * to.position.count();
    if (extremes.lowest.count() < -slack || extremes.highest.count() > to.position.count() + slack)
        return false;
    const double start = out.nextStart();
    for (std::size_t i = 0; i < profile.value().size(); ++i) {
        const Segment& segment = profile.value()[i];
        if (!(segment.duration.count() > 0.0)) continue;
        out.add({start + segment.start.count(),
                 segment.duration.count(),
                 {section.from + segment.from.position.count(), segment.from.velocity.count(),
                  segment.from.acceleration.count(), segment.jerk.count()},
                 0.0,
                 true});
    }
    return true;
}

}  // namespace takt::planner::detail
