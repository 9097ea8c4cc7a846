#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "remote.hpp"
#include "status_table.hpp"

namespace takt::cli {

namespace {
constexpr int RefreshMs = 100;
}

int runWatch(const WatchOptions& options) {
    const bool terminal = ::isatty(STDOUT_FILENO) == 1 && !options.once && !options.remote.json;
    try {
        Remote remote{options.remote, "takt watch"};
        for (;;) {
            const daemon::StatusReport status = remote.status();
            if (options.remote.json) {
                fmt::print("{}\n", remote.lastLine());
            } else {
                // On a terminal the table stays where it is.
                fmt::print("{}{}{}", terminal ? "\033[H\033[2J" : "", statusTable(status),
                           terminal || options.once ? "" : "\n");
            }
            std::fflush(stdout);
            if (options.once) return 0;
            ::poll(nullptr, 0, RefreshMs);
        }
    } catch (const std::exception& error) {
        // The machine went away, or whoever read our output did.
        return noMachine(error.what());
    }
}

}  // namespace takt::cli
