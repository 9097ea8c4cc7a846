#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace takt::core {

/// Where one process-data entry of a device lies inside that device's own input or output bytes.
/// Little-endian, bit-packed, as CiA 301 / ETG.1000.6 lay out a PDO.
struct PdoSlot {
    std::uint32_t bitOffset{0};
    std::uint8_t bitLength{0};  ///< 1 to 32

    [[nodiscard]] constexpr bool present() const noexcept { return bitLength != 0; }
};

/// rt. The entry as an unsigned number. \pre the slot lies inside `image`
[[nodiscard]] std::uint32_t readUnsigned(std::span<const std::uint8_t> image,
                                         PdoSlot slot) noexcept;
/// rt. The entry as a two's complement number. \pre the slot lies inside `image`
[[nodiscard]] std::int32_t readSigned(std::span<const std::uint8_t> image, PdoSlot slot) noexcept;
/// rt. Writes the low `bitLength` bits; neighbouring bits keep their value. \pre the slot lies
/// inside `image`
void write(std::span<std::uint8_t> image, PdoSlot slot, std::uint32_t value) noexcept;

/// What a master knows of one device this cycle; written by the master, read by the axes.
struct DeviceHealth {
    bool operational{false};        ///< the device is in OP and outputs reach it
    bool inputsFresh{false};        ///< `inputs` are of this cycle
    std::uint32_t lostInRow{0};     ///< consecutive cycles without valid inputs
    std::uint16_t alStatusCode{0};  ///< ETG.1000.6 AL status code, 0 = none
};

/// One device's share of the process image. The spans stay valid as long as the master lives.
struct DeviceImage {
    std::span<const std::uint8_t> inputs;
    std::span<std::uint8_t> outputs;
    const DeviceHealth* health{nullptr};
};

}  // namespace takt::core
