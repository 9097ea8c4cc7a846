#pragma once

#include <takt/plcopen/execute_block.hpp>

namespace takt::plcopen {

/// Runs the drive's homing procedure as the machine file configures it. Starts from Standstill
/// only. Done: the reference reads Position and the axis is homed.
class MC_Home : public MotionBlock {
public:
    double Position{0.0};  ///< u, value of the axis at the reference
    MC_BUFFER_MODE BufferMode{MC_BUFFER_MODE::mcAborting};

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

}  // namespace takt::plcopen
