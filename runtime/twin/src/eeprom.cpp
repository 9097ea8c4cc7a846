#include "eeprom.hpp"

#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

namespace takt::twin {

namespace reg = wire::reg;
using wire::load16;
using wire::load32;
using wire::store16;

namespace {

// 0x0502 (ETG.1000.4 table 47).
constexpr std::uint16_t WriteEnable = 0x0001;
constexpr std::uint16_t EightBytes = 0x0040;
constexpr std::uint16_t LargeDevice = 0x0080;
constexpr std::uint16_t CommandMask = 0x0700;
constexpr std::uint16_t CommandRead = 0x0100;
constexpr std::uint16_t CommandWrite = 0x0200;
constexpr std::uint16_t CommandReload = 0x0400;
constexpr std::uint16_t CommandError = 0x2000;
constexpr std::uint16_t WriteEnableError = 0x4000;
constexpr std::uint16_t Busy = 0x8000;
constexpr std::uint8_t OfferedToPdi = 0x01;
constexpr std::uint8_t ForceRelease = 0x02;

// An I2C EEPROM at 400 kHz: a few bytes take about 200 µs, programming a word some milliseconds.
constexpr core::Duration ReadTime = std::chrono::microseconds{200};
constexpr core::Duration WriteTime = std::chrono::milliseconds{5};
constexpr std::size_t LargeFrom = 4096;  // bytes; 32 Kbit and more have two address bytes

}  // namespace

EepromInterface::EepromInterface(std::span<std::uint8_t> registers, std::vector<std::uint8_t> image,
                                 bool eightByteReads)
    : registers_{registers},
      image_{std::move(image)},
      fixedBits_{static_cast<std::uint16_t>((eightByteReads ? EightBytes : 0) |
                                            (image_.size() >= LargeFrom ? LargeDevice : 0))} {
    store16(registers_, reg::EepromControl, fixedBits_);
}

bool EepromInterface::busy() const noexcept {
    return (load16(registers_, reg::EepromControl) & Busy) != 0;
}

bool EepromInterface::ownedByMaster() const noexcept {
    return (registers_[reg::EepromConfiguration] & OfferedToPdi) == 0 &&
           (registers_[reg::EepromPdiAccess] & 0x01) == 0;
}

void EepromInterface::settle(core::TrueTime now) noexcept {
    if (busy() && now >= doneAt_) finish();
}

void EepromInterface::write(std::uint16_t address, std::span<const std::uint8_t> data,
                            core::TrueTime now) noexcept {
    settle(now);
    bool command = false;
    for (std::size_t i = 0; i < data.size(); ++i) {
        const std::size_t at = address + i;
        if (at >= reg::EepromData + std::size_t{8}) break;
        if (at == reg::EepromConfiguration) {
            registers_[at] = static_cast<std::uint8_t>(data[i] & (OfferedToPdi | ForceRelease));
            if ((data[i] & ForceRelease) != 0) registers_[reg::EepromPdiAccess] = 0;
            continue;
        }
        if (at < reg::EepromControl || busy() || !ownedByMaster()) continue;
        if (at <= reg::EepromControl + 1U) {
            command = true;
            continue;
        }
        registers_[at] = data[i];
    }
    if (!command) return;
    // Bytes of the control word that were not written count as zero.
    std::uint16_t control = 0;
    for (std::size_t i = 0; i < data.size(); ++i) {
        if (address + i == reg::EepromControl)
            control = static_cast<std::uint16_t>(control | data[i]);
        if (address + i == reg::EepromControl + 1U) {
            control = static_cast<std::uint16_t>(control | (data[i] << 8));
        }
    }
    start(control, now);
}

void EepromInterface::start(std::uint16_t control, core::TrueTime now) noexcept {
    command_ = control & CommandMask;
    if (command_ == 0) {  // clears the error bits
        store16(registers_, reg::EepromControl, fixedBits_);
        return;
    }
    if (command_ == CommandWrite && (control & WriteEnable) == 0) {
        store16(registers_, reg::EepromControl,
                static_cast<std::uint16_t>(fixedBits_ | WriteEnableError));
        return;
    }
    store16(registers_, reg::EepromControl,
            static_cast<std::uint16_t>(fixedBits_ | command_ | Busy));
    doneAt_ = now + (command_ == CommandWrite ? WriteTime : ReadTime);
}

void EepromInterface::finish() noexcept {
    std::uint16_t result = fixedBits_;
    const std::size_t first = std::size_t{load32(registers_, reg::EepromAddress)} * 2;
    if (command_ == CommandRead) {
        // Past the end an EEPROM of this size has nothing to drive the line with: all ones.
        for (std::size_t i = 0; i < 8; ++i) {
            registers_[reg::EepromData + i] =
                first + i < image_.size() ? image_[first + i] : std::uint8_t{0xFF};
        }
        if ((fixedBits_ & EightBytes) == 0) {
            wire::store32(registers_, reg::EepromData + 4U, 0);
        }
    } else if (command_ == CommandWrite) {
        writeWord();
    } else if (command_ != CommandReload) {
        result |= CommandError;
    }
    store16(registers_, reg::EepromControl, result);
}

void EepromInterface::writeWord() noexcept {
    const std::size_t first = std::size_t{load32(registers_, reg::EepromAddress)} * 2;
    if (first + 2 > image_.size()) return;
    image_[first] = registers_[reg::EepromData];
    image_[first + 1] = registers_[reg::EepromData + 1U];
}

}  // namespace takt::twin
