#pragma once

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace takt::wire {

namespace detail {

/// A copy of bytes needs no alignment and becomes one instruction; byte by byte it does not with
/// every compiler, and every frame passes here.
template <typename Number>
[[nodiscard]] inline Number loadLittleEndian(const std::uint8_t* bytes) noexcept {
    Number value{0};
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(&value, bytes, sizeof value);
    } else {
        for (std::size_t i = 0; i < sizeof value; ++i) {
            value = static_cast<Number>(value | (static_cast<Number>(bytes[i]) << (8 * i)));
        }
    }
    return value;
}

template <typename Number>
inline void storeLittleEndian(std::uint8_t* bytes, Number value) noexcept {
    if constexpr (std::endian::native == std::endian::little) {
        std::memcpy(bytes, &value, sizeof value);
    } else {
        for (std::size_t i = 0; i < sizeof value; ++i) {
            bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
        }
    }
}

}  // namespace detail

// rt. Little-endian loads and stores at any address: no alignment, no packed structs.
// \pre offset + width <= bytes.size()

[[nodiscard]] inline std::uint8_t load8(std::span<const std::uint8_t> b, std::size_t at) noexcept {
    assert(at + 1 <= b.size());
    return b[at];
}
[[nodiscard]] inline std::uint16_t load16(std::span<const std::uint8_t> b,
                                          std::size_t at) noexcept {
    assert(at + 2 <= b.size());
    return detail::loadLittleEndian<std::uint16_t>(b.data() + at);
}
[[nodiscard]] inline std::uint32_t load32(std::span<const std::uint8_t> b,
                                          std::size_t at) noexcept {
    assert(at + 4 <= b.size());
    return detail::loadLittleEndian<std::uint32_t>(b.data() + at);
}
[[nodiscard]] inline std::uint64_t load64(std::span<const std::uint8_t> b,
                                          std::size_t at) noexcept {
    assert(at + 8 <= b.size());
    return detail::loadLittleEndian<std::uint64_t>(b.data() + at);
}

inline void store8(std::span<std::uint8_t> b, std::size_t at, std::uint8_t v) noexcept {
    assert(at + 1 <= b.size());
    b[at] = v;
}
inline void store16(std::span<std::uint8_t> b, std::size_t at, std::uint16_t v) noexcept {
    assert(at + 2 <= b.size());
    detail::storeLittleEndian(b.data() + at, v);
}
inline void store32(std::span<std::uint8_t> b, std::size_t at, std::uint32_t v) noexcept {
    assert(at + 4 <= b.size());
    detail::storeLittleEndian(b.data() + at, v);
}
inline void store64(std::span<std::uint8_t> b, std::size_t at, std::uint64_t v) noexcept {
    assert(at + 8 <= b.size());
    detail::storeLittleEndian(b.data() + at, v);
}

}  // namespace takt::wire
