#include "esi_values.hpp"

#include <fmt/format.h>

#include "numbers.hpp"

namespace takt::config {

std::optional<std::int64_t> EsiValues::number(std::string_view text, int line,
                                              std::string_view what, std::int64_t least,
                                              std::int64_t most) const {
    const auto value = parseInteger(trim(text));
    if (value && *value >= least && *value <= most) return value;
    constexpr std::size_t Shown = 40;
    error(line,
          fmt::format("{}: '{}' is {}", what, text.substr(0, Shown),
                      value ? "out of range" : "not a number"),
          fmt::format("{} to {}, decimal or #x…", least, most));
    return std::nullopt;
}

std::int64_t EsiValues::child(XmlElement element, std::string_view name, std::int64_t least,
                              std::int64_t most, std::int64_t fallback) const {
    const XmlElement found = element.child(name);
    if (!found.present()) return fallback;
    return number(found.text(), found.line(), fmt::format("<{}>/<{}>", element.name(), name), least,
                  most)
        .value_or(fallback);
}

std::int64_t EsiValues::attribute(XmlElement element, std::string_view name, std::int64_t least,
                                  std::int64_t most, std::int64_t fallback) const {
    const auto found = element.attribute(name);
    if (!found) return fallback;
    return number(found->value, found->line, fmt::format("<{}> {}", element.name(), name), least,
                  most)
        .value_or(fallback);
}

bool EsiValues::flag(XmlElement element, std::string_view name, bool fallback) const {
    const auto found = element.attribute(name);
    if (!found) return fallback;
    const std::string_view text = trim(found->value);
    if (const auto value = parseBool(text)) return *value;
    if (const auto value = parseInteger(text)) return *value != 0;
    error(found->line,
          fmt::format("<{}> {}: '{}' is neither true nor false", element.name(), name, text),
          "1, 0, true, false");
    return fallback;
}

core::Duration EsiValues::milliseconds(XmlElement element, std::string_view name,
                                       core::Duration fallback) const {
    constexpr std::int64_t Hour = 3'600'000;
    const auto count = std::chrono::duration_cast<std::chrono::milliseconds>(fallback).count();
    return std::chrono::milliseconds{child(element, name, 0, Hour, count)};
}

std::optional<std::vector<std::uint8_t>> hexBytes(std::string_view text) {
    const auto digit = [](char c) {
        if (c >= '0' && c <= '9') return c - '0';
        if (c >= 'a' && c <= 'f') return c - 'a' + 10;
        if (c >= 'A' && c <= 'F') return c - 'A' + 10;
        return -1;
    };
    if (text.size() % 2 != 0) return std::nullopt;
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
        if (digit(text[i]) < 0 || digit(text[i + 1]) < 0) return std::nullopt;
        bytes.push_back(static_cast<std::uint8_t>(digit(text[i]) * 16 + digit(text[i + 1])));
    }
    return bytes;
}

std::string englishName(XmlElement element) {
    const auto names = element.children("Name");
    for (const XmlElement name : names) {
        const auto language = name.attribute("LcId");
        if (language && language->value == "1033") return name.text();
    }
    return names.empty() ? std::string{} : names.front().text();
}

}  // namespace takt::config
