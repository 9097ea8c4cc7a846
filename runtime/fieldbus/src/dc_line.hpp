#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <takt/core/time.hpp>
#include <vector>

namespace takt::fieldbus::ethercat {

/// What the system time of the bus shows when the host's clock shows zero: 800 000 000 s after
/// 2000-01-01. A constant, so that runs in virtual time are alike.
inline constexpr core::Duration DcEpoch = std::chrono::seconds{800'000'000};

/// Arrival times of one frame at the ports of one device (0x0900 to 0x090F), in frame order.
struct PortTimes {
    bool dc{false};
    std::uint8_t openPorts{1};  ///< one bit for each open port
    std::array<std::uint32_t, 4> at{};
};

/// Propagation delay from the first DC device to each device, for 0x0928. Works on lines and trees:
/// the tree follows from the number of open ports, frames visit the ports in the order 0, 3, 1, 2.
/// Devices without DC are passed through and get 0.
[[nodiscard]] std::vector<std::uint32_t> propagationDelays(std::span<const PortTimes> devices);

/// The first instant of the grid at or after `earliest`. \pre grid > 0
[[nodiscard]] core::DcTime gridAtOrAfter(core::DcTime earliest, core::Duration grid) noexcept;

/// rt. `time` against a grid of `cycle` with the given phase, folded to [-cycle/2, cycle/2).
[[nodiscard]] core::Duration phaseError(core::DcTime time, core::Duration phase,
                                        core::Duration cycle) noexcept;

}  // namespace takt::fieldbus::ethercat
