#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <takt/record/histogram.hpp>
#include <vector>

namespace takt::daemon {

/// What took the time when a cycle was missed.
enum class CyclePart : std::uint8_t { Host, Bus, Programs, Motion };
inline constexpr std::size_t CycleParts = 4;

/// How the cycles of a run on a real clock kept their time. Plain data; written by the cycle.
struct CycleStatistics {
    record::Histogram lateness;   ///< ns from the planned wake-up to the real one
    record::Histogram reply;      ///< ns from the wake-up until the replies were there
    record::Histogram execution;  ///< ns from the wake-up to the end of the cycle
    std::array<std::uint64_t, CycleParts> missedBy{};  ///< late cycles by what made them so
};

/// For people: a summary of the three times and their distribution, line by line.
[[nodiscard]] std::vector<std::string> describe(const CycleStatistics& statistics);

}  // namespace takt::daemon
