#pragma once

#include <takt/wire/device_description.hpp>
#include <vector>

#include "esi_values.hpp"

namespace takt::config {

/// The object dictionary of a device (Profile/Dictionary), ascending indices; empty where the file
/// has none.
[[nodiscard]] std::vector<wire::ObjectDescription> readDictionary(XmlElement device,
                                                                  const EsiValues& values);

}  // namespace takt::config
