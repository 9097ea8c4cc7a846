#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <takt/core/fixed_vector.hpp>
#include <takt/planner/roadmap/obstacles.hpp>

namespace takt::planner::roadmap {

namespace {

constexpr double Infinite = std::numeric_limits<double>::infinity();

/// The open stretch of a segment's parameter that lies in a region so far.
struct Stretch {
    double low{-Infinite};
    double high{Infinite};

    void cut(double from, double to) noexcept {
        low = std::max(low, from);
        high = std::min(high, to);
    }
    void clear() noexcept { high = -Infinite; }
    /// It reaches into the segment itself, whose ends are 0 and 1.
    [[nodiscard]] bool meetsSegment() const noexcept {
        return low < high && low < 1.0 && high > 0.0;
    }
};

/// Of p + t d, the stretch with low < p + t d < high.
void cutSlab(Stretch& stretch, double p, double d, double low, double high) noexcept {
    if (d == 0.0) {
        if (!(p > low && p < high)) stretch.clear();
        return;
    }
    const double first = (low - p) / d;
    const double second = (high - p) / d;
    stretch.cut(std::min(first, second), std::max(first, second));
}

/// Of (x, y) + t (dx, dy), the stretch that is nearer to the origin than r.
void cutDisc(Stretch& stretch, double x, double y, double dx, double dy, double r) noexcept {
    const double a = dx * dx + dy * dy;
    const double half = x * dx + y * dy;
    const double c = x * x + y * y - r * r;
    if (a == 0.0) {
        if (!(c < 0.0)) stretch.clear();
        return;
    }
    const double root = half * half - a * c;
    if (!(root > 0.0)) {
        stretch.clear();
        return;
    }
    // The larger sum first: no digits are lost where the two nearly cancel.
    const double q = -(half + std::copysign(std::sqrt(root), half));
    const double first = q / a;
    const double second = q == 0.0 ? 0.0 : c / q;
    stretch.cut(std::min(first, second), std::max(first, second));
}

/// A point of the triangle a, b, c as a + u (b - a) + v (c - a).
struct Weights {
    double u{0.0};
    double v{0.0};
};

/// Each half-plane that a triangle is cut with adds one corner at most: two to a slab.
constexpr std::size_t MaxCorners = 3 + 2 * Obstacles::MaxAxes;
using Piece = core::FixedVector<Weights, MaxCorners>;

/// Keeps what has value(w) <= limit, where value is linear.
template <typename Value>
void cutPiece(Piece& piece, const Value& value, double limit) noexcept {
    Piece kept;
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const Weights here = piece[i];
        const Weights next = piece[(i + 1) % piece.size()];
        const double over = value(here) - limit;
        const double nextOver = value(next) - limit;
        if (over <= 0.0) (void)kept.push(here);
        if ((over < 0.0 && nextOver > 0.0) || (over > 0.0 && nextOver < 0.0)) {
            const double share = over / (over - nextOver);
            (void)kept.push(
                {here.u + share * (next.u - here.u), here.v + share * (next.v - here.v)});
        }
    }
    piece = kept;
}

struct PlanePoint {
    double x{0.0};
    double y{0.0};
};

/// Square of the distance from the origin to the segment p, q.
double squareToSegment(PlanePoint p, PlanePoint q) noexcept {
    const double dx = q.x - p.x;
    const double dy = q.y - p.y;
    const double square = dx * dx + dy * dy;
    const double along = square > 0.0 ? std::clamp(-(p.x * dx + p.y * dy) / square, 0.0, 1.0) : 0.0;
    const double x = p.x + along * dx;
    const double y = p.y + along * dy;
    return x * x + y * y;
}

/// Whether a convex polygon, which may be flat, comes nearer to the origin than r.
bool isWithin(std::span<const PlanePoint> polygon, double r) noexcept {
    bool left = true;
    bool right = true;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const PlanePoint p = polygon[i];
        const PlanePoint q = polygon[(i + 1) % polygon.size()];
        if (squareToSegment(p, q) < r * r) return true;
        const double turn = p.x * q.y - p.y * q.x;
        left = left && turn > 0.0;
        right = right && turn < 0.0;
    }
    return left || right;  // the origin lies inside
}

}  // namespace

