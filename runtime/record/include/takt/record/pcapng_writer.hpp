#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <takt/core/time.hpp>
#include <takt/record/output_file.hpp>
#include <vector>

namespace takt::record {

enum class Direction : std::uint8_t { Inbound = 1, Outbound = 2 };  // bits 0 and 1 of epb_flags

/// Ethernet frames as a pcapng file (one section, one interface, nanoseconds). Packets are put into
/// a ring as finished blocks, so that the cycle only copies bytes; `drain` hands them to the file.
class PcapngWriter {
public:
    /// Writes section header and interface description. `file` must outlive the object.
    /// \param bufferBytes room for packets between two drains; a frame needs its length + 47 at
    /// most
    PcapngWriter(OutputFile& file, std::string_view interfaceName, std::size_t bufferBytes);

    /// rt. Producer only. A frame without FCS. \return false, and the packet is counted as dropped,
    /// when the buffer is full
    bool packet(Direction direction, core::HostTime stamp,
                std::span<const std::uint8_t> frame) noexcept;
    /// Consumer only. Writes what has been put in so far.
    void drain();
    /// Drains and flushes. \return whether every packet reached the file
    bool finish();

    /// rt. Packets put in and not dropped.
    [[nodiscard]] std::uint64_t packets() const noexcept {
        return packets_.load(std::memory_order_relaxed);
    }
    [[nodiscard]] std::uint64_t dropped() const noexcept {
        return dropped_.load(std::memory_order_relaxed);
    }

private:
    void copyIn(std::uint64_t at, std::span<const std::uint8_t> bytes) noexcept;

    OutputFile& file_;
    std::vector<std::uint8_t> ring_;
    alignas(64) std::atomic<std::uint64_t> written_{0};
    std::atomic<std::uint64_t> packets_{0};
    std::atomic<std::uint64_t> dropped_{0};
    alignas(64) std::atomic<std::uint64_t> drained_{0};
};

}  // namespace takt::record
