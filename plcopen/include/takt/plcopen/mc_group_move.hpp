#pragma once

#include <array>
#include <takt/plcopen/execute_block.hpp>

namespace takt::plcopen {

/// One number for each place of a group; those without an axis do not count.
using GroupArray = std::array<double, axis::MaxGroupAxes>;

/// Inputs that all motions of a group share.
class GroupMoveBlock : public GroupMotionBlock {
public:
    double Velocity{0.0};
    double Acceleration{0.0};
    double Deceleration{0.0};
    double Jerk{0.0};
    MC_COORD_SYSTEM CoordSystem{MC_COORD_SYSTEM::mcACS};  ///< mcACS or mcMCS, which are the same
    MC_BUFFER_MODE BufferMode{MC_BUFFER_MODE::mcAborting};

protected:
    GroupMoveBlock() = default;
    ~GroupMoveBlock() = default;

    [[nodiscard]] axis::GroupCommand request(axis::GroupCommandKind kind,
                                             const GroupArray& point) const noexcept;
};

/// A motion on a path: Velocity (above 0) in u/s along it; accelerations and jerk likewise, where 0
/// means the group's limit.
class GroupPathBlock : public GroupMoveBlock {
public:
    /// How a blending BufferMode goes on from the motion before: mcTMNone exactly through the
    /// corner, mcTMCornerDistance and mcTMMaxCornerDeviation round it.
    MC_TRANSITION_MODE TransitionMode{MC_TRANSITION_MODE::mcTMNone};
    double TransitionParameter{0.0};  ///< u: corner distance or deviation
    double TransitionVelocity{0.0};   ///< u/s: bound in the contour, 0 = none

protected:
    GroupPathBlock() = default;
    ~GroupPathBlock() = default;

    [[nodiscard]] axis::GroupCommand request(axis::GroupCommandKind kind,
                                             const GroupArray& point) const noexcept;
};

/// A straight line to Position.
class MC_MoveLinearAbsolute : public GroupPathBlock {
public:
    GroupArray Position{};  ///< u

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// A straight line by Distance from the set position at the moment it takes control.
class MC_MoveLinearRelative : public GroupPathBlock {
public:
    GroupArray Distance{};  ///< u

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// Inputs of both circular motions. The arc lies anywhere in the space of the first three axes;
/// further axes go in proportion.
///   mcBorder  AuxPoint is a point of the arc between start and end
///   mcCenter  AuxPoint is the centre; the same start and end are a full circle
///   mcRadius  AuxPoint is a vector at right angles to the circle and as long as its radius
class CircularBlock : public GroupPathBlock {
public:
    MC_CIRC_MODE CircMode{MC_CIRC_MODE::mcBorder};
    GroupArray AuxPoint{};
    GroupArray EndPoint{};
    /// Seen against the normal: the vector of mcRadius, else the one that points to positive z
    /// (in planes that contain z: y, then x).
    MC_CIRC_PATHCHOICE PathChoice{MC_CIRC_PATHCHOICE::mcClockwise};
    double Tolerance{0.01};  ///< u: largest difference of the two radii with mcCenter

protected:
    CircularBlock() = default;
    ~CircularBlock() = default;

    axis::CommandPhase move(const axis::GroupRef& group, bool relative) noexcept;
};

/// An arc to EndPoint.
class MC_MoveCircularAbsolute : public CircularBlock {
public:
    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// An arc whose AuxPoint and EndPoint count from where it begins.
class MC_MoveCircularRelative : public CircularBlock {
public:
    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// All axes to Position so that they arrive together, each within its own limits; the way between
/// is not a line. Velocity, accelerations and Jerk bound every axis, 0 = its own limits.
class MC_MoveDirectAbsolute : public GroupMoveBlock {
public:
    GroupArray Position{};  ///< u

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// As MC_MoveDirectAbsolute, by Distance from the set position at the moment it takes control.
class MC_MoveDirectRelative : public GroupMoveBlock {
public:
    GroupArray Distance{};  ///< u

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

}  // namespace takt::plcopen
