#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <takt/config/diagnostics.hpp>
#include <takt/config/machine_config.hpp>
#include <vector>

namespace takt::config {

struct LoadResult {
    std::optional<MachineConfig> machine;  ///< empty when there is at least one error
    Diagnostics diagnostics;               ///< sorted
};

/// Whether the program libraries that a machine file names must be there.
enum class ProgramLibraries : std::uint8_t {
    Needed,
    NotNeeded,  ///< programs are not run, or others in their place: paths stay as they are written
};

/// Reads, checks and completes a machine file and the device files it names. Never throws for what
/// a file says; nothing outside the result changes.
///
/// Relative paths are resolved against the machine file. A program library is looked for beside the
/// machine file first and then in `librarySearch`, in order.
[[nodiscard]] LoadResult loadMachine(const std::filesystem::path& file,
                                     const std::vector<std::filesystem::path>& librarySearch = {},
                                     ProgramLibraries libraries = ProgramLibraries::Needed);

}  // namespace takt::config
