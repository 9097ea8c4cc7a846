#include <algorithm>
#include <cmath>
#include <takt/core/trigonometry.hpp>

#include "section.hpp"

namespace takt::planner::detail {

namespace {

/// Cells of a contour for its length, and as many more as it turns by this angle (radians); cells
/// of a quarter turn of an arc.
constexpr double kBlendCells = 12.0;
constexpr double kBlendTurn = 0.15;
constexpr double kQuarterCells = 8.0;
/// Neighbouring cells differ by this factor where ramps may be, and by the other one beyond.
constexpr double kGrowth = 1.3;
constexpr double kFarGrowth = 1.5;
/// Cells in the time that the acceleration takes to build up, and at most in a whole ramp.
constexpr double kCellsPerRise = 4.0;
constexpr double kCellsPerRamp = 40.0;

/// Pieces with the same limits on one line, or one curved piece.
struct Span {
    double from;
    double to;
    std::uint32_t piece;
    bool curved;
    double speed;         ///< greatest
    double acceleration;  ///< that the ramps may have
    double rise;          ///< time to build it up
    double cell;          ///< greatest size of a cell, for curves
    double slowest;       ///< speed that its curvature allows where it is sharpest

    [[nodiscard]] double length() const noexcept { return to - from; }
};

double greatestNorm(const std::array<double, maxPathAxes>& v, std::size_t axes) noexcept {
    double most = 0.0;
    for (std::size_t i = 0; i < axes; ++i) most = std::max(most, std::fabs(v[i]));
    return most;
}

Span spanOf(const PathGeometry& geometry, std::size_t index, const LimitSet& limits) {
    const PathPiece& piece = geometry.piece(index);
    PathDerivatives at;
    geometry.evaluate(index, piece.start + 0.5 * piece.length, at);
    const LineLimits line = lineLimits(geometry, index, at, limits);
    Span span{piece.start,
              piece.start + piece.length,
              static_cast<std::uint32_t>(index),
              greatestNorm(at.d2, limits.axes.size()) > 0.0 || piece.isBlend(),
              std::sqrt(line.x),
              std::min(line.acceleration, line.deceleration),
              0.0,
              piece.length,
              std::sqrt(line.x)};
    span.rise = span.acceleration / line.jerk;
    if (!span.curved) return span;
    for (int k = 0; k <= 8; ++k) {
        geometry.evaluate(index, piece.start + piece.length * k / 8.0, at);
        const double x =
            std::min(lineLimits(geometry, index, at, limits).x, curveLimit(at, limits));
        span.slowest = std::min(span.slowest, std::sqrt(x));
    }
    if (piece.isBlend()) {
        span.cell = piece.length / kBlendCells;
    } else {
        span.speed = std::min(span.speed, 1.5 * span.slowest);
        const PathElement& arc = geometry.element(piece.element);
        span.cell =
            std::min(piece.length / 4.0, arc.length / arc.angle * 0.5 * core::pi / kQuarterCells);
    }
    return span;
}

std::vector<Span> spansOf(const PathGeometry& geometry, const Section& section,
                          const LimitSet& limits) {
    std::vector<Span> spans;
    for (std::size_t i = geometry.pieceAt(section.from); i < geometry.pieceCount(); ++i) {
        const PathPiece& piece = geometry.piece(i);
        if (piece.start >= section.to) break;
        if (!spans.empty() && isSameLine(geometry, i - 1, i, limits)) {
            spans.back().to = piece.start + piece.length;
        } else {
            spans.push_back(spanOf(geometry, i, limits));
        }
    }
    spans.front().from = section.from;
    spans.back().to = section.to;
    return spans;
}

/// A good size for the first cell at a joint that is passed at `speed`.
double seedAt(const Span& span, double speed) noexcept {
    if (span.curved) return std::min(span.cell, span.length() / 4.0);
    const double rise = std::min(span.rise, span.speed / span.acceleration);
    return std::min(span.length() / 6.0,
                    std::max(speed * rise / kCellsPerRise, 1e-4 * span.length()));
}

double seedBetween(const PathGeometry& geometry, const Span& a, const Span& b,
                   const LimitSet& limits) noexcept {
    const double slow = std::sqrt(jointLimit(geometry, b.piece - 1, limits));
    const double speed = std::min(
        {slow, a.curved ? 2.0 * a.slowest : a.speed, b.curved ? 2.0 * b.slowest : b.speed});
    return std::min(seedAt(a, speed), seedAt(b, speed));
}

/// Where the jerk is constant from rest on: as long as the acceleration builds up, but not more
/// than half of that, and but a small part of what there is.
double restLength(const Span& span, double section) noexcept {
    const double rise = std::min(span.rise, std::sqrt(span.speed * span.rise / span.acceleration));
    const double t = 0.5 * rise;
    const double jerk = span.acceleration / span.rise;
    return std::min({jerk * t * t * t / 6.0, section / 24.0, span.length() / 4.0});
}

/// A state in motion is as if it had come from rest at full jerk this far behind.
double virtualLength(const Span& span, double x0) noexcept {
    const double v = std::sqrt(x0);
    const double jerk = span.acceleration / span.rise;
    return v * std::sqrt(2.0 * v / jerk) / 3.0;
}

/// The greatest size of a cell at a place: smaller where a contour turns.
double mostAt(const PathGeometry& geometry, const Span& span, double s) noexcept {
    if (!geometry.piece(span.piece).isBlend()) return span.cell;
    PathDerivatives at;
    geometry.evaluate(span.piece, s, at);
    // Axes that do not measure the length may have steep derivatives throughout.
    const std::size_t axes = geometry.space().axes;
    const double turn = greatestNorm(at.d2, axes) / greatestNorm(at.d1, axes) / kBlendTurn;
    return 1.0 / (kBlendCells / geometry.piece(span.piece).length + turn);
}

/// Sizes of cells along a span, from one end inwards.
class March {
public:
    /// \param direction 1 or -1
    March(const PathGeometry& geometry, const Span& span, double seed, double direction) noexcept
        : geometry_{geometry},
          span_{span},
          at_{direction > 0.0 ? span.from : span.to},
          direction_{direction},
          seed_{seed},
          size_{seed} {
        const double v = span.speed;
        ramp_ = 0.5 * v * v / span.acceleration + 2.0 * v * span.rise;
        step_ = std::max(span.rise / kCellsPerRise, v / span.acceleration / kCellsPerRamp);
    }
    [[nodiscard]] double size() const noexcept { return size_; }

