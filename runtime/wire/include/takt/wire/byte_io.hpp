#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace takt::wire {

// rt. Little-endian loads and stores, byte by byte: no alignment, no packed structs.
// \pre offset + width <= bytes.size()

[[nodiscard]] inline std::uint8_t load8(std::span<const std::uint8_t> b, std::size_t at) noexcept {
    assert(at + 1 <= b.size());
    return b[at];
}
[[nodiscard]] inline std::uint16_t load16(std::span<const std::uint8_t> b, std::size_t at) noexcept {
    assert(at + 2 <= b.size());
    return static_cast<std::uint16_t>(b[at] | (b[at + 1] << 8));
}
[[nodiscard]] inline std::uint32_t load32(std::span<const std::uint8_t> b, std::size_t at) noexcept {
    assert(at + 4 <= b.size());
    return std::uint32_t{b[at]} | (std::uint32_t{b[at + 1]} << 8) |
           (std::uint32_t{b[at + 2]} << 16) | (std::uint32_t{b[at + 3]} << 24);
}
[[nodiscard]] inline std::uint64_t load64(std::span<const std::uint8_t> b, std::size_t at) noexcept {
    return std::uint64_t{load32(b, at)} | (std::uint64_t{load32(b, at + 4)} << 32);
}

inline void store8(std::span<std::uint8_t> b, std::size_t at, std::uint8_t v) noexcept {
    assert(at + 1 <= b.size());
    b[at] = v;
}
inline void store16(std::span<std::uint8_t> b, std::size_t at, std::uint16_t v) noexcept {
    assert(at + 2 <= b.size());
    b[at] = static_cast<std::uint8_t>(v);
    b[at + 1] = static_cast<std::uint8_t>(v >> 8);
}
inline void store32(std::span<std::uint8_t> b, std::size_t at, std::uint32_t v) noexcept {
    assert(at + 4 <= b.size());
    for (std::size_t i = 0; i < 4; ++i) b[at + i] = static_cast<std::uint8_t>(v >> (8 * i));
}
inline void store64(std::span<std::uint8_t> b, std::size_t at, std::uint64_t v) noexcept {
    store32(b, at, static_cast<std::uint32_t>(v));
    store32(b, at + 4, static_cast<std::uint32_t>(v >> 32));
}

}  // namespace takt::wire
