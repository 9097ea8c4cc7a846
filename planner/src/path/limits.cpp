#include <algorithm>
#include <cmath>
#include <takt/core/trigonometry.hpp>

#include "section.hpp"

namespace takt::planner::detail {

namespace {

/// At a joint with jumps their shares of the jerk limit as it shows in differences over cycles; the
/// rest is left for the motion itself.
constexpr double kBendShare = 0.25;
constexpr double kKinkShare = 0.2;
/// A jump of acceleration shows with at most this part of itself per cycle as jerk.
constexpr double kJumpPeak = 0.75;

constexpr double kNothing = 1e-12;
/// Differences of direction that are rounding.
constexpr double kStraight = 1e-9;

}  // namespace

LineLimits lineLimits(const PathGeometry& geometry, std::size_t piece, const PathDerivatives& at,
                      const LimitSet& limits) noexcept {
    const PathFeed feed = geometry.feedOf(piece);
    const double f = limits.share;
    const double v = feed.velocity.count() * limits.speedShare;
    LineLimits out{v * v, feed.acceleration.count() * f, feed.deceleration.count() * f,
                   feed.jerk.count() * f};
    for (std::size_t i = 0; i < limits.axes.size(); ++i) {
        const double d = std::fabs(at.d1[i]);
        if (!(d > kNothing)) continue;
        const double axis = limits.axes[i].velocity.count() * limits.speedShare / d;
        out.x = std::min(out.x, axis * axis);
        const double a = limits.axes[i].acceleration.count() * f / d;
        out.acceleration = std::min(out.acceleration, a);
        out.deceleration = std::min(out.deceleration, a);
        out.jerk = std::min(out.jerk, limits.axes[i].jerk.count() * f / d);
    }
    return out;
}

bool isSameLine(const PathGeometry& geometry, std::size_t before, std::size_t after,
                const LimitSet& limits) noexcept {
    const PathPiece& a = geometry.piece(before);
    const PathPiece& b = geometry.piece(after);
    if (a.isBlend() || b.isBlend() || a.end != JointKind::Through || a.endVelocity < unlimited)
        return false;
    const PathElement& first = geometry.element(a.element);
    const PathElement& second = geometry.element(b.element);
    if (first.kind != ElementKind::Line || second.kind != ElementKind::Line) return false;
    for (std::size_t i = 0; i < limits.axes.size(); ++i) {
        if (std::fabs(first.slope[i] - second.slope[i]) > kStraight) return false;
    }
    const PathFeed& f = first.feed;
    const PathFeed& g = second.feed;
    return f.velocity == g.velocity && f.acceleration == g.acceleration &&
           f.deceleration == g.deceleration && f.jerk == g.jerk;
}

double curveLimit(const PathDerivatives& at, const LimitSet& limits) noexcept {
    double x = unlimited;
    for (std::size_t i = 0; i < limits.axes.size(); ++i) {
        const double bend = std::fabs(at.d2[i]);
        if (bend > kNothing)
            x = std::min(x, limits.share * limits.axes[i].acceleration.count() / bend);
        const double third = std::fabs(at.d3[i]);
        if (third > kNothing) {
            const double v = core::cubeRoot(limits.share * limits.axes[i].jerk.count() / third);
            x = std::min(x, v * v);
        }
    }
    return x;
}

double jointLimit(const PathGeometry& geometry, std::size_t before,
                  const LimitSet& limits) noexcept {
    const PathPiece& piece = geometry.piece(before);
    const double s = piece.start + piece.length;
    PathDerivatives from;
    PathDerivatives to;
    geometry.evaluate(before, s, from);
    geometry.evaluate(before + 1, s, to);
    const double h = limits.cycle;
    double x = piece.endVelocity * piece.endVelocity;
    for (std::size_t i = 0; i < limits.axes.size(); ++i) {
        const double jerk = limits.axes[i].jerk.count() * limits.share;
        const double bend = std::fabs(to.d2[i] - from.d2[i]);
        if (bend > 1e-9) x = std::min(x, kBendShare / kJumpPeak * jerk * h / bend);
        const double kink = std::fabs(to.d1[i] - from.d1[i]);
        if (kink > kStraight) {
            const double v = kKinkShare * jerk * h * h / kink;
            x = std::min(x, v * v);
        }
    }
    return x;
}

}  // namespace takt::planner::detail
