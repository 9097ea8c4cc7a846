#pragma once

#include <cstddef>
#include <cstdint>
#include <takt/wire/frame.hpp>

namespace takt::fieldbus {

/// The frames that the kernel has received, in memory shared with it (packet(7), TPACKET_V2):
/// taking one costs no system call, and each carries the kernel's arrival time.
class PacketRing {
public:
    PacketRing() = default;
    ~PacketRing();
    PacketRing(const PacketRing&) = delete;
    PacketRing& operator=(const PacketRing&) = delete;

    /// Before the socket is bound. \return 0, or the error number
    int open(int socket) noexcept;
    /// rt. Copies the oldest frame into `to`; its stamp is wall time, in ns since 1970. Frames
    /// longer than Ethernet allows are dropped. \return false when there is none
    bool take(wire::Frame& to) noexcept;

private:
    void* memory_{nullptr};
    std::size_t next_{0};
};

/// Brings the kernel's arrival stamps, which are wall time, onto the monotonic clock.
class WallClockBridge {
public:
    WallClockBridge() noexcept;

    /// rt. Follows the wall clock; call it before a batch of stamps.
    void update() noexcept;
    /// rt. Never later than now.
    [[nodiscard]] core::HostTime toMonotonic(core::HostTime wallStamp) const noexcept;

private:
    [[nodiscard]] bool measure(std::int64_t tolerance) noexcept;

    std::int64_t wallMinusMonotonic_{0};
};

/// rt. CLOCK_MONOTONIC.
[[nodiscard]] core::HostTime monotonicNow() noexcept;

}  // namespace takt::fieldbus
