#include "console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace takt::daemon {

namespace {

/// A closed terminal or a full disk behind the output must not throw into a running machine.
void put(std::FILE* file, std::string_view text) {
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), file));
}

}  // namespace

Console::Console(bool quiet) : quiet_{quiet}, terminal_{::isatty(STDOUT_FILENO) == 1} {}

void Console::line(std::string_view text) {
    if (quiet_) return;
    clearProgress();
    put(stdout, fmt::format("{}\n", text));
    std::fflush(stdout);
}

void Console::error(std::string_view text) {
    clearProgress();
    std::fflush(stdout);
    put(stderr, fmt::format("{}\n", text));
}

void Console::progress(std::string_view text) {
    if (quiet_ || !terminal_) return;
    put(stdout, fmt::format("\r\033[K{}", text));
    std::fflush(stdout);
    progressShown_ = true;
}

void Console::clearProgress() {
    if (!progressShown_) return;
    put(stdout, "\r\033[K");
    progressShown_ = false;
}

}  // namespace takt::daemon
