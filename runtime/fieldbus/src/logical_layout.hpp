#pragma once

#include <cstddef>
#include <cstdint>
#include <takt/fieldbus/fieldbus_params.hpp>
#include <takt/wire/frame.hpp>
#include <vector>

namespace takt::fieldbus::ethercat {

inline constexpr std::uint32_t LogicalBase = 0x0001'0000;  ///< of the first group
inline constexpr std::uint32_t LogicalGroupStep = 0x0001'0000;
inline constexpr std::uint32_t MailboxStateBase = 0x0900'0000;  ///< one bit for each device
inline constexpr std::uint16_t NoMailboxBit = 0xFFFF;
/// Bytes of datagrams, headers included, that one frame can carry.
inline constexpr std::size_t FrameCapacity = wire::MaxDatagramData + wire::DatagramOverhead;

/// Where one slave's process data lie.
struct SlavePlace {
    std::uint16_t group{0};
    std::uint16_t outputOffset{0};  ///< inside the output part of its group
    std::uint16_t outputBytes{0};
    std::uint16_t inputOffset{0};  ///< inside the input part of its group
    std::uint16_t inputBytes{0};
    std::uint16_t mailboxBit{NoMailboxBit};  ///< inside the mailbox state area
};

/// Process data that travel in one datagram (two where LRW is not possible), outputs first. A slave
/// is never split over two groups: its SyncManager buffer would be handed over half old.
struct ProcessGroup {
    std::uint32_t logical{LogicalBase};
    std::uint16_t outputBytes{0};
    std::uint16_t inputBytes{0};
    std::uint16_t firstSlave{0};
    std::uint16_t slaveCount{0};
    std::uint16_t writers{0};  ///< slaves with outputs
    std::uint16_t readers{0};  ///< slaves with inputs
    bool lrw{true};

    [[nodiscard]] std::uint32_t inputLogical() const noexcept { return logical + outputBytes; }
    /// Working counter of the LRW: 2 for a slave that was written and 1 for one that was read.
    [[nodiscard]] std::uint16_t expectedLrw() const noexcept {
        return static_cast<std::uint16_t>(2 * writers + readers);
    }
};

struct LogicalLayout {
    std::vector<SlavePlace> slaves;
    std::vector<ProcessGroup> groups;  ///< one frame each
    std::uint16_t mailboxBits{0};
    bool fits{true};  ///< false: some slave's process data alone exceed a frame

    [[nodiscard]] std::uint16_t mailboxBytes() const noexcept {
        return static_cast<std::uint16_t>((mailboxBits + 7) / 8);
    }
};

[[nodiscard]] LogicalLayout makeLayout(const NetworkParams& network);

}  // namespace takt::fieldbus::ethercat
