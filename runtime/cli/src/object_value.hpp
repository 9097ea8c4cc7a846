#pragma once

#include <string>
#include <string_view>
#include <takt/core/object_access.hpp>
#include <takt/wire/device_description.hpp>

/// Values of objects as people write them.
namespace takt::cli {

/// "0x6064", "0x1018:1", "6064h" is not taken. Index and sub-index decimal or hexadecimal with 0x.
/// \throw std::runtime_error one line: what is allowed
[[nodiscard]] core::ObjectAddress parseAddress(std::string_view text);

/// "uint16", "int32", "float", "string" …
/// \throw std::runtime_error one line: the types there are
[[nodiscard]] wire::DataType parseType(std::string_view text);
[[nodiscard]] const char* typeName(wire::DataType type) noexcept;
/// The unsigned type of that many bytes; octets where there is none.
[[nodiscard]] wire::DataType typeOfSize(std::size_t bytes) noexcept;

/// Little-endian bytes of a value that is written as text: numbers decimal or hexadecimal with 0x.
/// \throw std::runtime_error one line: not a number, or out of the range of the type
[[nodiscard]] core::ObjectValue parseValue(std::string_view text, wire::DataType type);
/// The value for people: numbers in decimal.
[[nodiscard]] std::string showValue(const core::ObjectValue& value, wire::DataType type);
/// "0x00C300E0": all bytes as one number.
[[nodiscard]] std::string showHex(const core::ObjectValue& value);

}  // namespace takt::cli
