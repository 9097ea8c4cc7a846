#pragma once

#include <array>
#include <cstdint>
#include <takt/record/histogram.hpp>

namespace takt::daemon {

/// What took the time when a cycle was missed.
enum class CyclePart : std::uint8_t { Host, Bus, Programs, Motion };
inline constexpr std::size_t CycleParts = 4;

/// How the cycles of a run on a real clock kept their time. Plain data; written by the cycle.
struct CycleStatistics {
    record::Histogram lateness;    ///< ns from the planned wake-up to the real one
    record::Histogram reply;       ///< ns from the wake-up until the replies were there
    record::Histogram execution;   ///< ns from the wake-up to the end of the cycle
    record::Histogram phaseError;  ///< ns off the SYNC0 grid, either way, while locked
    std::array<std::uint64_t, CycleParts> missedBy{};  ///< late cycles by what made them so
};

}  // namespace takt::daemon
