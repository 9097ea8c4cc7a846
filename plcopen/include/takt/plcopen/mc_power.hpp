#pragma once

#include <takt/axis/axis_port.hpp>
#include <takt/axis/error.hpp>
#include <takt/plcopen/execute_block.hpp>

namespace takt::plcopen {

/// Switches the drive on and off, by level. One instance per axis; with several the last call of a
/// cycle wins.
class MC_Power {
public:
    MC_Power() = default;
    MC_Power(const MC_Power&) = delete;
    MC_Power& operator=(const MC_Power&) = delete;

    bool Enable{false};

    bool Status{false};  ///< the power stage is really on
    bool Valid{false};   ///< the outputs are trustworthy
    bool Error{false};   ///< power was lost or never came; goes by itself when the axis is reset
    axis::ErrorId ErrorID{axis::ErrorId::None};

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

/// Clears an axis error and the drive's fault: ErrorStop becomes Standstill, or Disabled without
/// power. Done when that is reached. Not in ErrorStop: Done, no effect.
class MC_Reset : public ExecuteBlock {
public:
    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::AxisRef axis) noexcept;
};

}  // namespace takt::plcopen