    /// The next cell begins at `s`.
    void moveTo(double s) noexcept {
        const double distance = std::fabs(s - at_);
        if (span_.curved) {
            const double next = std::min(size_ * kGrowth, mostAt(geometry_, span_, s));
            size_ = std::min(next, mostAt(geometry_, span_, s + direction_ * next));
            return;
        }
        if (distance > ramp_) {
            size_ *= kFarGrowth;
            return;
        }
        const double speed = std::min(span_.speed, std::sqrt(2.0 * span_.acceleration * distance));
        size_ = std::min(size_ * kGrowth, std::max({speed * step_, seed_, size_ / kGrowth}));
    }

private:
    const PathGeometry& geometry_;
    const Span& span_;
    double at_;
    double direction_;
    double seed_;
    double size_;
    double ramp_;
    double step_;
};

/// Fills one span with nodes; its first is there already.
bool fill(const PathGeometry& geometry, const Span& span, double from, double to, double seedLeft,
          double seedRight, Grid& out) {
    March left{geometry, span, seedLeft, 1.0};
    March right{geometry, span, seedRight, -1.0};
    double l = from;
    double r = to;
    std::vector<double> behind;
    while (r - l >
           1.2 * std::max(left.size(), right.size()) + std::min(left.size(), right.size())) {
        if (left.size() <= right.size()) {
            l += left.size();
            left.moveTo(l);
            out.nodes.push_back(l);
        } else {
            r -= right.size();
            right.moveTo(r);
            behind.push_back(r);
        }
        if (out.nodes.size() + behind.size() > mostCells) return false;
    }
    const double size = std::max(left.size(), right.size());
    const auto parts = static_cast<std::size_t>(std::max(1.0, (r - l) / size + 0.5));
    for (std::size_t k = 1; k < parts; ++k)
        out.nodes.push_back(l + (r - l) * static_cast<double>(k) / static_cast<double>(parts));
    out.nodes.insert(out.nodes.end(), behind.rbegin(), behind.rend());
    out.nodes.push_back(to);
    out.pieces.resize(out.nodes.size() - 1, span.piece);
    return true;
}

}  // namespace

bool makeGrid(const PathGeometry& geometry, const Section& section, const LimitSet& limits,
              Grid& out) {
    const std::vector<Span> spans = spansOf(geometry, section, limits);
    const double length = section.to - section.from;
    out.nodes.clear();
    out.pieces.clear();
    out.head = section.fromRest ? restLength(spans.front(), length) : 0.0;
    out.tail = restLength(spans.back(), length);
    out.nodes.push_back(section.from + out.head);
    const double behind = section.fromRest ? out.head : virtualLength(spans.front(), section.x0);
    double seed = std::min(0.3 * behind, spans.front().length() / 4.0);
    if (!section.fromRest)
        seed = std::clamp(seed, 1e-6 * length, seedAt(spans.front(), std::sqrt(section.x0)));
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const bool last = i + 1 == spans.size();
        const double next =
            last ? 0.3 * out.tail : seedBetween(geometry, spans[i], spans[i + 1], limits);
        const double from = i == 0 ? out.nodes.front() : spans[i].from;
        const double to = last ? section.to - out.tail : spans[i].to;
        if (!fill(geometry, spans[i], from, to, seed, next, out)) return false;
        seed = next;
    }
    return true;
}

}  // namespace takt::planner::detail
