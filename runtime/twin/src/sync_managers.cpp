#include "sync_managers.hpp"

#include <algorithm>
#include <cassert>

namespace takt::twin {

namespace reg = wire::reg;

namespace {

// Offsets inside a channel (ETG.1000.4 table 58).
constexpr std::size_t LengthAt = 2;
constexpr std::size_t ControlAt = 4;
constexpr std::size_t StatusAt = 5;
constexpr std::size_t ActivateAt = 6;
constexpr std::size_t PdiControlAt = 7;

constexpr std::uint8_t ModeMask = 0x03;
constexpr std::uint8_t MailboxMode = 0x02;
constexpr std::uint8_t DirectionMask = 0x0C;
constexpr std::uint8_t MasterWrites = 0x04;
constexpr std::uint8_t WatchdogTrigger = 0x40;
constexpr std::uint8_t Enable = 0x01;
constexpr std::uint8_t RepeatBit = 0x02;
constexpr std::uint8_t StatusWritten = 0x01;
constexpr std::uint8_t StatusRead = 0x02;
constexpr std::uint8_t StatusFull = 0x08;
constexpr std::uint8_t NoBuffer = 3;
constexpr std::size_t BufferCount = 3;

}  // namespace

SyncManagers::SyncManagers(std::span<std::uint8_t> registers, std::span<std::uint8_t> ram,
                           std::size_t count)
    : registers_{registers}, ram_{ram}, count_{std::min(count, MaxSyncManagers)} {
    for (std::size_t i = 0; i < count_; ++i) showStatus(i);
}

void SyncManagers::decode(std::size_t sm) noexcept {
    const std::size_t at = reg::SyncManager + sm * reg::SyncManagerSize;
    Channel& channel = channels_[sm];
    channel = Channel{};
    channel.start = wire::load16(registers_, at);
    channel.length = wire::load16(registers_, at + LengthAt);
    const std::uint8_t control = registers_[at + ControlAt];
    channel.mailbox = (control & ModeMask) == MailboxMode;
    channel.masterWrites = (control & DirectionMask) == MasterWrites;
    channel.watchdog = (control & WatchdogTrigger) != 0;
    // The guarded area (three times as long when buffered) must lie in the RAM; length 0 guards
    // nothing.
    const std::size_t room = channel.length * (channel.mailbox ? 1 : BufferCount);
    const bool fits =
        channel.start >= reg::ProcessRam && channel.start - reg::ProcessRam + room <= ram_.size();
    channel.enabled = (registers_[at + ActivateAt] & Enable) != 0 && channel.length > 0 && fits;
    touched_ = static_cast<std::uint16_t>(touched_ & ~(1U << sm));
    showStatus(sm);
}

void SyncManagers::showStatus(std::size_t sm) noexcept {
    const Channel& channel = channels_[sm];
    std::uint8_t status = channel.interrupts;
    if (channel.mailbox) {
        if (channel.full) status |= StatusFull;
    } else {
        status = static_cast<std::uint8_t>(status | (channel.newest << 4));
    }
    registers_[reg::SyncManager + sm * reg::SyncManagerSize + StatusAt] = status;
}

void SyncManagers::writeRegister(std::uint16_t address, std::uint8_t value) noexcept {
    const std::size_t sm =
        static_cast<std::size_t>(address - reg::SyncManager) / reg::SyncManagerSize;
    const std::size_t field =
        static_cast<std::size_t>(address - reg::SyncManager) % reg::SyncManagerSize;
    if (sm >= count_ || field == StatusAt || field == PdiControlAt) return;
    const std::size_t base = reg::SyncManager + sm * reg::SyncManagerSize;
    const std::uint8_t before = registers_[base + ActivateAt];
    if (field < ActivateAt) {
        // Start, length and control are writable only while the SyncManager is off.
        if ((before & Enable) == 0) registers_[base + field] = value;
        return;
    }
    registers_[base + ActivateAt] = value;
    if (((before ^ value) & Enable) != 0) decode(sm);
    if (channels_[sm].enabled && ((before ^ value) & RepeatBit) != 0) {
        channels_[sm].repeatRequested = true;
        touched_ = static_cast<std::uint16_t>(touched_ | (1U << sm));
    }
}

std::size_t SyncManagers::guardOf(std::size_t address) const noexcept {
    for (std::size_t i = 0; i < count_; ++i) {
        const Channel& channel = channels_[i];
        if (channel.enabled && address >= channel.start &&
            address < std::size_t{channel.start} + channel.length) {
            return i;
        }
    }
    return None;
}

std::size_t SyncManagers::stretchEnd(std::size_t sm, std::size_t address,
                                     std::size_t end) const noexcept {
    if (sm != None) {
        return std::min<std::size_t>(end, std::size_t{channels_[sm].start} + channels_[sm].length);
    }
    for (std::size_t i = 0; i < count_; ++i) {
        const Channel& channel = channels_[i];
        if (channel.enabled && channel.start > address && channel.start < end) end = channel.start;
    }
    return end;
}

std::span<std::uint8_t> SyncManagers::buffer(const Channel& channel,
                                             std::uint8_t number) const noexcept {
    const std::size_t offset = static_cast<std::size_t>(channel.start - reg::ProcessRam) +
                               std::size_t{number} * channel.length;
    return ram_.subspan(offset, channel.length);
}

bool SyncManagers::touch(Channel& channel, std::size_t offset, std::size_t length,
                         bool wantFull) noexcept {
    if (channel.mailbox) {
        if (channel.full != wantFull || channel.completed) return false;
        if (offset != 0 && !channel.open) return false;
    }
    const auto bit = static_cast<std::uint16_t>(1U << (&channel - channels_.data()));
    if (offset == 0) {
        channel.open = true;
        channel.firstTouched = true;
        touched_ |= bit;
    }
    if (offset + length == channel.length) {
        channel.open = false;
        channel.completed = true;
        touched_ |= bit;
    }
    return true;
}

bool SyncManagers::readGuarded(Channel& channel, std::size_t offset, std::span<std::uint8_t> data,
                               bool combine) noexcept {
    if (channel.masterWrites) return false;
    if (!channel.mailbox && channel.newest == NoBuffer) return false;
    if (!touch(channel, offset, data.size(), true)) return false;
    const std::uint8_t number = channel.mailbox ? std::uint8_t{0} : channel.newest;
    transfer(data, buffer(channel, number).subspan(offset, data.size()), combine);
    return true;
}

bool SyncManagers::writeGuarded(Channel& channel, std::size_t offset,
                                std::span<const std::uint8_t> data) noexcept {
    if (!channel.masterWrites || !touch(channel, offset, data.size(), false)) return false;
    const std::uint8_t number = channel.mailbox ? std::uint8_t{0} : channel.producing;
    std::copy(data.begin(), data.end(),
              buffer(channel, number).begin() + static_cast<std::ptrdiff_t>(offset));
    return true;
}

bool SyncManagers::read(std::uint16_t address, std::span<std::uint8_t> data,
                        bool combine) noexcept {
    bool any = false;
    std::size_t at = address;
    const std::size_t end = at + data.size();
    while (at < end) {
        const std::size_t sm = guardOf(at);
        const std::size_t until = stretchEnd(sm, at, end);
        const auto part = data.subspan(at - address, until - at);
        if (sm == None) {
            transfer(part, ram_.subspan(at - reg::ProcessRam, part.size()), combine);
            any = true;
        } else {
            any |= readGuarded(channels_[sm], at - channels_[sm].start, part, combine);
        }
        at = until;
    }
    return any;
}

bool SyncManagers::write(std::uint16_t address, std::span<const std::uint8_t> data) noexcept {
    bool any = false;
    std::size_t at = address;
    const std::size_t end = at + data.size();
    while (at < end) {
        const std::size_t sm = guardOf(at);
        const std::size_t until = stretchEnd(sm, at, end);
        const auto part = data.subspan(at - address, until - at);
        if (sm == None) {
            std::copy(part.begin(), part.end(),
                      ram_.begin() + static_cast<std::ptrdiff_t>(at - reg::ProcessRam));
            any = true;
        } else {
            any |= writeGuarded(channels_[sm], at - channels_[sm].start, part);
        }
        at = until;
    }
    return any;
}

void SyncManagers::complete(std::size_t sm, SyncManagerEvents& events) noexcept {
    Channel& channel = channels_[sm];
    const auto bit = static_cast<std::uint16_t>(1U << sm);
    if (channel.firstTouched) {
        const std::uint8_t cleared = channel.masterWrites ? StatusRead : StatusWritten;
        channel.interrupts = static_cast<std::uint8_t>(channel.interrupts & ~cleared);
    }
    if (channel.completed && channel.masterWrites) {
        channel.interrupts |= StatusWritten;
        channel.full = channel.mailbox;
        if (!channel.mailbox) {
            channel.newest = channel.producing;
            channel.producing = static_cast<std::uint8_t>((channel.producing + 1) % BufferCount);
        }
        events.written |= bit;
        events.watchdog |= channel.watchdog;
    } else if (channel.completed) {
        channel.interrupts |= StatusRead;
        if (channel.mailbox) channel.full = false;
        events.taken |= bit;
    }
    if (channel.repeatRequested) events.repeated |= bit;
    channel.firstTouched = false;
    channel.completed = false;
    channel.repeatRequested = false;
    showStatus(sm);
}

SyncManagerEvents SyncManagers::commit() noexcept {
    SyncManagerEvents events;
    for (std::size_t sm = 0; touched_ != 0 && sm < count_; ++sm) {
        const auto bit = static_cast<std::uint16_t>(1U << sm);
        if ((touched_ & bit) == 0) continue;
        touched_ = static_cast<std::uint16_t>(touched_ & ~bit);
        complete(sm, events);
    }
    return events;
}

std::span<const std::uint8_t> SyncManagers::newest(std::size_t sm) const noexcept {
    const Channel& channel = channels_[sm];
    if (!channel.enabled || channel.newest == NoBuffer) return {};
    return buffer(channel, channel.newest);
}

std::span<std::uint8_t> SyncManagers::nextBuffer(std::size_t sm) noexcept {
    const Channel& channel = channels_[sm];
    if (!channel.enabled) return {};
    return buffer(channel, channel.producing);
}

void SyncManagers::publish(std::size_t sm) noexcept {
    Channel& channel = channels_[sm];
    if (!channel.enabled) return;
    channel.newest = channel.producing;
    channel.producing = static_cast<std::uint8_t>((channel.producing + 1) % BufferCount);
    channel.interrupts = StatusWritten;
    showStatus(sm);
}

std::span<const std::uint8_t> SyncManagers::message(std::size_t sm) const noexcept {
    const Channel& channel = channels_[sm];
    if (!channel.enabled || !channel.full) return {};
    return buffer(channel, 0);
}

void SyncManagers::release(std::size_t sm) noexcept {
    channels_[sm].full = false;
    channels_[sm].interrupts = StatusRead;
    showStatus(sm);
}

void SyncManagers::post(std::size_t sm, std::span<const std::uint8_t> message) noexcept {
    Channel& channel = channels_[sm];
    assert(channel.enabled && !channel.full && message.size() <= channel.length);
    const auto box = buffer(channel, 0);
    const auto end = std::copy(message.begin(), message.end(), box.begin());
    std::fill(end, box.end(), std::uint8_t{0});
    channel.full = true;
    channel.interrupts = StatusWritten;
    showStatus(sm);
}

void SyncManagers::acknowledgeRepeat(std::size_t sm) noexcept {
    const std::size_t base = reg::SyncManager + sm * reg::SyncManagerSize;
    const auto toggle = static_cast<std::uint8_t>(registers_[base + ActivateAt] & RepeatBit);
    registers_[base + PdiControlAt] =
        static_cast<std::uint8_t>((registers_[base + PdiControlAt] & ~RepeatBit) | toggle);
}

}  // namespace takt::twin
