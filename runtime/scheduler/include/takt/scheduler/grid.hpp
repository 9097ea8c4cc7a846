#pragma once

#include <cstdint>
#include <takt/core/clock_source.hpp>
#include <takt/core/time.hpp>

namespace takt::scheduler {

/// One wake-up of the cyclic task.
struct Beat {
    core::CycleNumber number{0};
    core::HostTime planned{};
    core::HostTime woke{};
    std::uint32_t skipped{0};  ///< grid points that had passed unused before this one

    [[nodiscard]] core::Duration lateness() const noexcept { return woke - planned; }
};

/// The absolute grid of wake-ups. A missed point is skipped, never caught up with (realtime rule:
/// two cycles never run back to back), and the next wake-up is never computed from "now".
class Grid {
public:
    Grid(core::HostTime first, core::Duration cycle) noexcept : next_{first}, cycle_{cycle} {}

    /// rt. Sleeps until the next grid point that lies ahead.
    Beat wait(core::ClockSource& clock) noexcept;
    /// rt. Moves all further points by `shift`; the DC lock's correction.
    void shift(core::Duration by) noexcept { next_ += by; }

private:
    core::HostTime next_;
    core::Duration cycle_;
    core::CycleNumber number_{0};
};

}  // namespace takt::scheduler