Obstacles::Obstacles(std::span<const KeepOutParams> keepOuts) {
    const auto concerns = [this](std::size_t axis) {
        concerned_[axis] = true;
        axisBound_ = std::max(axisBound_, axis + 1);
    };
    for (const KeepOutParams& keepOut : keepOuts) {
        Region region;
        const double clearance = keepOut.clearance.count();
        for (const KeepOutSpan& span : keepOut.spans) {
            region.slabs.push_back(
                {span.axis, span.from.count() - clearance, span.to.count() + clearance});
            concerns(span.axis);
        }
        if (keepOut.disc) {
            const KeepOutDisc& disc = *keepOut.disc;
            region.disc = Disc{disc.firstAxis, disc.secondAxis, disc.firstCentre.count(),
                               disc.secondCentre.count(), disc.radius.count() + clearance};
            concerns(disc.firstAxis);
            concerns(disc.secondAxis);
        }
        regions_.push_back(std::move(region));
    }
}

bool Obstacles::contains(const Region& region, Point point) noexcept {
    for (const Slab& slab : region.slabs) {
        const double p = point[slab.axis];
        if (!(p > slab.low && p < slab.high)) return false;
    }
    if (!region.disc) return true;
    const Disc& disc = *region.disc;
    const double x = point[disc.firstAxis] - disc.firstCentre;
    const double y = point[disc.secondAxis] - disc.secondCentre;
    return x * x + y * y < disc.radius * disc.radius;
}

bool Obstacles::crosses(const Region& region, Point from, Point to) noexcept {
    Stretch stretch;
    for (const Slab& slab : region.slabs) {
        const double p = from[slab.axis];
        cutSlab(stretch, p, to[slab.axis] - p, slab.low, slab.high);
        if (!stretch.meetsSegment()) return false;
    }
    if (region.disc) {
        const Disc& disc = *region.disc;
        const double x = from[disc.firstAxis];
        const double y = from[disc.secondAxis];
        cutDisc(stretch, x - disc.firstCentre, y - disc.secondCentre, to[disc.firstAxis] - x,
                to[disc.secondAxis] - y, disc.radius);
    }
    return stretch.meetsSegment();
}

bool Obstacles::crosses(const Region& region, Point a, Point b, Point c) noexcept {
    const auto at = [&](Weights w, std::size_t axis) {
        return a[axis] + w.u * (b[axis] - a[axis]) + w.v * (c[axis] - a[axis]);
    };
    Piece piece;
    for (const Weights corner : {Weights{0.0, 0.0}, Weights{1.0, 0.0}, Weights{0.0, 1.0}})
        (void)piece.push(corner);
    for (const Slab& slab : region.slabs) {
        cutPiece(
            piece, [&](Weights w) { return at(w, slab.axis); }, slab.high);
        cutPiece(
            piece, [&](Weights w) { return -at(w, slab.axis); }, -slab.low);
        if (piece.empty()) return false;
    }
    Weights middle;
    for (const Weights& corner : piece) {
        middle.u += corner.u / static_cast<double>(piece.size());
        middle.v += corner.v / static_cast<double>(piece.size());
    }
    // What is left may only touch a face; then its middle lies on that face too.
    for (const Slab& slab : region.slabs) {
        const double p = at(middle, slab.axis);
        if (!(p > slab.low && p < slab.high)) return false;
    }
    if (!region.disc) return true;
    const Disc& disc = *region.disc;
    std::array<PlanePoint, MaxCorners> polygon;
    std::transform(piece.begin(), piece.end(), polygon.begin(), [&](Weights w) {
        return PlanePoint{at(w, disc.firstAxis) - disc.firstCentre,
                          at(w, disc.secondAxis) - disc.secondCentre};
    });
    return isWithin(std::span{polygon}.first(piece.size()), disc.radius);
}

std::optional<std::size_t> Obstacles::around(Point point) const noexcept {
    const auto found = std::find_if(regions_.begin(), regions_.end(),
                                    [&](const Region& region) { return contains(region, point); });
    if (found == regions_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - regions_.begin());
}

bool Obstacles::isFree(Point from, Point to) const noexcept {
    return std::none_of(regions_.begin(), regions_.end(),
                        [&](const Region& region) { return crosses(region, from, to); });
}

bool Obstacles::isFree(Point a, Point b, Point c) const noexcept {
    return std::none_of(regions_.begin(), regions_.end(),
                        [&](const Region& region) { return crosses(region, a, b, c); });
}

}  // namespace takt::planner::roadmap
