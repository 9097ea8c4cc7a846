#include <cmath>
#include <takt/core/trigonometry.hpp>
#include <takt/planner/path_element.hpp>

#include "element_check.hpp"
#include "vector3.hpp"

namespace takt::planner {

const char* describe(PathError error) noexcept {
    switch (error) {
        case PathError::NotFinite:
            return "a coordinate or a limit is not a finite number";
        case PathError::InvalidSpace:
            return "the number of axes is out of range";
        case PathError::InvalidLimits:
            return "a limit is zero or negative";
        case PathError::InvalidTransition:
            return "the size or velocity of a transition is invalid";
        case PathError::NoLength:
            return "start and end are the same";
        case PathError::NoPlane:
            return "an arc needs two Cartesian axes at least";
        case PathError::CollinearPoints:
            return "the three points of an arc lie on a line";
        case PathError::RadiiDiffer:
            return "start and end are not equally far from the centre";
        case PathError::RadiusTooSmall:
            return "the circle is too small to reach the end";
        case PathError::PlaneUndetermined:
            return "the points do not determine the arc's plane";
        case PathError::NotConnected:
            return "an element does not begin where the last one ends";
        case PathError::TooManyElements:
            return "the window of elements is full";
        case PathError::TooLong:
            return "the feed needs more pieces than there is room for";
        case PathError::NotInMotion:
            return "the state to go on from is not on the path";
        case PathError::NoFeed:
            return "no feed was found that keeps the limits";
    }
    return "unknown";
}

namespace detail {

std::optional<PathError> checkPoints(const PathSpace& space, const PathPoint& from,
                                     const PathPoint& to) noexcept {
    if (space.axes < 1 || space.axes > maxPathAxes || space.cartesian > 3 ||
        space.cartesian > space.axes) {
        return PathError::InvalidSpace;
    }
    for (std::size_t i = 0; i < space.axes; ++i) {
        if (!std::isfinite(from[i].count()) || !std::isfinite(to[i].count()))
            return PathError::NotFinite;
    }
    return std::nullopt;
}

}  // namespace detail

PathElementResult line(const PathSpace& space, const PathPoint& from,
                       const PathPoint& to) noexcept {
    if (const auto error = detail::checkPoints(space, from, to)) return *error;
    PathElement element;
    element.space = space;
    element.from = from;
    element.to = to;
    double cartesian = 0.0;
    double others = 0.0;
    for (std::size_t i = 0; i < space.axes; ++i) {
        const double d = (to[i] - from[i]).count();
        (i < space.cartesian ? cartesian : others) += d * d;
    }
    element.length = std::sqrt(cartesian > 0.0 ? cartesian : others);
    if (!std::isfinite(element.length)) return PathError::NotFinite;
    if (!(element.length > 0.0)) return PathError::NoLength;
    for (std::size_t i = 0; i < space.axes; ++i)
        element.slope[i] = (to[i] - from[i]).count() / element.length;
    return element;
}

namespace {

void evaluateArc(const PathElement& e, double offset, PathDerivatives& out) noexcept {
    const double rate = e.angle / e.length;
    const auto [sin, cos] = core::sinCos(offset * rate);
    const double r1 = e.radius * rate;
    const double r2 = r1 * rate;
    const double r3 = r2 * rate;
    for (std::size_t i = 0; i < e.space.cartesian; ++i) {
        const double outward = e.u[i] * cos + e.w[i] * sin;
        const double onward = e.w[i] * cos - e.u[i] * sin;
        out.q[i] = e.centre[i] + e.radius * outward + e.slope[i] * offset;
        out.d1[i] = r1 * onward + e.slope[i];
        out.d2[i] = -r2 * outward;
        out.d3[i] = -r3 * onward;
        if (offset >= e.length) out.q[i] = e.to[i].count();
    }
}

}  // namespace

bool hasCartesianMotion(const PathElement& e) noexcept {
    if (e.kind == ElementKind::Arc) return true;
    for (std::size_t i = 0; i < e.space.cartesian; ++i) {
        if (e.slope[i] != 0.0) return true;
    }
    return false;
}

void evaluate(const PathElement& e, double offset, PathDerivatives& out) noexcept {
    std::size_t first = 0;
    if (e.kind == ElementKind::Arc) {
        evaluateArc(e, offset, out);
        first = e.space.cartesian;
    }
    // From the nearer end, so that both ends are met exactly.
    const bool nearEnd = offset > 0.5 * e.length;
    const double way = nearEnd ? offset - e.length : offset;
    for (std::size_t i = first; i < e.space.axes; ++i) {
        out.q[i] = (nearEnd ? e.to[i] : e.from[i]).count() + e.slope[i] * way;
        out.d1[i] = e.slope[i];
        out.d2[i] = 0.0;
        out.d3[i] = 0.0;
    }
}

}  // namespace takt::planner
