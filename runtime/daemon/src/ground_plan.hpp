#pragma once

#include <optional>
#include <takt/config/machine_config.hpp>
#include <takt/record/top_view.hpp>

namespace takt::daemon {

/// What a top view shows of the machine: the plane of the first two axes of the first group that
/// has obstacles, or of the first group, with its keep-outs. Empty when no group has two axes with
/// soft limits.
[[nodiscard]] std::optional<record::TopViewSpec> groundPlanOf(const config::MachineConfig& machine);

}  // namespace takt::daemon
