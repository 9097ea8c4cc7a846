#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace takt::record {

/// A file that is written from front to back. A full or failing disk never throws after opening:
/// what no longer fits is dropped and counted, and `ok()` says so.
class OutputFile {
public:
    /// Creates or empties the file. \throw std::runtime_error naming the file and the system's
    /// reason
    explicit OutputFile(const std::filesystem::path& path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(std::string_view text) noexcept;
    void write(std::span<const std::uint8_t> bytes) noexcept;
    /// Hands everything to the system. \return ok()
    bool flush() noexcept;

    [[nodiscard]] bool ok() const noexcept { return dropped_ == 0 && !failed_; }
    [[nodiscard]] std::uint64_t droppedBytes() const noexcept { return dropped_; }
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

private:
    std::filesystem::path path_;
    std::FILE* file_;
    std::uint64_t dropped_{0};
    bool failed_{false};
};

}  // namespace takt::record
