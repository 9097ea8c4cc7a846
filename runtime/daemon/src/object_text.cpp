#include "object_text.hpp"

#include <fmt/format.h>

#include <charconv>

namespace takt::daemon {

namespace {

template <typename T>
bool parseHex(std::string_view digits, T& value) {
    const char* const end = digits.data() + digits.size();
    const auto [rest, error] = std::from_chars(digits.data(), end, value, 16);
    return error == std::errc{} && rest == end && !digits.empty();
}

}  // namespace

bool parseObject(std::string_view text, core::ObjectAddress& address) {
    const std::size_t colon = text.find(':');
    if (!text.starts_with("0x") || colon == std::string_view::npos) return false;
    core::ObjectAddress read;
    const std::string_view subindex = text.substr(colon + 1);
    const char* const end = subindex.data() + subindex.size();
    const auto [rest, error] = std::from_chars(subindex.data(), end, read.subindex);
    if (error != std::errc{} || rest != end) return false;
    if (!parseHex(text.substr(2, colon - 2), read.index)) return false;
    address = read;
    return true;
}

std::string formatBytes(const core::ObjectValue& value) {
    std::string text;
    for (std::size_t i = 0; i < value.size; ++i) text += fmt::format("{:02X}", value.bytes[i]);
    return text;
}

bool parseBytes(std::string_view text, core::ObjectValue& value) {
    core::ObjectValue read;
    if (text.empty() || text.size() % 2 != 0 || text.size() / 2 > read.bytes.size()) return false;
    read.size = static_cast<std::uint8_t>(text.size() / 2);
    for (std::size_t i = 0; i < read.size; ++i) {
        if (!parseHex(text.substr(2 * i, 2), read.bytes[i])) return false;
    }
    value = read;
    return true;
}

}  // namespace takt::daemon
