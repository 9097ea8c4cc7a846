#pragma once

#include <takt/core/clock_source.hpp>

namespace takt::core {

/// The machine's own clock, CLOCK_MONOTONIC: never steps, whatever happens to the wall time.
class MonotonicClock : public ClockSource {
public:
    [[nodiscard]] HostTime now() const noexcept override;
    /// One absolute sleep; a signal does not cut it short.
    void sleepUntil(HostTime wake) noexcept override;
};

}  // namespace takt::core
