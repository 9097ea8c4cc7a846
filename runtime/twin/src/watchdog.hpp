#pragma once

#include <cstdint>
#include <span>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

#include "event_queue.hpp"

namespace takt::twin {

/// The process-data watchdog of a slave controller (0x0400, 0x0420, 0x0440, 0x0442). Its event is
/// moved only when it comes due, so that the trigger in every cycle costs next to nothing.
class ProcessDataWatchdog {
public:
    ProcessDataWatchdog(std::span<std::uint8_t> registers, EventPort events)
        : registers_{registers}, events_{events} {
        wire::store16(registers_, wire::reg::WatchdogDivider, 2498);
        wire::store16(registers_, wire::reg::WatchdogTimePdi, 1000);
        wire::store16(registers_, wire::reg::WatchdogTimeProcessData, 1000);
        wire::store16(registers_, wire::reg::WatchdogStatus, 1);
    }

    /// rt. A buffer with watchdog trigger was written completely.
    void trigger(core::TrueTime now) noexcept {
        last_ = now;
        if (timeout() == core::Duration{0}) return;
        registers_[wire::reg::WatchdogStatus] = 1;
        if (!events_.pending(EventKind::Watchdog)) {
            events_.schedule(EventKind::Watchdog, now + timeout());
        }
    }
    /// rt. The event came due. \return true when the watchdog has expired
    bool fire(core::TrueTime now) noexcept {
        const core::Duration limit = timeout();
        if (limit == core::Duration{0}) {
            registers_[wire::reg::WatchdogStatus] = 1;  // switched off counts as well
            return false;
        }
        if (now < last_ + limit) {
            events_.schedule(EventKind::Watchdog, last_ + limit);
            return false;
        }
        registers_[wire::reg::WatchdogStatus] = 0;
        std::uint8_t& counter = registers_[wire::reg::WatchdogCounter];
        if (counter < 0xFF) ++counter;
        return true;
    }

private:
    [[nodiscard]] core::Duration timeout() const noexcept {
        const auto unit =
            core::Duration{(wire::load16(registers_, wire::reg::WatchdogDivider) + 2) * 40};
        return unit * wire::load16(registers_, wire::reg::WatchdogTimeProcessData);
    }

    std::span<std::uint8_t> registers_;
    EventPort events_;
    core::TrueTime last_{};
};

}  // namespace takt::twin
