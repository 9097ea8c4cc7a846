#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace takt::config {

/// Position units for one motor turn of a drive family as its maker delivers it, by the type text
/// of the device description; empty: the family is not known.
[[nodiscard]] std::optional<std::int64_t> deliveredCountsPerTurn(
    std::string_view deviceType) noexcept;

}  // namespace takt::config
