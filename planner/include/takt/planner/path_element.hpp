#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <takt/core/result.hpp>
#include <takt/core/units.hpp>

/// Paths of several axes: what is programmed.
namespace takt::planner {

inline constexpr std::size_t maxPathAxes = 16;

/// The axes of a path. The first `cartesian` of them span the space in which the length of the path
/// is measured; the others follow in proportion to it. An element on which no Cartesian axis moves
/// is measured in the others.
struct PathSpace {
    std::size_t axes{3};       ///< 1..maxPathAxes
    std::size_t cartesian{3};  ///< 0..min(3, axes)
};

/// Positions of all axes; those beyond PathSpace::axes are not looked at.
using PathPoint = std::array<core::Position, maxPathAxes>;

enum class PathError : std::uint8_t {
    NotFinite,          ///< a coordinate or a limit is NaN or infinite where it may not be
    InvalidSpace,       ///< numbers of axes out of range
    InvalidLimits,      ///< a limit is zero or negative
    InvalidTransition,  ///< a size or velocity of a transition is negative or not a number
    NoLength,           ///< start and end are the same: nothing to move
    NoPlane,            ///< an arc needs two Cartesian axes at least
    CollinearPoints,    ///< the three points of an arc lie on a line
    RadiiDiffer,        ///< start and end have different distances from the centre
    RadiusTooSmall,     ///< the end is farther away than the circle is wide
    PlaneUndetermined,  ///< the plane of a half or full circle does not follow from its points
    NotConnected,       ///< an element does not begin where the one before it ends
    TooManyElements,    ///< the window is full
    TooLong,            ///< the feed needs more pieces than there is room for
    NotInMotion,        ///< the state to go on from is not on the path, or not within its limits
    NoFeed,             ///< no feed was found that keeps the limits
};

/// A short English sentence.
[[nodiscard]] const char* describe(PathError error) noexcept;

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Limits along the path; each positive, or infinite: then the limits of the axes alone decide.
struct PathFeed {
    core::Velocity velocity{unlimited};
    core::Acceleration acceleration{unlimited};
    core::Acceleration deceleration{unlimited};  ///< as a magnitude
    core::Jerk jerk{unlimited};
};

/// What may happen at the joint to the next element.
enum class TransitionMode : std::uint8_t {
    Stop,             ///< exactly there, at rest
    Exact,            ///< exactly there; through where the direction goes on, a corner stops
    CornerDistance,   ///< the corner is left `size` before it and joined again `size` after it
    CornerDeviation,  ///< the contour passes the corner at the distance `size`
};

/// Distances are clipped to half of the shorter neighbour, and to what lies ahead of the feed.
/// A turn back of more than 170 degrees, and a change between elements with and without Cartesian
/// motion, stop.
struct Transition {
    TransitionMode mode{TransitionMode::Stop};
    core::Distance size{};
    core::Velocity velocity{unlimited};  ///< greatest path velocity at the joint or in its contour
};

/// How to go round a circle, seen against its normal. Where the normal is not given it is the one
/// that points to positive z, or, if the plane contains z, to positive y, and then x: in the XY
/// plane CounterClockwise turns from X to Y, in the ZX plane from Z to X.
enum class ArcChoice : std::uint8_t { Clockwise, CounterClockwise };

enum class ElementKind : std::uint8_t { Line, Arc };

/// A piece of programmed geometry with its feed, from `from` to `to`. Made by the functions below.
///
/// An arc turns by `angle` > 0 from `u` towards `w`; what its points have in common with a helix,
/// and all axes that are not Cartesian, is `slope`: change per length.
struct PathElement {
    ElementKind kind{ElementKind::Line};
    PathSpace space{};
    PathPoint from{};
    PathPoint to{};
    double length{0.0};
    std::array<double, maxPathAxes> slope{};
    std::array<double, 3> centre{};
    std::array<double, 3> u{};  ///< unit vector from the centre to the start
    std::array<double, 3> w{};  ///< unit vector, a quarter turn on
    double radius{0.0};
    double angle{0.0};

    PathFeed feed{};
    Transition transition{};  ///< at its end
    std::uint32_t tag{0};     ///< the caller's own; handed back where the feed is
};

using PathElementResult = core::Result<PathElement, PathError>;

/// A straight line of all axes.
[[nodiscard]] PathElementResult line(const PathSpace& space, const PathPoint& from,
                                     const PathPoint& to) noexcept;

/// The arc through a point of it. Cartesian coordinates of `through` only.
[[nodiscard]] PathElementResult arcByBorder(const PathSpace& space, const PathPoint& from,
                                            const PathPoint& through, const PathPoint& to) noexcept;

/// The arc about a centre. The same start and end are a full circle. Radii that differ by no more
/// than `tolerance` are made equal by moving the centre.
[[nodiscard]] PathElementResult arcByCentre(const PathSpace& space, const PathPoint& from,
                                            const PathPoint& centre, const PathPoint& to,
                                            ArcChoice choice, core::Distance tolerance) noexcept;

/// The arc of at most half a turn about an axis: `normal` is at right angles to the circle and as
/// long as its radius. An end beside the plane makes a helix.
[[nodiscard]] PathElementResult arcByRadius(const PathSpace& space, const PathPoint& from,
                                            const std::array<double, 3>& normal,
                                            const PathPoint& to, ArcChoice choice) noexcept;

/// rt. The length of the element is that of its Cartesian axes.
[[nodiscard]] bool hasCartesianMotion(const PathElement& element) noexcept;

/// rt. Positions and their derivatives with respect to the length of the path.
struct PathDerivatives {
    std::array<double, maxPathAxes> q{};
    std::array<double, maxPathAxes> d1{};
    std::array<double, maxPathAxes> d2{};
    std::array<double, maxPathAxes> d3{};
};

/// rt. The element at `offset` (0..length) behind its start.
void evaluate(const PathElement& element, double offset, PathDerivatives& out) noexcept;

}  // namespace takt::planner
