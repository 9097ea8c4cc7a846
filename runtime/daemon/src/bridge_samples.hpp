#pragma once

#include <takt/axis/axis_view.hpp>
#include <takt/axis/group_view.hpp>
#include <takt/bridge/protocol.hpp>
#include <takt/core/time.hpp>

#include "status_board.hpp"

namespace takt::daemon {

/// rt. The status as the bridge knows it.
[[nodiscard]] bridge::MachineSample sampleOf(const RunEntry& run) noexcept;
[[nodiscard]] bridge::AxisSample sampleOf(core::CycleNumber cycle,
                                          const axis::AxisStatus& status) noexcept;
[[nodiscard]] bridge::GroupSample sampleOf(core::CycleNumber cycle,
                                           const axis::GroupStatus& status) noexcept;

}  // namespace takt::daemon
