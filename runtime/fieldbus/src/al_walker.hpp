#pragma once

#include <cstdint>
#include <optional>
#include <takt/core/time.hpp>
#include <takt/wire/al_state.hpp>

#include "acyclic.hpp"

namespace takt::fieldbus::ethercat {

/// AL status and AL status code as read with one datagram (0x0130 to 0x0135).
struct AlReading {
    wire::AlState state{wire::AlState::None};
    bool error{false};
    std::uint16_t code{0};
};

inline constexpr std::uint16_t AlReadingBytes = 6;

/// rt. \pre data.size() == AlReadingBytes
[[nodiscard]] AlReading decodeAlStatus(std::span<const std::uint8_t> data) noexcept;

/// Leads one slave to a state (ETG.1000.6 6.4.1): looks, acknowledges an old error, asks, waits.
class AlWalker {
public:
    enum class Result : std::uint8_t { Idle, Busy, Reached, Refused, TimedOut, Silent };

    /// rt.
    void start(wire::AlState target, core::Duration timeout) noexcept;
    /// rt. \return false when there is nothing to send now; `result` tells whether it has ended
    bool next(core::HostTime now, std::uint16_t station, Request& request) noexcept;
    /// rt.
    void take(core::HostTime now, const Reply& reply) noexcept;

    [[nodiscard]] Result result() const noexcept { return result_; }
    [[nodiscard]] const AlReading& seen() const noexcept { return seen_; }
    [[nodiscard]] wire::AlState target() const noexcept { return target_; }

private:
    enum class Phase : std::uint8_t { Look, Acknowledge, AwaitAcknowledge, Ask, Await };

    void takeStatus(core::HostTime now) noexcept;

    wire::AlState target_{wire::AlState::None};
    core::Duration timeout_{0};
    std::optional<core::HostTime> deadline_;
    core::HostTime lookAt_{};
    Phase phase_{Phase::Look};
    Result result_{Result::Idle};
    AlReading seen_{};
    std::uint8_t silent_{0};
    std::array<std::uint8_t, 2> control_{};
};

}  // namespace takt::fieldbus::ethercat
