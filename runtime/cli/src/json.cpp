#include "json.hpp"

#include <fmt/format.h>

namespace takt::cli {

std::string jsonText(std::string_view text) {
    std::string result{"\""};
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (code < 0x20) {
            result += fmt::format("\\u{:04x}", code);
        } else {
            result += c;
        }
    }
    return result + "\"";
}

std::string jsonArray(const std::vector<std::string>& values) {
    std::string result{"["};
    for (const std::string& value : values) result += (result.size() > 1 ? "," : "") + value;
    return result + "]";
}

JsonObject& JsonObject::addRaw(std::string_view name, std::string_view value) {
    if (!members_.empty()) members_ += ',';
    members_ += jsonText(name);
    members_ += ':';
    members_ += value;
    return *this;
}

}  // namespace takt::cli
