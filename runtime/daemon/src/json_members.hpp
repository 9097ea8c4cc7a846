#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

/// JSON of the control socket, for its encoders only.
namespace takt::daemon {

using Json = nlohmann::ordered_json;

/// Takes the members that are there and have the right type; notes the first that has not.
class Members {
public:
    Members(const Json& json, std::string& error) : json_{json}, error_{error} {}

    void take(const char* key, std::string& value) {
        if (const Json* found = find(key, &Json::is_string, "a text"))
            value = found->get<std::string>();
    }
    void take(const char* key, double& value) {
        if (const Json* found = find(key, &Json::is_number, "a number"))
            value = found->get<double>();
    }
    void take(const char* key, bool& value) {
        if (const Json* found = find(key, &Json::is_boolean, "true or false"))
            value = found->get<bool>();
    }
    void take(const char* key, std::uint64_t& value) {
        if (const Json* found = find(key, &Json::is_number_unsigned, "a whole number")) {
            value = found->get<std::uint64_t>();
        }
    }
    void take(const char* key, std::int64_t& value) {
        if (const Json* found = find(key, &Json::is_number_integer, "a whole number")) {
            value = found->get<std::int64_t>();
        }
    }
    [[nodiscard]] const Json* array(const char* key) {
        return find(key, &Json::is_array, "a list");
    }
    [[nodiscard]] const Json* object(const char* key) {
        return find(key, &Json::is_object, "an object");
    }
    [[nodiscard]] bool good() const { return error_.empty(); }

private:
    const Json* find(const char* key, bool (Json::*is)() const noexcept, const char* wanted) {
        const auto found = json_.find(key);
        if (found == json_.end()) return nullptr;
        if (((*found).*is)()) return &*found;
        if (error_.empty()) error_ = std::string{"\""} + key + "\" must be " + wanted;
        return nullptr;
    }

    const Json& json_;
    std::string& error_;
};

/// JSON knows no infinity; null says that there is no number.
[[nodiscard]] inline Json numberOf(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace takt::daemon
