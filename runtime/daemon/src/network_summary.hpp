#pragma once

#include <span>
#include <takt/config/machine_config.hpp>
#include <takt/daemon/network_report.hpp>

#include "diagnosis_board.hpp"

namespace takt::daemon {

/// Puts what the cycle has noted into names and words. Outside the cycle.
[[nodiscard]] NetworkReport summarize(const config::MachineConfig& machine,
                                      const DiagnosisEntry& entry,
                                      std::span<const DeviceEntry> devices);

}  // namespace takt::daemon
