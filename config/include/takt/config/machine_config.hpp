#pragma once

#include <memory>
#include <string>
#include <takt/axis/axis_params.hpp>
#include <takt/axis/group_params.hpp>
#include <takt/axis/machine_stop_params.hpp>
#include <takt/bridge/bridge_params.hpp>
#include <takt/fieldbus/fieldbus_params.hpp>
#include <takt/planner/roadmap/roadmap_params.hpp>
#include <takt/program/program_params.hpp>
#include <takt/scheduler/scheduler_params.hpp>
#include <takt/twin/twin_params.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

namespace takt::config {

/// Everything a machine.xml says, checked. Plain data; each room takes the part that is its own.
struct MachineConfig {
    std::string file;
    std::string name;
    fieldbus::NetworkParams network;
    scheduler::SchedulerParams scheduler;
    std::vector<axis::AxisParams> axes;
    std::vector<axis::GroupParams> groups;
    std::vector<planner::roadmap::ObstacleParams> obstacles;  ///< one at most for each group
    std::vector<program::ProgramParams> programs;
    axis::MachineStopParams machineStop;  ///< inputs name slaves and mapped entries that exist
    bridge::BridgeParams bridge;
    /// What stands on the simulated network, one for each slave; what is configured unless the file
    /// says otherwise.
    std::vector<std::shared_ptr<const wire::DeviceDescription>> twinDevices;
    twin::TwinParams twin;  ///< one device for each slave, defaults where <Twin> is silent
};

}  // namespace takt::config
