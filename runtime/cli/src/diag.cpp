#include <fmt/format.h>

#include <stdexcept>

#include "remote.hpp"

namespace takt::cli {

int runDiag(const DiagOptions& options) {
    try {
        Remote remote{options.remote, "takt diag"};
        const daemon::NetworkReport network = remote.network();
        if (options.remote.json) {
            fmt::print("{}\n", remote.lastLine());
            return 0;
        }
        fmt::print("{}  network {}  cycle {}  clock {}\n", network.machine, network.state,
                   network.cycle, network.clockLocked ? "locked" : "NOT LOCKED");
        if (!network.problem.empty()) fmt::print("last problem: {}\n", network.problem);
        fmt::print("{}\n", daemon::frameSummary(network));
        for (const std::string& line : daemon::timeTable(network)) fmt::print("{}\n", line);
        fmt::print("\n");
        for (const std::string& line : daemon::deviceTable(network)) fmt::print("{}\n", line);
        return 0;
    } catch (const std::exception& error) {
        return noMachine(error.what());
    }
}

}  // namespace takt::cli
