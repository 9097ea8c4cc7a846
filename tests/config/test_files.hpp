#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <takt/config/diagnostics.hpp>

namespace takt::config::test {

/// A folder of its own for each test, gone with it.
class ScratchFolder {
public:
    ScratchFolder() {
        const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
        std::string name = std::string{test->test_suite_name()} + "." + test->name();
        std::replace(name.begin(), name.end(), '/', '_');
        path_ = std::filesystem::path{testing::TempDir()} / ("takt_config_" + name);
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    std::filesystem::path write(std::string_view name, std::string_view bytes) const {
        const std::filesystem::path file = path_ / name;
        std::ofstream stream{file, std::ios::binary};
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return file;
    }

private:
    std::filesystem::path path_;
};

inline std::string readAll(const std::filesystem::path& file) {
    std::ifstream stream{file, std::ios::binary};
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

inline int lineOf(std::string_view text, std::size_t offset) {
    const std::string_view front = text.substr(0, offset);
    return 1 + static_cast<int>(std::count(front.begin(), front.end(), '\n'));
}

/// The first diagnostic of that severity, or an empty one.
inline Diagnostic firstOf(const Diagnostics& diagnostics, Severity severity) {
    for (const Diagnostic& item : diagnostics.items()) {
        if (item.severity == severity) return item;
    }
    return {};
}

}  // namespace takt::config::test
