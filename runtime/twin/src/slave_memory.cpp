// The memory of a slave controller: what a frame reads, and what its writes mean once it has
// passed.

#include <algorithm>

#include "slave_controller.hpp"

namespace takt::twin {

namespace reg = wire::reg;

namespace {

constexpr std::uint16_t EepromFirst = reg::EepromConfiguration;
constexpr std::uint16_t EepromSize = 0x10;
constexpr std::uint16_t DcFirst = 0x0900;
constexpr std::uint16_t DcSize = 0x0100;
constexpr std::uint16_t FmmuSpace = 0x0100;
constexpr std::uint16_t EventDlStatus = 0x0004;
constexpr std::uint16_t EventAlStatus = 0x0008;
constexpr std::uint8_t SyncUnitOfPdi = 0x01;

/// What a write of the master does to a register byte.
enum class WriteRule : std::uint8_t {
    ReadOnly,
    Plain,
    PortErrors,        ///< any value clears 0x0300 to 0x030B
    UnitError,         ///< clears itself
    LostLinks,         ///< any value clears 0x0310 to 0x0313
    WatchdogCounters,  ///< any value clears both
    SyncManager,
    Dc,
    DcCyclic,  ///< only while the SYNC unit belongs to the master (0x0980 bit 0 clear)
};

struct RuleRange {
    std::uint16_t first;
    std::uint16_t size;
    WriteRule rule;
};

constexpr std::array RuleRanges{
    RuleRange{reg::StationAddress, 2, WriteRule::Plain},
    RuleRange{reg::DlControl, 4, WriteRule::Plain},
    RuleRange{reg::PhysicalOffset, 2, WriteRule::Plain},
    RuleRange{reg::EcatEventMask, 2, WriteRule::Plain},
    RuleRange{reg::RxErrorCounter, 12, WriteRule::PortErrors},
    RuleRange{reg::ProcessingUnitError, 2, WriteRule::UnitError},
    RuleRange{reg::LostLinkCounter, 4, WriteRule::LostLinks},
    RuleRange{reg::WatchdogDivider, 2, WriteRule::Plain},
    RuleRange{reg::WatchdogTimePdi, 2, WriteRule::Plain},
    RuleRange{reg::WatchdogTimeProcessData, 2, WriteRule::Plain},
    RuleRange{reg::WatchdogCounter, 2, WriteRule::WatchdogCounters},
    RuleRange{reg::Fmmu, FmmuSpace, WriteRule::Plain},
    RuleRange{reg::SyncManager, 0x80, WriteRule::SyncManager},
    RuleRange{reg::DcSystemTimeOffset, 12, WriteRule::Dc},
    RuleRange{reg::DcSpeedCounterStart, 2, WriteRule::Dc},
    RuleRange{reg::DcFilterDepth, 2, WriteRule::Dc},
    RuleRange{reg::DcCyclicControl, 1, WriteRule::Dc},
    RuleRange{reg::DcActivation, 1, WriteRule::DcCyclic},
    RuleRange{reg::DcStartTime, 8, WriteRule::DcCyclic},
    RuleRange{reg::DcSync0Cycle, 8, WriteRule::DcCyclic},
    RuleRange{0x0F80, 0x80, WriteRule::Plain},
};

constexpr auto WriteRules = [] {
    std::array<WriteRule, 0x1000> rules{};
    for (const RuleRange& range : RuleRanges) {
        for (std::size_t i = 0; i < range.size; ++i) rules[range.first + i] = range.rule;
    }
    return rules;
}();

bool covers(std::uint16_t address, std::size_t length, std::uint16_t start,
            std::uint16_t size) noexcept {
    return address < start + size && start < address + length;
}

}  // namespace

bool SlaveController::exists(std::size_t address, std::size_t length) const noexcept {
    return address + length <= RegisterSpace + ram_.size();
}

bool SlaveController::readMemory(std::uint16_t address, std::span<std::uint8_t> data, bool combine,
                                 core::TrueTime now) noexcept {
    if (!exists(address, data.size()) || data.empty()) return false;
    const std::size_t inRegisters =
        address < RegisterSpace ? std::min(data.size(), RegisterSpace - address) : 0;
    bool any = false;
    if (inRegisters > 0) {
        readRegisters(address, data.first(inRegisters), combine, now);
        any = true;
    }
    if (inRegisters < data.size()) {
        any |= syncManagers_.read(static_cast<std::uint16_t>(address + inRegisters),
                                  data.subspan(inRegisters), combine);
    }
    return any;
}

void SlaveController::readRegisters(std::uint16_t address, std::span<std::uint8_t> data,
                                    bool combine, core::TrueTime now) noexcept {
    if (dc_ && covers(address, data.size(), reg::DcSystemTime, 8)) dc_->refreshSystemTime(now);
    if (covers(address, data.size(), EepromFirst, EepromSize)) eeprom_.settle(now);
    transfer(data, std::span{registers_}.subspan(address, data.size()), combine);
    if (covers(address, data.size(), reg::AlStatus, 2)) {
        registers_[reg::EcatEventRequest] &= static_cast<std::uint8_t>(~EventAlStatus);
    }
    if (covers(address, data.size(), reg::DlStatus, 2)) {
        registers_[reg::EcatEventRequest] &= static_cast<std::uint8_t>(~EventDlStatus);
    }
}

bool SlaveController::writeMemory(std::uint16_t address, std::span<const std::uint8_t> data,
                                  core::TrueTime now) noexcept {
    if (!exists(address, data.size()) || data.empty()) return false;
    const std::size_t inRegisters =
        address < RegisterSpace ? std::min(data.size(), RegisterSpace - address) : 0;
    bool any = false;
    if (inRegisters > 0) {
        const auto part = data.first(inRegisters);
        if (dc_ && address <= reg::DcSystemTime &&
            reg::DcSystemTime + std::size_t{4} <= address + inRegisters) {
            dc_->receiveSystemTime(
                now, wire::load32(part, static_cast<std::size_t>(reg::DcSystemTime - address)));
        }
        any = keepForCommit(address, part);
    }
    if (inRegisters < data.size()) {
        any |= syncManagers_.write(static_cast<std::uint16_t>(address + inRegisters),
                                   data.subspan(inRegisters));
    }
    return any;
}

bool SlaveController::keepForCommit(std::uint16_t address,
                                    std::span<const std::uint8_t> data) noexcept {
    // A write of nothing but the system time is complete already: it only feeds the control loop.
    if (address >= reg::DcSystemTime && address + data.size() <= reg::DcReceiveTimeUnit)
        return true;
    if (pendingCount_ == PendingWrites || pendingUsed_ + data.size() > PendingBytes) return false;
    std::copy(data.begin(), data.end(),
              pendingBytes_.begin() + static_cast<std::ptrdiff_t>(pendingUsed_));
    pending_[pendingCount_++] = {address, static_cast<std::uint16_t>(data.size()),
                                 static_cast<std::uint16_t>(pendingUsed_)};
    pendingUsed_ += data.size();
    return true;
}

FrameEvents SlaveController::commit(core::TrueTime now) noexcept {
    FrameEvents events;
    for (std::size_t i = 0; i < pendingCount_; ++i) {
        const PendingWrite& write = pending_[i];
        applyWrite(write.address, {pendingBytes_.data() + write.at, write.length}, now, events);
    }
    pendingCount_ = 0;
    pendingUsed_ = 0;
    events.syncManagers = syncManagers_.commit();
    if (events.syncManagers.watchdog) watchdog_.trigger(now);
    if (dc_) dc_->commit(now);
    return events;
}

void SlaveController::applyWrite(std::uint16_t address, std::span<const std::uint8_t> data,
                                 core::TrueTime now, FrameEvents& events) noexcept {
    for (std::size_t i = 0; i < data.size(); ++i) {
        applyByte(static_cast<std::uint16_t>(address + i), data[i]);
    }
    const std::size_t length = data.size();
    if (covers(address, length, reg::AlControl, 2)) applyAlControl(address, data, events);
    if (covers(address, length, reg::Fmmu, FmmuSpace)) fmmus_ = decodeFmmus(registers_, fmmuCount_);
    if (covers(address, length, EepromFirst, EepromSize)) eeprom_.write(address, data, now);
    if (dc_ && covers(address, length, DcFirst, DcSize)) dc_->written(address, length, now);
}

void SlaveController::applyByte(std::uint16_t address, std::uint8_t value) noexcept {
    switch (WriteRules[address]) {
        case WriteRule::ReadOnly:
            break;
        case WriteRule::Plain:
            registers_[address] = value;
            break;
        case WriteRule::PortErrors:
            std::fill_n(&registers_[reg::RxErrorCounter], 12, std::uint8_t{0});
            break;
        case WriteRule::UnitError:
            registers_[address] = 0;
            break;
        case WriteRule::LostLinks:
            std::fill_n(&registers_[reg::LostLinkCounter], 4, std::uint8_t{0});
            break;
        case WriteRule::WatchdogCounters:
            std::fill_n(&registers_[reg::WatchdogCounter], 2, std::uint8_t{0});
            break;
        case WriteRule::SyncManager:
            syncManagers_.writeRegister(address, value);
            break;
        case WriteRule::Dc:
            if (dc_) registers_[address] = value;
            break;
        case WriteRule::DcCyclic:
            if (dc_ && (registers_[reg::DcCyclicControl] & SyncUnitOfPdi) == 0) {
                registers_[address] = value;
            }
            break;
    }
}

void SlaveController::applyAlControl(std::uint16_t address, std::span<const std::uint8_t> data,
                                     FrameEvents& events) noexcept {
    // AL control works like a mailbox: locked until the application has read it.
    if ((registers_[reg::AlEventRequest] & 0x01) != 0) return;
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t at = reg::AlControl + i;
        if (at >= address && at < address + data.size()) registers_[at] = data[at - address];
    }
    registers_[reg::AlEventRequest] |= 0x01;
    events.alControl = true;
}

}  // namespace takt::twin
