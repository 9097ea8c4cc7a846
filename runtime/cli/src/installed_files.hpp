#pragma once

#include <filesystem>
#include <vector>

namespace takt::cli {

/// Files that come with takt and are copied into new projects.
struct InstalledFiles {
    std::filesystem::path devices;  ///< folder of device files
    std::filesystem::path schema;   ///< machine.xsd
};

/// Looks beside the command as installed, then in the source tree of a build, then where systems
/// keep them. \throw std::runtime_error they are nowhere
[[nodiscard]] InstalledFiles findInstalledFiles(const std::filesystem::path& executableFolder);
/// All device files among them, by name.
[[nodiscard]] std::vector<std::filesystem::path> deviceFiles(const InstalledFiles& installed);

}  // namespace takt::cli
