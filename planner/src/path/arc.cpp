#include <cmath>
#include <optional>
#include <takt/core/trigonometry.hpp>
#include <takt/planner/path_element.hpp>

#include "element_check.hpp"
#include "vector3.hpp"

namespace takt::planner {

using detail::cross;
using detail::dot;
using detail::norm;
using detail::Vector3;
using detail::operator+;
using detail::operator-;
using detail::operator*;

namespace {

/// Relative to the size of the figure: below it three points are on a line, a vector in a plane.
constexpr double kFlat = 1e-9;

/// Where an arc lies and how it turns: right-handed about `normal`, or against it.
struct Circle {
    Vector3 centre;
    Vector3 normal;  ///< unit vector; the arc turns about it
    double rise;     ///< along the normal, over the whole arc
};

Vector3 cartesian(const PathSpace& space, const PathPoint& point) noexcept {
    Vector3 v{};
    for (std::size_t i = 0; i < space.cartesian; ++i) v[i] = point[i].count();
    return v;
}

std::optional<PathError> check(const PathSpace& space, const PathPoint& from, const Vector3& aux,
                               const PathPoint& to) noexcept {
    if (const auto error = detail::checkPoints(space, from, to)) return error;
    if (space.cartesian < 2) return PathError::NoPlane;
    if (!std::isfinite(norm(aux))) return PathError::NotFinite;
    return std::nullopt;
}

/// The direction from which a circle in this plane is looked at.
Vector3 upright(const Vector3& n) noexcept {
    const double size = norm(n) * kFlat;
    const std::size_t axis = std::fabs(n[2]) > size ? 2 : std::fabs(n[1]) > size ? 1 : 0;
    return n * ((n[axis] < 0.0 ? -1.0 : 1.0) / norm(n));
}

PathElementResult make(const PathSpace& space, const PathPoint& from, const PathPoint& to,
                       const Circle& circle, bool full) noexcept {
    PathElement e;
    e.kind = ElementKind::Arc;
    e.space = space;
    e.from = from;
    e.to = to;
    e.centre = circle.centre;
    const Vector3 start = cartesian(space, from) - circle.centre;
    const Vector3 end = cartesian(space, to) - circle.centre - circle.normal * circle.rise;
    e.radius = norm(start);
    e.u = start * (1.0 / e.radius);
    e.w = cross(circle.normal, e.u);
    double angle = full ? 2.0 * core::pi : core::angleOf(dot(end, e.u), dot(end, e.w));
    if (!(angle > 0.0)) angle += 2.0 * core::pi;
    e.angle = angle;
    const double along = e.radius * angle;
    e.length = std::sqrt(along * along + circle.rise * circle.rise);
    if (!std::isfinite(e.length)) return PathError::NotFinite;
    for (std::size_t i = 0; i < space.axes; ++i) {
        const double d =
            i < space.cartesian ? circle.normal[i] * circle.rise : (to[i] - from[i]).count();
        e.slope[i] = d / e.length;
    }
    return e;
}

/// A plane that is parallel to two axes and contains `inPlane`: for arcs whose points do not
/// determine one.
std::optional<Vector3> mainPlane(const PathSpace& space, const Vector3& inPlane) noexcept {
    if (space.cartesian == 2) return Vector3{0.0, 0.0, 1.0};
    const double size = norm(inPlane) * kFlat;
    for (const std::size_t axis : {2U, 1U, 0U}) {
        Vector3 normal{};
        normal[axis] = 1.0;
        if (std::fabs(inPlane[axis]) <= size) return normal;
    }
    return std::nullopt;
}

/// Moves a centre into the plane at equal distances from both ends of a chord.
Vector3 centred(const Vector3& centre, const Vector3& from, const Vector3& to) noexcept {
    const Vector3 chord = to - from;
    const double excess = dot(centre - (from + to) * 0.5, chord) / dot(chord, chord);
    return centre - chord * excess;
}

}  // namespace

PathElementResult arcByBorder(const PathSpace& space, const PathPoint& from,
                              const PathPoint& through, const PathPoint& to) noexcept {
    const Vector3 b = cartesian(space, through);
    if (const auto error = check(space, from, b, to)) return *error;
    const Vector3 a = cartesian(space, from);
    const Vector3 toB = b - a;
    const Vector3 toC = cartesian(space, to) - a;
    const Vector3 n = cross(toB, toC);
    const double area = norm(n);
    if (!(area > kFlat * norm(toB) * norm(toC)) || !(norm(toB - toC) > kFlat * norm(toC)))
        return PathError::CollinearPoints;
    const Vector3 toCentre =
        (cross(n, toB) * dot(toC, toC) + cross(toC, n) * dot(toB, toB)) * (0.5 / (area * area));
    // The turn from start to border to end is the one about their common normal.
    return make(space, from, to, {a + toCentre, n * (1.0 / area), 0.0}, false);
}

PathElementResult arcByCentre(const PathSpace& space, const PathPoint& from,
                              const PathPoint& centre, const PathPoint& to, ArcChoice choice,
                              core::Distance tolerance) noexcept {
    const Vector3 c = cartesian(space, centre);
    if (const auto error = check(space, from, c, to)) return *error;
    const Vector3 a = cartesian(space, from);
    const Vector3 b = cartesian(space, to);
    const double ra = norm(a - c);
    const double rb = norm(b - c);
    if (!(ra > 0.0) || !(rb > 0.0)) return PathError::NoLength;
    const double slack = std::fmax(tolerance.count(), 0.0) + 1e-12 * (ra + norm(c));
    if (!(std::fabs(ra - rb) <= slack)) return PathError::RadiiDiffer;

    const Vector3 n = cross(a - c, b - c);
    std::optional<Vector3> normal;
    if (norm(n) > kFlat * ra * rb) normal = upright(n);
    if (!normal) normal = mainPlane(space, a - c);
    if (!normal) return PathError::PlaneUndetermined;
    const bool full = norm(b - a) <= 1e-12 * (ra + norm(c));
    const Vector3 moved = full ? c : centred(c, a, b);
    // The nearer the ends, the farther a difference of radii moves the centre.
    if (!(norm(moved - c) <= 2.0 * slack)) return PathError::RadiiDiffer;
    if (choice == ArcChoice::Clockwise) normal = *normal * -1.0;
    return make(space, from, to, {moved, *normal, 0.0}, full);
}

PathElementResult arcByRadius(const PathSpace& space, const PathPoint& from,
                              const std::array<double, 3>& normal, const PathPoint& to,
                              ArcChoice choice) noexcept {
    if (const auto error = check(space, from, normal, to)) return *error;
    const double radius = norm(normal);
    if (!(radius > 0.0)) return PathError::NoPlane;
    if (space.cartesian == 2 && std::fabs(normal[2]) < radius * (1.0 - kFlat))
        return PathError::NoPlane;
    Vector3 axis = normal * (1.0 / radius);
    if (choice == ArcChoice::Clockwise) axis = axis * -1.0;
    const Vector3 a = cartesian(space, from);
    const Vector3 way = cartesian(space, to) - a;
    double rise = dot(way, axis);
    const Vector3 chord = way - axis * rise;
    const double half = 0.5 * norm(chord);
    if (!(half > kFlat * radius)) return PathError::NoLength;
    if (half > radius * (1.0 + kFlat)) return PathError::RadiusTooSmall;
    if (std::fabs(rise) <= kFlat * radius) rise = 0.0;
    const double height = std::sqrt(std::fmax(0.0, radius * radius - half * half));
    // Turning left about the axis by at most half a turn: the centre is to the left of the chord.
    const Vector3 left = cross(axis, chord) * (0.5 / half);
    return make(space, from, to, {a + chord * 0.5 + left * height, axis, rise}, false);
}

}  // namespace takt::planner
