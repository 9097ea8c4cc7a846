#include <cassert>
#include <takt/core/process_image.hpp>

namespace takt::core {

namespace {

constexpr std::uint64_t lowBits(std::uint8_t count) noexcept {
    return (std::uint64_t{1} << count) - 1;
}

constexpr std::size_t bytesTouched(PdoSlot slot) noexcept {
    return (slot.bitOffset % 8 + slot.bitLength + 7) / 8;
}

}  // namespace

std::uint32_t readUnsigned(std::span<const std::uint8_t> image, PdoSlot slot) noexcept {
    const std::size_t first = slot.bitOffset / 8;
    const std::size_t count = bytesTouched(slot);
    assert(slot.bitLength <= 32 && first + count <= image.size());
    std::uint64_t raw = 0;
    for (std::size_t i = 0; i < count; ++i) raw |= std::uint64_t{image[first + i]} << (8 * i);
    return static_cast<std::uint32_t>((raw >> (slot.bitOffset % 8)) & lowBits(slot.bitLength));
}

std::int32_t readSigned(std::span<const std::uint8_t> image, PdoSlot slot) noexcept {
    const std::uint32_t raw = readUnsigned(image, slot);
    if (slot.bitLength == 0 || slot.bitLength >= 32) return static_cast<std::int32_t>(raw);
    const std::uint32_t sign = std::uint32_t{1} << (slot.bitLength - 1);
    return static_cast<std::int32_t>((raw ^ sign) - sign);
}

void write(std::span<std::uint8_t> image, PdoSlot slot, std::uint32_t value) noexcept {
    const std::size_t first = slot.bitOffset / 8;
    const std::size_t count = bytesTouched(slot);
    assert(slot.bitLength <= 32 && first + count <= image.size());
    const std::uint64_t mask = lowBits(slot.bitLength) << (slot.bitOffset % 8);
    const std::uint64_t bits = (std::uint64_t{value} << (slot.bitOffset % 8)) & mask;
    for (std::size_t i = 0; i < count; ++i) {
        const auto byteMask = static_cast<std::uint8_t>(mask >> (8 * i));
        const auto byteBits = static_cast<std::uint8_t>(bits >> (8 * i));
        std::uint8_t& byte = image[first + i];
        byte = static_cast<std::uint8_t>((byte & ~byteMask) | byteBits);
    }
}

}  // namespace takt::core
