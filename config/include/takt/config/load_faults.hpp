#pragma once

#include <filesystem>
#include <optional>
#include <takt/config/diagnostics.hpp>
#include <takt/twin/twin_params.hpp>

namespace takt::config {

/// Reads a fault file: what goes wrong on the simulated machine, by cycle number.
///
///     <Faults>
///       <LostFrames cycle="5000" cycles="2"/>
///     </Faults>
/// \return empty when there is at least one error
[[nodiscard]] std::optional<twin::FaultParams> loadFaults(const std::filesystem::path& file,
                                                          Diagnostics& diagnostics);

}  // namespace takt::config
