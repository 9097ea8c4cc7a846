#pragma once

#include <takt/plcopen/execute_block.hpp>

namespace takt::plcopen {

/// Stops the axis and holds it in Stopping while Execute is TRUE: every motion block answers
/// AxisLocked. Done when the set velocity is 0; the axis goes to Standstill when Done and Execute
/// has fallen.
class MC_Stop : public ExecuteBlock {
public:
    double Deceleration{0.0};  ///< u/s², 0 = the axis' stop deceleration
    double Jerk{0.0};          ///< u/s³, 0 = the axis' stop jerk

    bool Done{false};
    bool CommandAborted{false};  ///< power was switched off
    bool Active{false};          ///< holds the axis, Done included

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;

private:
    void release(const axis::AxisRef& axis) noexcept;

    bool release_{false};  ///< Execute fell: the axis is to be let go
};

/// Stops the axis; any other motion command may take it meanwhile.
class MC_Halt : public MotionBlock {
public:
    double Deceleration{0.0};  ///< u/s², 0 = the axis' default
    double Jerk{0.0};          ///< u/s³, 0 = the axis' default
    MC_BUFFER_MODE BufferMode{MC_BUFFER_MODE::mcAborting};

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

}  // namespace takt::plcopen
