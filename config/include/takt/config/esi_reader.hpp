#pragma once

#include <filesystem>
#include <takt/config/diagnostics.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

namespace takt::config {

/// Reads all devices of an EtherCAT device description file (ESI, ETG.2000), in file order. A
/// device with an error is left out, the error says why; what is unknown in vendor parts is passed
/// over. Modules of modular devices (Slots) are not read; a note says so.
[[nodiscard]] std::vector<wire::DeviceDescription> readEsi(const std::filesystem::path& file,
                                                           Diagnostics& diagnostics);

}  // namespace takt::config
