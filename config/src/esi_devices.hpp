#pragma once

#include <filesystem>
#include <string_view>
#include <takt/config/diagnostics.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

#include "esi_values.hpp"

namespace takt::config {

/// A device of an ESI file with what is wrong with it alone: a fault in one device of a long list
/// must not keep a machine from using another.
struct EsiDevice {
    wire::DeviceDescription description;
    Diagnostics diagnostics;
};

/// The <RxPdo> or <TxPdo> children of an element; ENI files define them in the same words.
[[nodiscard]] std::vector<wire::PdoDescription> readPdoElements(XmlElement element,
                                                                std::string_view name,
                                                                const EsiValues& values);

/// \param diagnostics what concerns the file as a whole
[[nodiscard]] std::vector<EsiDevice> readEsiDevices(const std::filesystem::path& file,
                                                    Diagnostics& diagnostics);

}  // namespace takt::config
