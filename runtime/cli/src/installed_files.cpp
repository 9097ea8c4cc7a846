#include "installed_files.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace takt::cli {

InstalledFiles findInstalledFiles(const std::filesystem::path& executableFolder) {
    const std::filesystem::path source = executableFolder / "../..";  // of build/<preset>/takt
    const auto shared = [](const std::filesystem::path& folder) {
        return InstalledFiles{folder / "devices", folder / "schema/machine.xsd"};
    };
    const std::array places{
        shared(executableFolder / TAKT_SHARED_FROM_BIN),
        InstalledFiles{source / "samples/devices", source / "config/schema/machine.xsd"},
        shared("/usr/local/share/takt"), shared("/usr/share/takt")};
    for (const InstalledFiles& place : places) {
        if (std::filesystem::is_directory(place.devices) &&
            std::filesystem::is_regular_file(place.schema)) {
            return {place.devices.lexically_normal(), place.schema.lexically_normal()};
        }
    }
    throw std::runtime_error{
        "the device files and the schema of takt are not beside the command; install takt"};
}

std::vector<std::filesystem::path> deviceFiles(const InstalledFiles& installed) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator{installed.devices}) {
        if (entry.path().extension() == ".xml") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace takt::cli
