#pragma once

#include <cstdint>
#include <string>
#include <takt/axis/axis_view.hpp>
#include <takt/axis/group_view.hpp>
#include <takt/fieldbus/ethercat/network_state.hpp>
#include <takt/record/event_log.hpp>
#include <vector>

#include "control_command.hpp"
#include "machine_stop.hpp"
#include "program_host.hpp"

/// The events of a running machine: made in the cycle as numbers, put into words outside.
namespace takt::daemon {

enum class EventId : std::uint16_t {
    NetworkChanged = 1,
    AxisChanged,
    AxisFailed,
    ProgramChanged,
    MachineStopped,
    MachineStopReset,
    CommandTaken,
    CommandRefused,
    StationFailed,
    OperatorLost,
    GroupChanged,
    GroupFailed,
};

// rt.
[[nodiscard]] record::Event networkChanged(core::CycleNumber cycle,
                                           fieldbus::ethercat::NetworkState to) noexcept;
[[nodiscard]] record::Event axisChanged(core::CycleNumber cycle, std::uint16_t axis,
                                        axis::AxisState from, axis::AxisState to) noexcept;
[[nodiscard]] record::Event axisFailed(core::CycleNumber cycle, std::uint16_t axis,
                                       const axis::ErrorRecord& error) noexcept;
[[nodiscard]] record::Event groupChanged(core::CycleNumber cycle, std::uint16_t group,
                                         axis::GroupState from, axis::GroupState to) noexcept;
[[nodiscard]] record::Event groupFailed(core::CycleNumber cycle, std::uint16_t group,
                                        const axis::ErrorRecord& error) noexcept;
[[nodiscard]] record::Event programChanged(core::CycleNumber cycle, std::uint16_t program,
                                           ProgramPhase phase, bool held) noexcept;
[[nodiscard]] record::Event machineStopped(core::CycleNumber cycle,
                                           const StopRecord& stop) noexcept;
[[nodiscard]] record::Event machineStopReset(core::CycleNumber cycle) noexcept;
[[nodiscard]] record::Event commandTaken(core::CycleNumber cycle,
                                         const ControlCommand& command) noexcept;
[[nodiscard]] record::Event commandRefused(core::CycleNumber cycle, const ControlCommand& command,
                                           Refusal refusal, std::uint16_t detail) noexcept;
[[nodiscard]] record::Event stationFailed(core::CycleNumber cycle, std::uint16_t axis,
                                          axis::ErrorId error) noexcept;
[[nodiscard]] record::Event operatorLost(core::CycleNumber cycle, std::uint16_t axis) noexcept;

/// The names behind the numbers.
struct ControlNames {
    std::vector<std::string> axes;
    std::vector<std::string> units;  ///< of the axes
    std::vector<std::string> groups;
    std::vector<std::string> groupUnits;  ///< of path length
    std::vector<std::string> programs;
    std::vector<std::string> stopInputs;
    std::vector<std::string> devices;
};

/// The names among which an order's target stands. \pre the order has a target
[[nodiscard]] const std::vector<std::string>& namesOf(OrderTarget target,
                                                      const ControlNames& names) noexcept;
[[nodiscard]] const char* name(ProgramPhase phase, bool held) noexcept;
/// "axis X is held by program 'pick'; do: …"
[[nodiscard]] std::string explain(Refusal refusal, Order order, std::uint16_t target,
                                  std::uint16_t detail, const ControlNames& names);
/// The sentence without the cycle.
[[nodiscard]] std::string text(const record::Event& event, const ControlNames& names);

}  // namespace takt::daemon
