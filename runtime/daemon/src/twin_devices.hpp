#pragma once

#include <memory>
#include <takt/config/machine_config.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

namespace takt::daemon {

/// The descriptions that the twin of a machine is built from, in frame order.
[[nodiscard]] inline std::vector<std::shared_ptr<const wire::DeviceDescription>> twinDevices(
    const config::MachineConfig& machine) {
    std::vector<std::shared_ptr<const wire::DeviceDescription>> devices;
    for (const fieldbus::SlaveParams& slave : machine.network.slaves) {
        devices.push_back(slave.device);
    }
    return devices;
}

}  // namespace takt::daemon
