#pragma once

#include <cstdint>
#include <span>
#include <takt/core/fixed_vector.hpp>

namespace takt::twin {

inline constexpr std::size_t MaxFmmus = 16;

/// One active fieldbus memory management unit (ETG.1000.4 clause 6.6): it maps logical bits to
/// physical ones.
struct Fmmu {
    std::uint32_t logical{0};
    std::uint16_t length{0};  ///< bytes, started ones included
    std::uint8_t startBit{0};
    std::uint8_t stopBit{7};
    std::uint16_t physical{0};
    std::uint8_t physicalBit{0};
    bool read{false};
    bool write{false};

    [[nodiscard]] bool byteAligned() const noexcept {
        return startBit == 0 && stopBit == 7 && physicalBit == 0;
    }
};

using FmmuList = core::FixedVector<Fmmu, MaxFmmus>;

/// The active units that `registers` (from 0x0000) describe. \pre count <= MaxFmmus
[[nodiscard]] FmmuList decodeFmmus(std::span<const std::uint8_t> registers,
                                   std::size_t count) noexcept;

/// The bytes of a datagram that a unit covers.
struct Overlap {
    std::size_t datagramOffset{0};
    std::size_t unitOffset{0};
    std::size_t length{0};  ///< 0 = none
};

/// rt.
[[nodiscard]] inline Overlap overlapOf(const Fmmu& fmmu, std::uint32_t logical,
                                       std::size_t length) noexcept {
    const std::uint64_t unitEnd = std::uint64_t{fmmu.logical} + fmmu.length;
    const std::uint64_t datagramEnd = std::uint64_t{logical} + length;
    if (logical >= unitEnd || fmmu.logical >= datagramEnd) return {};
    const std::uint32_t first = fmmu.logical > logical ? fmmu.logical : logical;
    const std::uint64_t end = unitEnd < datagramEnd ? unitEnd : datagramEnd;
    return {first - logical, first - fmmu.logical, end - first};
}

}  // namespace takt::twin
