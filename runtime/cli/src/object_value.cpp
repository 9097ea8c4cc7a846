#include "object_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>
#include <takt/wire/byte_io.hpp>

namespace takt::cli {

namespace {

using wire::DataType;

enum class Kind : std::uint8_t { Signed, Unsigned, Real, Text };

struct Type {
    DataType type;
    const char* name;
    Kind kind;
    std::uint8_t bytes;  ///< 0: as many as there are
};

constexpr std::array Types{
    Type{DataType::Boolean, "bool", Kind::Unsigned, 1},
    Type{DataType::Integer8, "int8", Kind::Signed, 1},
    Type{DataType::Integer16, "int16", Kind::Signed, 2},
    Type{DataType::Integer32, "int32", Kind::Signed, 4},
    Type{DataType::Integer64, "int64", Kind::Signed, 8},
    Type{DataType::Unsigned8, "uint8", Kind::Unsigned, 1},
    Type{DataType::Unsigned16, "uint16", Kind::Unsigned, 2},
    Type{DataType::Unsigned32, "uint32", Kind::Unsigned, 4},
    Type{DataType::Unsigned64, "uint64", Kind::Unsigned, 8},
    Type{DataType::Real32, "float", Kind::Real, 4},
    Type{DataType::Real64, "double", Kind::Real, 8},
    Type{DataType::VisibleString, "string", Kind::Text, 0},
    Type{DataType::OctetString, "octets", Kind::Text, 0},
};

const Type& describe(DataType type) noexcept {
    const auto found = std::find_if(Types.begin(), Types.end(),
                                    [type](const Type& entry) { return entry.type == type; });
    return found != Types.end() ? *found : Types.back();
}

/// Decimal or 0x…, all of the text.
std::optional<std::uint64_t> parseNumber(std::string_view text) {
    int base = 10;
    if (text.starts_with("0x") || text.starts_with("0X")) {
        text.remove_prefix(2);
        base = 16;
    }
    std::uint64_t value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (error != std::errc{} || rest != text.data() + text.size() || text.empty())
        return std::nullopt;
    return value;
}

[[noreturn]] void refuse(std::string_view text, const Type& type) {
    throw std::runtime_error{fmt::format("'{}' is not a value of type {}", text, type.name)};
}

std::uint64_t wholeNumber(std::string_view text, const Type& type) {
    const bool negative = text.starts_with('-');
    const auto magnitude = parseNumber(negative ? text.substr(1) : text);
    if (!magnitude || (negative && type.kind == Kind::Unsigned)) refuse(text, type);
    const unsigned bits = 8U * type.bytes;
    const std::uint64_t most = std::numeric_limits<std::uint64_t>::max() >> (64 - bits);
    if (type.type == DataType::Boolean && *magnitude > 1) refuse(text, type);
    if (type.kind == Kind::Unsigned) {
        if (*magnitude > most) refuse(text, type);
        return *magnitude;
    }
    // Hexadecimal numbers are bit patterns: 0xFF is the int8 of value -1.
    const bool pattern = text.starts_with("0x") || text.starts_with("0X");
    const std::uint64_t limit = negative ? most / 2 + 1 : pattern ? most : most / 2;
    if (*magnitude > limit) refuse(text, type);
    return negative ? 0U - *magnitude : *magnitude;
}

std::uint64_t realNumber(std::string_view text, const Type& type) {
    double value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || rest != text.data() + text.size()) refuse(text, type);
    if (type.bytes == 8) return std::bit_cast<std::uint64_t>(value);
    return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

std::uint64_t rawOf(const core::ObjectValue& value) noexcept {
    return wire::load64(value.bytes, 0);
}

std::string showText(const core::ObjectValue& value, DataType type) {
    std::string text;
    for (std::size_t i = 0; i < value.size; ++i) {
        const char c = static_cast<char>(value.bytes[i]);
        if (type == DataType::VisibleString) {
            if (c == '\0') break;
            text += c >= ' ' && c <= '~' ? c : '?';
        } else {
            text += fmt::format("{}{:02X}", i == 0 ? "" : " ", value.bytes[i]);
        }
    }
    return text;
}

}  // namespace

core::ObjectAddress parseAddress(std::string_view text) {
    const std::size_t colon = text.find(':');
    const auto index = parseNumber(text.substr(0, colon));
    const auto subindex = colon == std::string_view::npos ? std::optional<std::uint64_t>{0}
                                                          : parseNumber(text.substr(colon + 1));
    if (!index || *index > 0xFFFF || !subindex || *subindex > 0xFF) {
        throw std::runtime_error{fmt::format(
            "'{}' is not an object; use INDEX or INDEX:SUB, for example 0x6064 or 0x1018:1", text)};
    }
    return {static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*subindex)};
}

DataType parseType(std::string_view text) {
    std::string names;
    for (const Type& type : Types) {
        if (text == type.name) return type.type;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", type.name);
    }
    throw std::runtime_error{fmt::format("'{}' is not a type; there are: {}", text, names)};
}

const char* typeName(DataType type) noexcept {
    return describe(type).name;
}

DataType typeOfSize(std::size_t bytes) noexcept {
    switch (bytes) {
        case 1:
            return DataType::Unsigned8;
        case 2:
            return DataType::Unsigned16;
        case 4:
            return DataType::Unsigned32;
        case 8:
            return DataType::Unsigned64;
        default:
            return DataType::OctetString;
    }
}

core::ObjectValue parseValue(std::string_view text, DataType dataType) {
    const Type& type = describe(dataType);
    core::ObjectValue value;
    if (type.kind == Kind::Text) {
        if (text.empty() || text.size() > value.bytes.size()) {
            throw std::runtime_error{fmt::format("'{}' has {} characters; 1 to {} can be written",
                                                 text, text.size(), value.bytes.size())};
        }
        std::copy(text.begin(), text.end(), value.bytes.begin());
        value.size = static_cast<std::uint8_t>(text.size());
        return value;
    }
    const std::uint64_t raw =
        type.kind == Kind::Real ? realNumber(text, type) : wholeNumber(text, type);
    wire::store64(value.bytes, 0, raw);
    std::fill(value.bytes.begin() + type.bytes, value.bytes.end(), std::uint8_t{0});
    value.size = type.bytes;
    return value;
}

std::string showValue(const core::ObjectValue& value, DataType dataType) {
    const Type& type = describe(dataType);
    const std::uint64_t raw = rawOf(value);
    switch (type.kind) {
        case Kind::Text:
            return showText(value, dataType);
        case Kind::Unsigned:
            return std::to_string(raw);
        case Kind::Signed: {
            const unsigned unused = 64U - 8U * std::clamp<unsigned>(value.size, 1, 8);
            return std::to_string(static_cast<std::int64_t>(raw << unused) >> unused);
        }
        case Kind::Real:
            break;
    }
    if (value.size == 8) return fmt::format("{}", std::bit_cast<double>(raw));
    return fmt::format("{}", std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
}

std::string showHex(const core::ObjectValue& value) {
    return fmt::format("0x{:0{}X}", rawOf(value), 2 * std::max<int>(value.size, 1));
}

}  // namespace takt::cli
