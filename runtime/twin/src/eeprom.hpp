#pragma once

#include <cstdint>
#include <span>
#include <takt/core/time.hpp>
#include <vector>

namespace takt::twin {

/// The EEPROM interface of a slave controller (registers 0x0500 to 0x050F, ETG.1000.4 clause 6.4)
/// in front of an EEPROM image. A command takes time; while it runs the interface is busy.
class EepromInterface {
public:
    /// `registers` must outlive the object. `eightByteReads`: what 0x0502 bit 6 announces.
    EepromInterface(std::span<std::uint8_t> registers, std::vector<std::uint8_t> image,
                    bool eightByteReads);

    /// rt. Lets a command that is due finish. Call before any access to the registers.
    void settle(core::TrueTime now) noexcept;
    /// rt. The master writes `data` at `address` (inside 0x0500 … 0x050F), end of frame.
    void write(std::uint16_t address, std::span<const std::uint8_t> data,
               core::TrueTime now) noexcept;

    [[nodiscard]] const std::vector<std::uint8_t>& image() const noexcept { return image_; }

private:
    [[nodiscard]] bool busy() const noexcept;
    [[nodiscard]] bool ownedByMaster() const noexcept;
    void start(std::uint16_t control, core::TrueTime now) noexcept;
    void finish() noexcept;
    void writeWord() noexcept;

    std::span<std::uint8_t> registers_;
    std::vector<std::uint8_t> image_;
    std::uint16_t fixedBits_;
    std::uint16_t command_{0};
    core::TrueTime doneAt_{};
};

}  // namespace takt::twin
