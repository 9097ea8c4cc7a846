#pragma once

#include <takt/plcopen/execute_block.hpp>

namespace takt::plcopen {

/// Inputs that all moves share. Velocity in u/s; the others in u/s², u/s³, where 0 means the axis'
/// default.
class MoveBlock : public MotionBlock {
public:
    double Velocity{0.0};  ///< never 0 for a positioning move
    double Acceleration{0.0};
    double Deceleration{0.0};
    double Jerk{0.0};
    MC_BUFFER_MODE BufferMode{MC_BUFFER_MODE::mcAborting};

protected:
    MoveBlock() = default;
    ~MoveBlock() = default;

    [[nodiscard]] axis::Command request(axis::CommandKind kind) const noexcept;
};

/// Goes to Position. Done when the set position is there and, where the axis has an in-position
/// window, the actual position too.
class MC_MoveAbsolute : public MoveBlock {
public:
    double Position{0.0};  ///< u; on a modulo axis folded into one period
    MC_DIRECTION Direction{MC_DIRECTION::mcShortestWay};  ///< modulo axes only

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

/// Goes Distance from the set position at the moment it takes control.
class MC_MoveRelative : public MoveBlock {
public:
    double Distance{0.0};  ///< u, signed

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

/// Goes Distance on from the target of the discrete motion that it takes over; otherwise from the
/// set position at the moment it takes control.
class MC_MoveAdditive : public MoveBlock {
public:
    double Distance{0.0};  ///< u, signed

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

/// What moves have in common that reach a position with a velocity and keep that until another
/// command takes the axis. EndVelocity above Velocity is reached by a last ramp before the
/// position. ProfileNotFeasible where the way is too short for EndVelocity in its direction.
class ContinuousMoveBlock : public MoveBlock {
public:
    double EndVelocity{0.0};  ///< u/s, signed

    bool InEndVelocity{false};  ///< in control, past the position, at EndVelocity

protected:
    ContinuousMoveBlock() = default;
    ~ContinuousMoveBlock() = default;

    void showEnd(const axis::AxisRef& axis, axis::CommandPhase phase) noexcept;
};

/// Goes to Position, reaches it with EndVelocity and goes on with that.
class MC_MoveContinuousAbsolute : public ContinuousMoveBlock {
public:
    double Position{0.0};  ///< u; on a modulo axis folded into one period
    MC_DIRECTION Direction{MC_DIRECTION::mcShortestWay};  ///< modulo axes only

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

/// Goes Distance from the set position at the moment it takes control, ends it with EndVelocity and
/// goes on with that.
class MC_MoveContinuousRelative : public ContinuousMoveBlock {
public:
    double Distance{0.0};  ///< u, signed

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

/// Runs with Velocity · sign of Direction until another command takes the axis.
class MC_MoveVelocity : public MoveBlock {
public:
    MC_DIRECTION Direction{MC_DIRECTION::mcPositiveDirection};  ///< not mcShortestWay

    bool InVelocity{false};  ///< in control and the set velocity is the commanded one

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

}  // namespace takt::plcopen
