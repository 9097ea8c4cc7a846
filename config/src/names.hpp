#pragma once

#include <span>
#include <string>
#include <string_view>

namespace takt::config {

/// The known name that `wanted` was probably meant to be; empty when none is near.
[[nodiscard]] std::string nearestName(std::string_view wanted, std::span<const std::string> known);

/// "a, b, c"
[[nodiscard]] std::string joined(std::span<const std::string> names);

/// A name as program texts and traces can use it: a letter or '_', then letters, digits, '_', '-'
/// and '.'.
[[nodiscard]] bool isName(std::string_view text) noexcept;

}  // namespace takt::config
