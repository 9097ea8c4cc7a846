#pragma once

#include <string>
#include <takt/fieldbus/ethercat/segment_tool.hpp>

namespace takt::cli {

/// "PREOP", "SAFEOP + ERROR", "silent"
[[nodiscard]] std::string stateWord(const fieldbus::ethercat::SegmentDevice& device);
/// "0x001D invalid output configuration …" while the device shows an error; else empty.
[[nodiscard]] std::string problemOf(const fieldbus::ethercat::SegmentDevice& device);

}  // namespace takt::cli
