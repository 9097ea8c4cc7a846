#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "control_command.hpp"
#include "event_text.hpp"

namespace takt::daemon {

/// One line of a command file with its end: `1234 inch X 0.1 5`, cycle, order, target, numbers.
/// Numbers in their shortest form that reads back exactly.
[[nodiscard]] std::string formatCommand(const TakenCommand& taken, const ControlNames& names);

/// Reads a command file; blank lines and lines that begin with '#' are skipped.
/// \param problems one `file:line: …` for each line that is wrong
[[nodiscard]] std::vector<TakenCommand> readCommands(const std::filesystem::path& file,
                                                     const ControlNames& names,
                                                     std::vector<std::string>& problems);

}  // namespace takt::daemon
