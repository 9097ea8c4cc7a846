#include "group_way.hpp"

#include <algorithm>
#include <cmath>
#include <takt/axis/admit.hpp>
#include <takt/axis/group_admit.hpp>

namespace takt::axis {

using planner::PathElement;
using planner::PathError;

namespace {

/// Lowest and highest value of one Cartesian axis on an arc.
struct Span {
    double low;
    double high;
};

/// The direction (c, s) lies on the way from 0 to the end of the arc.
bool passes(double c, double s, double endCosine, double endSine, double angle) noexcept {
    constexpr double HalfTurn = 3.141592653589793;
    const double fromStart = s;                        // cross product with (1, 0)
    const double toEnd = c * endSine - s * endCosine;  // with the end
    if (angle <= HalfTurn) return fromStart >= 0.0 && toEnd >= 0.0;
    return !(fromStart < 0.0 && toEnd < 0.0);
}

Span spanOf(const PathElement& arc, std::size_t axis) noexcept {
    const double from = arc.from[axis].count();
    const double to = arc.to[axis].count();
    Span span{std::min(from, to), std::max(from, to)};
    const double u = arc.u[axis];
    const double w = arc.w[axis];
    const double size = std::sqrt(u * u + w * w);
    if (arc.radius * size <= 0.0) return span;
    double endCosine = 0.0;
    double endSine = 0.0;
    for (std::size_t i = 0; i < CartesianAxes; ++i) {
        const double radial = arc.to[i].count() - arc.slope[i] * arc.length - arc.centre[i];
        endCosine += radial * arc.u[i] / arc.radius;
        endSine += radial * arc.w[i] / arc.radius;
    }
    // A helix rises while it turns: what it rises in all is added on both sides.
    const double rise = std::abs(arc.slope[axis]) * arc.length;
    const double reach = arc.radius * size + rise;
    if (passes(u / size, w / size, endCosine, endSine, arc.angle))
        span.high = std::max(span.high, arc.centre[axis] + reach);
    if (passes(-u / size, -w / size, endCosine, endSine, arc.angle))
        span.low = std::min(span.low, arc.centre[axis] - reach);
    return span;
}

ErrorId checkArc(std::span<const AxisTraits* const> members, const PathElement& arc) noexcept {
    for (std::size_t i = 0; i < arc.space.cartesian; ++i) {
        const Span span = spanOf(arc, i);
        for (const double end : {span.low, span.high}) {
            const ErrorId bad = checkTarget(*members[i], core::Position{end});
            if (bad != ErrorId::None) return bad;
        }
    }
    return ErrorId::None;
}

}  // namespace

planner::PathSpace pathSpace(std::size_t axes) noexcept {
    return {axes, std::min(axes, CartesianAxes)};
}

planner::PathPoint pathPoint(const GroupPoint& point) noexcept {
    planner::PathPoint out;
    for (std::size_t i = 0; i < point.size(); ++i) out[i] = core::Position{point[i]};
    return out;
}

planner::PathElementResult elementOf(const GroupCommand& command, const GroupPoint& from,
                                     std::size_t axes) noexcept {
    const planner::PathSpace space = pathSpace(axes);
    const planner::PathPoint start = pathPoint(from);
    const planner::PathPoint end = pathPoint(command.point);
    if (command.kind != GroupCommandKind::MoveCircular) return planner::line(space, start, end);
    const planner::PathPoint aux = pathPoint(command.arc.aux);
    const auto choice = command.arc.choice == CircPathChoice::Clockwise
                            ? planner::ArcChoice::Clockwise
                            : planner::ArcChoice::CounterClockwise;
    switch (command.arc.mode) {
        case CircMode::Border:
            return planner::arcByBorder(space, start, aux, end);
        case CircMode::Center:
            return planner::arcByCentre(space, start, aux, end, choice,
                                        core::Distance{command.arc.tolerance});
        case CircMode::Radius:
            break;
    }
    const GroupPoint& normal = command.arc.aux;
    return planner::arcByRadius(space, start, {normal[0], normal[1], normal[2]}, end, choice);
}

ErrorId errorOf(PathError error) noexcept {
    switch (error) {
        case PathError::NotFinite:
            return ErrorId::NotFinite;
        case PathError::InvalidSpace:
        case PathError::InvalidLimits:
        case PathError::NotConnected:
            return ErrorId::InvalidParameter;
        case PathError::InvalidTransition:
            return ErrorId::TransitionNotSupported;
        case PathError::NoLength:
            return ErrorId::None;
        case PathError::NoPlane:
        case PathError::CollinearPoints:
        case PathError::RadiiDiffer:
        case PathError::RadiusTooSmall:
        case PathError::PlaneUndetermined:
            return ErrorId::ArcInvalid;
        case PathError::TooManyElements:
        case PathError::TooLong:
            return ErrorId::BufferFull;
        case PathError::NotInMotion:
        case PathError::NoFeed:
            break;
    }
    return ErrorId::ProfileNotFeasible;
}

void resolve(GroupCommand& command, const GroupPoint& from, std::size_t axes) noexcept {
    if (!command.relative) return;
    command.relative = false;
    for (std::size_t i = 0; i < axes; ++i) command.point[i] += from[i];
    // A normal is a direction and counts from nowhere.
    if (command.kind != GroupCommandKind::MoveCircular || command.arc.mode == CircMode::Radius)
        return;
    for (std::size_t i = 0; i < axes; ++i) command.arc.aux[i] += from[i];
}

ErrorId checkWay(std::span<const AxisTraits* const> members, const GroupCommand& command,
                 const GroupPoint& from) noexcept {
    const std::size_t axes = members.size();
    for (std::size_t i = 0; i < axes; ++i) {
        const ErrorId bad = checkTarget(*members[i], core::Position{command.point[i]});
        if (bad != ErrorId::None) return bad;
    }
    if (command.kind != GroupCommandKind::MoveCircular) return ErrorId::None;
    const auto arc = elementOf(command, from, axes);
    return arc.ok() ? checkArc(members, arc.value()) : errorOf(arc.error());
}

}  // namespace takt::axis
