#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/core/time.hpp>

/// EtherCAT frame layout (ETG.1000.4 clause 5): Ethernet header, EtherCAT header, datagrams,
/// padding.
namespace takt::wire {

enum class Command : std::uint8_t {
    Nop = 0,
    Aprd = 1,
    Apwr = 2,
    Aprw = 3,
    Fprd = 4,
    Fpwr = 5,
    Fprw = 6,
    Brd = 7,
    Bwr = 8,
    Brw = 9,
    Lrd = 10,
    Lwr = 11,
    Lrw = 12,
    Armw = 13,
    Frmw = 14,
};

inline constexpr std::size_t EthernetHeaderSize = 14;
inline constexpr std::size_t EtherCatHeaderSize = 2;
inline constexpr std::size_t DatagramHeaderSize = 10;
inline constexpr std::size_t WorkingCounterSize = 2;
inline constexpr std::size_t DatagramOverhead = DatagramHeaderSize + WorkingCounterSize;
inline constexpr std::size_t MinFrameSize = 60;    ///< without FCS
inline constexpr std::size_t MaxFrameSize = 1514;  ///< without FCS
inline constexpr std::size_t MaxDatagramData =
    MaxFrameSize - EthernetHeaderSize - EtherCatHeaderSize - DatagramOverhead;
inline constexpr std::uint16_t EtherType = 0x88A4;  ///< big-endian on the wire
inline constexpr std::uint8_t SourceSeenBit =
    0x02;  ///< an ESC sets it in the first byte of the source MAC

/// One Ethernet frame without FCS. `stamp`: when it was sent or when it arrived, by the host's
/// clock.
struct Frame {
    std::array<std::uint8_t, MaxFrameSize> bytes{};
    std::uint16_t size{0};
    core::HostTime stamp{};

    [[nodiscard]] std::span<const std::uint8_t> view() const noexcept {
        return {bytes.data(), size};
    }
    [[nodiscard]] std::span<std::uint8_t> view() noexcept { return {bytes.data(), size}; }
};

/// Length on the wire in bytes: preamble, FCS and inter-frame gap included; 80 ns each at 100
/// Mbit/s.
[[nodiscard]] constexpr std::size_t wireBytes(std::size_t frameSize) noexcept {
    return (frameSize < MinFrameSize ? MinFrameSize : frameSize) + 8 + 4 + 12;
}

/// One datagram inside a frame; `data` and the setters write through to the frame's bytes.
class DatagramView {
public:
    DatagramView() = default;
    /// \pre `bytes` covers exactly header, data and working counter
    explicit DatagramView(std::span<std::uint8_t> bytes) noexcept : bytes_{bytes} {}

    [[nodiscard]] std::uint8_t rawCommand() const noexcept;
    [[nodiscard]] std::uint8_t index() const noexcept;
    [[nodiscard]] std::uint16_t adp() const noexcept;  ///< position or station address
    [[nodiscard]] std::uint16_t ado() const noexcept;  ///< register or memory address
    [[nodiscard]] std::uint32_t logicalAddress() const noexcept;
    [[nodiscard]] bool circulating() const noexcept;
    [[nodiscard]] std::uint16_t irq() const noexcept;
    [[nodiscard]] std::uint16_t workingCounter() const noexcept;
    [[nodiscard]] std::span<std::uint8_t> data() const noexcept;
    [[nodiscard]] std::span<const std::uint8_t> all() const noexcept { return bytes_; }

    void setAdp(std::uint16_t value) const noexcept;
    void setCirculating() const noexcept;
    void orIrq(std::uint16_t value) const noexcept;
    void setWorkingCounter(std::uint16_t value) const noexcept;

private:
    std::span<std::uint8_t> bytes_;
};

/// Walks over the datagrams of a frame; every length is checked against the frame before use.
///
///     DatagramCursor cursor{frame.view()};
///     while (cursor.next()) use(cursor.datagram());
///     if (cursor.malformed()) …
class DatagramCursor {
public:
    explicit DatagramCursor(std::span<std::uint8_t> frame) noexcept;

    /// rt. \return false at the end or where the frame contradicts itself
    bool next() noexcept;
    [[nodiscard]] const DatagramView& datagram() const noexcept { return current_; }
    /// Not an EtherCAT frame, or a length that does not fit.
    [[nodiscard]] bool malformed() const noexcept { return malformed_; }

private:
    std::span<std::uint8_t> rest_;
    DatagramView current_;
    bool more_{false};
    bool malformed_{false};
};

/// Where a datagram that was appended lies in its frame.
struct DatagramPlace {
    std::uint16_t offset{0};  ///< of the datagram header inside the frame
    std::uint16_t length{0};  ///< of the data

    [[nodiscard]] constexpr std::size_t dataOffset() const noexcept {
        return offset + DatagramHeaderSize;
    }
};

/// Puts a frame together: begin, append…, finish.
class FrameWriter {
public:
    /// rt. Starts an empty frame: broadcast destination, a locally chosen source with SourceSeenBit
    /// clear.
    explicit FrameWriter(Frame& frame) noexcept;
    /// rt. Goes on behind `last`, a datagram of a frame that was finished before; what followed is
    /// dropped.
    FrameWriter(Frame& frame, DatagramPlace last) noexcept;

    /// rt. Bytes of data that one more datagram may carry.
    [[nodiscard]] std::size_t room() const noexcept;
    [[nodiscard]] bool empty() const noexcept { return last_ == 0; }

    /// rt. Appends a datagram with data of `length` zero bytes and working counter 0. \pre length
    /// <= room()
    DatagramPlace append(Command command, std::uint8_t index, std::uint16_t adp, std::uint16_t ado,
                         std::uint16_t length) noexcept;
    /// rt. The same for a logical address. \pre length <= room()
    DatagramPlace appendLogical(Command command, std::uint8_t index, std::uint32_t address,
                                std::uint16_t length) noexcept;
    /// rt. The data bytes of a datagram appended before.
    [[nodiscard]] std::span<std::uint8_t> data(DatagramPlace place) const noexcept;
    /// rt. Writes the EtherCAT header and pads to the minimum size.
    void finish() noexcept;

private:
    DatagramPlace appendRaw(Command command, std::uint8_t index, std::uint32_t address,
                            std::uint16_t length) noexcept;

    Frame& frame_;
    std::uint16_t end_;
    std::uint16_t last_{0};
};

}  // namespace takt::wire
