#pragma once

#include <cstdint>
#include <takt/core/time.hpp>
#include <takt/fieldbus/listed_params.hpp>

#include "acyclic.hpp"

namespace takt::fieldbus::ethercat {

/// Sends one listed command until it has done what the list wants of it: the working counter within
/// its retries, the validation within its time. A lost frame is repeated whatever the list says.
/// Commands follow each other at the pace of a usual cycle: lists are written for masters that send
/// one in each, and a device that is still at work on the last one would pass over the next.
class CommandRunner {
public:
    enum class Result : std::uint8_t {
        Idle,
        Busy,
        Done,
        Lost,          ///< no reply, again and again
        WrongCounter,  ///< `seen` has the working counter
        Mismatch,      ///< `seen` has the first four bytes, masked
        StateRefused,  ///< the AL status that it waits for has its error bit set instead
    };

    /// rt. `command` must outlive its run.
    void start(const ListedCommand& command) noexcept;
    /// rt. \return false when there is nothing to send now; `result` tells whether it has ended
    bool next(core::HostTime now, Request& request) noexcept;
    /// rt.
    void take(core::HostTime now, const Reply& reply) noexcept;

    [[nodiscard]] Result result() const noexcept { return result_; }
    [[nodiscard]] std::uint32_t seen() const noexcept { return seen_; }

private:
    void takeData(core::HostTime now, std::span<const std::uint8_t> data) noexcept;

    const ListedCommand* command_{nullptr};
    Result result_{Result::Idle};
    bool timed_{false};
    core::HostTime deadline_{};
    core::HostTime notBefore_{};
    core::HostTime nextCommand_{};
    std::uint32_t wrong_{0};
    std::uint8_t lost_{0};
    std::uint32_t seen_{0};
};

/// Whether it writes to the devices (and not only reads).
[[nodiscard]] bool writes(const ListedCommand& command) noexcept;
/// Whether it reads and `address` is the register it starts at.
[[nodiscard]] bool readsAt(const ListedCommand& command, std::uint16_t address) noexcept;

}  // namespace takt::fieldbus::ethercat
