#pragma once

#include <string_view>

namespace takt::config {

/// The text of config/schema/machine.xsd, carried inside the library so that no installed file is
/// needed.
[[nodiscard]] std::string_view machineSchema() noexcept;

}  // namespace takt::config
