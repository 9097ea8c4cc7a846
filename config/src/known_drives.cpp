#include <takt/config/known_drives.hpp>

#include "drive_profile.hpp"

namespace takt::config {

std::optional<std::int64_t> deliveredCountsPerTurn(std::string_view deviceType) noexcept {
    const DriveProfile& profile = profileOfType(deviceType);
    if (profile.countsPerTurn == 0) return std::nullopt;
    return profile.countsPerTurn;
}

}  // namespace takt::config
