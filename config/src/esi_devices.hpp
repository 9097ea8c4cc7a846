#pragma once

#include <filesystem>
#include <takt/config/diagnostics.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

namespace takt::config {

/// A device of an ESI file with what is wrong with it alone: a fault in one device of a long list
/// must not keep a machine from using another.
struct EsiDevice {
    wire::DeviceDescription description;
    Diagnostics diagnostics;
};

/// \param diagnostics what concerns the file as a whole
[[nodiscard]] std::vector<EsiDevice> readEsiDevices(const std::filesystem::path& file,
                                                    Diagnostics& diagnostics);

}  // namespace takt::config
