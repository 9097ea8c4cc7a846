#include "device_state.hpp"

#include <fmt/format.h>

#include <takt/wire/al_state.hpp>

namespace takt::cli {

std::string stateWord(const fieldbus::ethercat::SegmentDevice& device) {
    if (device.state == wire::AlState::None) return "silent";
    return fmt::format("{}{}", wire::name(device.state), device.stateError ? " + ERROR" : "");
}

std::string problemOf(const fieldbus::ethercat::SegmentDevice& device) {
    if (device.state == wire::AlState::None) return "does not answer; check cable and power";
    if (!device.stateError) return {};
    return fmt::format("0x{:04X} {}", device.alStatusCode,
                       wire::explainAlStatus(device.alStatusCode));
}

}  // namespace takt::cli
