#include <algorithm>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/frame.hpp>

namespace takt::wire {

namespace {

constexpr std::size_t AddressOffset = 2;
constexpr std::size_t LengthOffset = 6;
constexpr std::size_t IrqOffset = 8;
constexpr std::uint16_t LengthMask = 0x07FF;
constexpr std::uint16_t CirculatingBit = 0x4000;
constexpr std::uint16_t MoreBit = 0x8000;
constexpr std::uint16_t DatagramFrameType = 0x1000;
constexpr std::array<std::uint8_t, 6> Source{0x00, 0x10, 0x54, 0x41, 0x4B, 0x54};

}  // namespace

std::uint8_t DatagramView::rawCommand() const noexcept {
    return load8(bytes_, 0);
}
std::uint8_t DatagramView::index() const noexcept {
    return load8(bytes_, 1);
}
std::uint16_t DatagramView::adp() const noexcept {
    return load16(bytes_, AddressOffset);
}
std::uint16_t DatagramView::ado() const noexcept {
    return load16(bytes_, AddressOffset + 2);
}
std::uint32_t DatagramView::logicalAddress() const noexcept {
    return load32(bytes_, AddressOffset);
}
bool DatagramView::circulating() const noexcept {
    return (load16(bytes_, LengthOffset) & CirculatingBit) != 0;
}
std::uint16_t DatagramView::irq() const noexcept {
    return load16(bytes_, IrqOffset);
}
std::uint16_t DatagramView::workingCounter() const noexcept {
    return load16(bytes_, bytes_.size() - WorkingCounterSize);
}
std::span<std::uint8_t> DatagramView::data() const noexcept {
    return bytes_.subspan(DatagramHeaderSize, bytes_.size() - DatagramOverhead);
}
void DatagramView::setAdp(std::uint16_t value) const noexcept {
    store16(bytes_, AddressOffset, value);
}
void DatagramView::setCirculating() const noexcept {
    store16(bytes_, LengthOffset,
            static_cast<std::uint16_t>(load16(bytes_, LengthOffset) | CirculatingBit));
}
void DatagramView::orIrq(std::uint16_t value) const noexcept {
    store16(bytes_, IrqOffset, static_cast<std::uint16_t>(load16(bytes_, IrqOffset) | value));
}
void DatagramView::setWorkingCounter(std::uint16_t value) const noexcept {
    store16(bytes_, bytes_.size() - WorkingCounterSize, value);
}

DatagramCursor::DatagramCursor(std::span<std::uint8_t> frame) noexcept {
    constexpr std::size_t headers = EthernetHeaderSize + EtherCatHeaderSize;
    malformed_ = true;
    if (frame.size() < headers) return;
    // The EtherType is big-endian, as everywhere on Ethernet.
    if (frame[12] != (EtherType >> 8) || frame[13] != (EtherType & 0xFF)) return;
    const std::uint16_t header = load16(frame, EthernetHeaderSize);
    const std::size_t length = header & LengthMask;
    if ((header & 0xF000) != DatagramFrameType || headers + length > frame.size()) return;
    malformed_ = false;
    rest_ = frame.subspan(headers, length);
    more_ = !rest_.empty();
}

bool DatagramCursor::next() noexcept {
    if (!more_) return false;
    more_ = false;
    if (rest_.size() < DatagramOverhead) {
        malformed_ = true;
        return false;
    }
    const std::uint16_t word = load16(rest_, LengthOffset);
    const std::size_t total = (word & LengthMask) + DatagramOverhead;
    if (total > rest_.size()) {
        malformed_ = true;
        return false;
    }
    current_ = DatagramView{rest_.first(total)};
    rest_ = rest_.subspan(total);
    more_ = (word & MoreBit) != 0;
    if (!more_ && !rest_.empty()) malformed_ = true;
    return true;
}

FrameWriter::FrameWriter(Frame& frame) noexcept
    : frame_{frame}, end_{EthernetHeaderSize + EtherCatHeaderSize} {
    std::fill_n(frame_.bytes.begin(), 6, std::uint8_t{0xFF});
    std::copy(Source.begin(), Source.end(), frame_.bytes.begin() + 6);
    frame_.bytes[12] = EtherType >> 8;
    frame_.bytes[13] = EtherType & 0xFF;
    frame_.size = end_;
}

FrameWriter::FrameWriter(Frame& frame, DatagramPlace last) noexcept
    : frame_{frame},
      end_{static_cast<std::uint16_t>(last.offset + DatagramOverhead + last.length)},
      last_{last.offset} {
    const std::size_t at = last_ + LengthOffset;
    const std::span<std::uint8_t> bytes{frame_.bytes};
    store16(bytes, at, static_cast<std::uint16_t>(load16(bytes, at) & ~MoreBit));
    frame_.size = end_;
}

std::size_t FrameWriter::room() const noexcept {
    const std::size_t used = end_ + DatagramOverhead;
    return used >= MaxFrameSize ? 0 : MaxFrameSize - used;
}

DatagramPlace FrameWriter::appendRaw(Command command, std::uint8_t index, std::uint32_t address,
                                     std::uint16_t length) noexcept {
    assert(length <= room());
    std::span<std::uint8_t> bytes{frame_.bytes};
    if (last_ != 0) {
        const std::size_t at = last_ + LengthOffset;
        store16(bytes, at, static_cast<std::uint16_t>(load16(bytes, at) | MoreBit));
    }
    const DatagramPlace place{end_, length};
    store8(bytes, end_, static_cast<std::uint8_t>(command));
    store8(bytes, end_ + 1U, index);
    store32(bytes, end_ + AddressOffset, address);
    store16(bytes, end_ + LengthOffset, length);
    store16(bytes, end_ + IrqOffset, 0);
    std::fill_n(frame_.bytes.begin() + static_cast<std::ptrdiff_t>(place.dataOffset()),
                length + WorkingCounterSize, std::uint8_t{0});
    last_ = end_;
    end_ = static_cast<std::uint16_t>(end_ + DatagramOverhead + length);
    return place;
}

DatagramPlace FrameWriter::append(Command command, std::uint8_t index, std::uint16_t adp,
                                  std::uint16_t ado, std::uint16_t length) noexcept {
    return appendRaw(command, index, adp | (std::uint32_t{ado} << 16), length);
}

DatagramPlace FrameWriter::appendLogical(Command command, std::uint8_t index, std::uint32_t address,
                                         std::uint16_t length) noexcept {
    return appendRaw(command, index, address, length);
}

std::span<std::uint8_t> FrameWriter::data(DatagramPlace place) const noexcept {
    return std::span<std::uint8_t>{frame_.bytes}.subspan(place.dataOffset(), place.length);
}

void FrameWriter::finish() noexcept {
    const std::size_t headers = EthernetHeaderSize + EtherCatHeaderSize;
    store16(std::span<std::uint8_t>{frame_.bytes}, EthernetHeaderSize,
            static_cast<std::uint16_t>((end_ - headers) | DatagramFrameType));
    frame_.size = end_;
    while (frame_.size < MinFrameSize) frame_.bytes[frame_.size++] = 0;
}

}  // namespace takt::wire
