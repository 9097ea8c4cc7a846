#pragma once

#include <cstdint>
#include <takt/core/time.hpp>

namespace takt::axis {

/// Whole cycles that cover `time`; 0 for no time.
[[nodiscard]] constexpr std::uint32_t cyclesFor(core::Duration time,
                                                core::Duration cycle) noexcept {
    if (time.count() <= 0 || cycle.count() <= 0) return 0;
    return static_cast<std::uint32_t>((time.count() + cycle.count() - 1) / cycle.count());
}

}  // namespace takt::axis
