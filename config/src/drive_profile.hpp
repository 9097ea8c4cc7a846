#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <takt/axis/axis_params.hpp>
#include <takt/core/time.hpp>

namespace takt::config {

/// What is known of a drive family from its manual and not from its device description file.
struct DriveProfile {
    std::string_view name;
    std::string_view typePrefix;  ///< of the ESI type text; empty = matches nothing
    axis::DriveVelocityUnit velocityUnit{axis::DriveVelocityUnit::CountsPerSecond};
    std::int64_t countsPerTurn{0};           ///< as delivered; 0 = not known
    std::uint32_t maxPdoBytes{0};            ///< of one PDO; 0 = not told
    std::span<const core::Duration> cycles;  ///< the only ones taken; empty = see step and longest
    core::Duration cycleStep{0};             ///< cycles are multiples of it; 0 = any
    core::Duration longestCycle{0};          ///< 0 = any
    std::string_view cycleText;              ///< the same for people
    std::span<const std::int8_t> homingMethods;
    std::string_view homingText;
    std::int16_t quickStopOption{0};     ///< wanted in 605Ah: ramp down, not coast
    std::string_view lostCommunication;  ///< how the drive stops when the bus falls silent
};

/// The profile of that name; nullptr = there is none.
[[nodiscard]] const DriveProfile* findProfile(std::string_view name) noexcept;
/// By the type text of a device description; "generic" where it is not known.
[[nodiscard]] const DriveProfile& profileOfType(std::string_view type) noexcept;

[[nodiscard]] bool takesCycle(const DriveProfile& profile, core::Duration cycle) noexcept;
[[nodiscard]] bool takesHomingMethod(const DriveProfile& profile, std::int64_t method) noexcept;

}  // namespace takt::config
