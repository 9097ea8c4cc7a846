#pragma once

#include <cstdint>
#include <string>

namespace takt::bridge {

/// What the machine file says of the DDS door. Loopback only unless told otherwise.
struct DdsParams {
    bool enabled{false};
    std::uint32_t everyCycles{10};   ///< status is published in every n-th cycle
    std::uint32_t domain{0};         ///< 0 … 230
    std::string interface { "lo" };  ///< network interface; "lo" = this computer only
    bool commands{false};            ///< axis commands are taken
};

struct BridgeParams {
    DdsParams dds;
};

}  // namespace takt::bridge
