#include <algorithm>
#include <array>
#include <concepts>
#include <takt/record/pcapng_writer.hpp>

namespace takt::record {

namespace {

// Block and option numbers of the pcapng format (IETF draft-ietf-opsawg-pcapng, sections 4.1
// to 4.3).
constexpr std::uint32_t SectionHeaderBlock = 0x0A0D0D0A;
constexpr std::uint32_t InterfaceDescriptionBlock = 1;
constexpr std::uint32_t EnhancedPacketBlock = 6;
constexpr std::uint32_t ByteOrderMagic = 0x1A2B3C4D;
constexpr std::uint16_t OptionEnd = 0;
constexpr std::uint16_t OptionUserApplication = 4;
constexpr std::uint16_t OptionInterfaceName = 2;
constexpr std::uint16_t OptionTimeResolution = 9;
constexpr std::uint16_t OptionPacketFlags = 2;
constexpr std::uint16_t LinkTypeEthernet = 1;
constexpr std::uint8_t Nanoseconds = 9;
constexpr std::size_t PacketHeaderSize = 28;
constexpr std::size_t PacketTrailerSize = 16;  // flags option 8, end of options 4, length 4

constexpr std::size_t padding(std::size_t size) noexcept {
    return (4 - size % 4) % 4;
}

/// Little-endian bytes at a moving place.
struct Cursor {
    std::uint8_t* place;
    template <std::unsigned_integral T>
    void put(T value) noexcept {
        for (std::size_t i = 0; i < sizeof(T); ++i) {
            *place++ = static_cast<std::uint8_t>(std::uint64_t{value} >> (8 * i));
        }
    }
};

template <std::unsigned_integral T>
void append(std::vector<std::uint8_t>& bytes, T value) {
    std::array<std::uint8_t, sizeof(T)> raw{};
    Cursor{raw.data()}.put(value);
    bytes.insert(bytes.end(), raw.begin(), raw.end());
}

void appendOption(std::vector<std::uint8_t>& bytes, std::uint16_t code,
                  std::span<const std::uint8_t> value) {
    append(bytes, code);
    append(bytes, static_cast<std::uint16_t>(value.size()));
    bytes.insert(bytes.end(), value.begin(), value.end());
    bytes.insert(bytes.end(), padding(value.size()), std::uint8_t{0});
}

void appendTextOption(std::vector<std::uint8_t>& bytes, std::uint16_t code, std::string_view text) {
    const std::vector<std::uint8_t> raw(text.begin(), text.end());
    appendOption(bytes, code, raw);
}

/// Type, length in front and behind: the frame of every block.
void appendBlock(std::vector<std::uint8_t>& file, std::uint32_t type,
                 const std::vector<std::uint8_t>& body) {
    const auto length = static_cast<std::uint32_t>(body.size() + 12);
    append(file, type);
    append(file, length);
    file.insert(file.end(), body.begin(), body.end());
    append(file, length);
}

std::vector<std::uint8_t> fileHeader(std::string_view interfaceName) {
    std::vector<std::uint8_t> section;
    append(section, ByteOrderMagic);
    append(section, std::uint16_t{1});
    append(section, std::uint16_t{0});
    append(section, ~std::uint64_t{0});  // section length: not told
    appendTextOption(section, OptionUserApplication, "takt");
    appendOption(section, OptionEnd, {});

    std::vector<std::uint8_t> interface;
    append(interface, LinkTypeEthernet);
    append(interface, std::uint16_t{0});
    append(interface, std::uint32_t{0});  // no limit on the captured length
    if (!interfaceName.empty()) appendTextOption(interface, OptionInterfaceName, interfaceName);
    appendOption(interface, OptionTimeResolution, std::array{Nanoseconds});
    appendOption(interface, OptionEnd, {});

    std::vector<std::uint8_t> file;
    appendBlock(file, SectionHeaderBlock, section);
    appendBlock(file, InterfaceDescriptionBlock, interface);
    return file;
}

std::array<std::uint8_t, PacketHeaderSize> packetHeader(std::uint32_t blockLength,
                                                        core::HostTime stamp,
                                                        std::size_t frameSize) noexcept {
    std::array<std::uint8_t, PacketHeaderSize> header{};
    const auto time = static_cast<std::uint64_t>(stamp.time_since_epoch().count());
    Cursor cursor{header.data()};
    cursor.put(EnhancedPacketBlock);
    cursor.put(blockLength);
    cursor.put(std::uint32_t{0});  // interface
    cursor.put(static_cast<std::uint32_t>(time >> 32));
    cursor.put(static_cast<std::uint32_t>(time));
    cursor.put(static_cast<std::uint32_t>(frameSize));
    cursor.put(static_cast<std::uint32_t>(frameSize));
    return header;
}

std::array<std::uint8_t, PacketTrailerSize> packetTrailer(std::uint32_t blockLength,
                                                          Direction direction) noexcept {
    std::array<std::uint8_t, PacketTrailerSize> trailer{};
    Cursor cursor{trailer.data()};
    cursor.put(OptionPacketFlags);
    cursor.put(std::uint16_t{4});
    cursor.put(static_cast<std::uint32_t>(direction));
    cursor.put(OptionEnd);
    cursor.put(std::uint16_t{0});
    cursor.put(blockLength);
    return trailer;
}

}  // namespace

PcapngWriter::PcapngWriter(OutputFile& file, std::string_view interfaceName,
                           std::size_t bufferBytes)
    : file_{file}, ring_(bufferBytes) {
    file_.write(std::span<const std::uint8_t>{fileHeader(interfaceName)});
}

void PcapngWriter::copyIn(std::uint64_t at, std::span<const std::uint8_t> bytes) noexcept {
    const auto begin = static_cast<std::size_t>(at % ring_.size());
    const std::size_t first = std::min(bytes.size(), ring_.size() - begin);
    std::copy_n(bytes.data(), first, ring_.data() + begin);
    std::copy_n(bytes.data() + first, bytes.size() - first, ring_.data());
}

bool PcapngWriter::packet(Direction direction, core::HostTime stamp,
                          std::span<const std::uint8_t> frame) noexcept {
    constexpr std::array<std::uint8_t, 4> Zeros{};
    const std::size_t pad = padding(frame.size());
    const std::size_t total = PacketHeaderSize + frame.size() + pad + PacketTrailerSize;
    const std::uint64_t start = written_.load(std::memory_order_relaxed);
    if (start - drained_.load(std::memory_order_acquire) + total > ring_.size()) {
        dropped_.fetch_add(1, std::memory_order_relaxed);
        return false;
    }
    const auto length = static_cast<std::uint32_t>(total);
    copyIn(start, packetHeader(length, stamp, frame.size()));
    copyIn(start + PacketHeaderSize, frame);
    copyIn(start + PacketHeaderSize + frame.size(), std::span{Zeros}.first(pad));
    copyIn(start + total - PacketTrailerSize, packetTrailer(length, direction));
    packets_.fetch_add(1, std::memory_order_relaxed);
    written_.store(start + total, std::memory_order_release);
    return true;
}

void PcapngWriter::drain() {
    const std::uint64_t end = written_.load(std::memory_order_acquire);
    std::uint64_t at = drained_.load(std::memory_order_relaxed);
    while (at != end) {
        const auto begin = static_cast<std::size_t>(at % ring_.size());
        const auto size =
            static_cast<std::size_t>(std::min<std::uint64_t>(end - at, ring_.size() - begin));
        file_.write(std::span<const std::uint8_t>{ring_}.subspan(begin, size));
        at += size;
        drained_.store(at, std::memory_order_release);
    }
}

bool PcapngWriter::finish() {
    drain();
    return file_.flush() && dropped() == 0;
}

}  // namespace takt::record
