#include "console.hpp"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

namespace takt::daemon {

Console::Console(bool quiet) : quiet_{quiet}, terminal_{::isatty(STDOUT_FILENO) == 1} {}

void Console::line(std::string_view text) {
    if (quiet_) return;
    clearProgress();
    fmt::print("{}\n", text);
    std::fflush(stdout);
}

void Console::error(std::string_view text) {
    clearProgress();
    std::fflush(stdout);
    fmt::print(stderr, "{}\n", text);
}

void Console::progress(std::string_view text) {
    if (quiet_ || !terminal_) return;
    fmt::print("\r\033[K{}", text);
    std::fflush(stdout);
    progressShown_ = true;
}

void Console::clearProgress() {
    if (!progressShown_) return;
    fmt::print("\r\033[K");
    progressShown_ = false;
}

}  // namespace takt::daemon
