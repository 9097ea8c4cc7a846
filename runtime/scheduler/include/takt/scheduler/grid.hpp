#pragma once

#include <cstdint>
#include <takt/core/clock_source.hpp>
#include <takt/core/time.hpp>

namespace takt::scheduler {

/// One wake-up of the cyclic task.
struct Beat {
    core::CycleNumber number{0};  ///< of the machine's cycle: those made up for count
    core::HostTime planned{};
    core::HostTime woke{};
    std::uint32_t skipped{0};    ///< grid points that had passed unused before this one
    std::uint32_t madeUpFor{0};  ///< of these, cycles in which the machine's time went on

    [[nodiscard]] core::Duration lateness() const noexcept { return woke - planned; }
};

/// The absolute grid of wake-ups. A missed point is skipped, never caught up with (realtime rule:
/// two cycles never run back to back), and the next wake-up is never computed from "now". Over a
/// short gap the machine's time goes on, so that its motion stays in step with the world; over a
/// long one it stands still: nobody may jump ahead by what he slept.
class Grid {
public:
    /// \param bridgeable the most missed points in a row that are made up for
    Grid(core::HostTime first, core::Duration cycle, std::uint32_t bridgeable = 0) noexcept
        : next_{first}, cycle_{cycle}, bridgeable_{bridgeable} {}

    /// rt. Sleeps until the next grid point that lies ahead.
    Beat wait(core::ClockSource& clock) noexcept;
    /// rt. Moves all further points by `shift`; the DC lock's correction.
    void shift(core::Duration by) noexcept { next_ += by; }

private:
    core::HostTime next_;
    core::Duration cycle_;
    std::uint32_t bridgeable_;
    core::CycleNumber number_{0};
};

}  // namespace takt::scheduler
