#pragma once

#include <string>
#include <takt/daemon/control_messages.hpp>

namespace takt::cli {

/// The status of a machine as lines of a table, each with its end.
[[nodiscard]] std::string statusTable(const daemon::StatusReport& status);

}  // namespace takt::cli
