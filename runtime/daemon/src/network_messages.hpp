#pragma once

#include <string>
#include <takt/daemon/network_report.hpp>

#include "json_members.hpp"

/// The state of the network as JSON.
namespace takt::daemon {

[[nodiscard]] Json jsonOf(const NetworkReport& network);
/// `error` keeps the first member that is not what it should be.
[[nodiscard]] NetworkReport networkOf(const Json& json, std::string& error);

}  // namespace takt::daemon
