#pragma once

#include <string>
#include <takt/fieldbus/ethercat/network_state.hpp>
#include <takt/fieldbus/fieldbus_params.hpp>

#include "device_scan.hpp"
#include "slave_agent.hpp"

/// Everything the master says in words; outside the cycle only.
namespace takt::fieldbus::ethercat {

/// "slave 2 'z'"
[[nodiscard]] std::string slaveLabel(const NetworkParams& network, std::size_t slave);
[[nodiscard]] std::string describe(const NetworkParams& network, const NetworkProblem& problem);
/// What stopped a script, with the step's origin where it has one.
[[nodiscard]] std::string describe(const ScriptFailure& failure, const Step& step);
[[nodiscard]] std::string describe(const ScriptNote& note);
[[nodiscard]] std::string describe(const wire::Identity& identity);
/// What differs between a configured and a found device, one line each; nothing when they agree.
[[nodiscard]] std::vector<std::string> compare(const SlaveParams& expected,
                                               const ScannedDevice& found);

}  // namespace takt::fieldbus::ethercat
