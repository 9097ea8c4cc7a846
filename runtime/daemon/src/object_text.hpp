#pragma once

#include <string>
#include <string_view>
#include <takt/core/object_access.hpp>

/// Objects and their bytes as they stand in requests and command files.
namespace takt::daemon {

/// "0x6065:0". \return false, and nothing changes, when it is no such thing
[[nodiscard]] bool parseObject(std::string_view text, core::ObjectAddress& address);

/// Two hexadecimal digits for each byte, in the order on the wire: "E8030000" is 1000 in four.
[[nodiscard]] std::string formatBytes(const core::ObjectValue& value);
/// \return false, and nothing changes, unless these are one to eight bytes
[[nodiscard]] bool parseBytes(std::string_view text, core::ObjectValue& value);

}  // namespace takt::daemon
