#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace takt::cli {

/// As a JSON string, quotes included.
[[nodiscard]] std::string jsonText(std::string_view text);
/// "[a,b]" of finished values.
[[nodiscard]] std::string jsonArray(const std::vector<std::string>& values);

/// One JSON object, members in the order in which they are added.
///
///     JsonObject{}.add("name", device.name).addRaw("pos", "3").text()
class JsonObject {
public:
    JsonObject& add(std::string_view name, std::string_view text) {
        return addRaw(name, jsonText(text));
    }
    JsonObject& add(std::string_view name, const char* text) {
        return add(name, std::string_view{text});
    }
    JsonObject& add(std::string_view name, bool value) {
        return addRaw(name, value ? "true" : "false");
    }
    /// \param value finished JSON: a number, an array, an object
    JsonObject& addRaw(std::string_view name, std::string_view value);
    [[nodiscard]] std::string text() const { return "{" + members_ + "}"; }

private:
    std::string members_;
};

}  // namespace takt::cli
