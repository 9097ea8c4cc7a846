#pragma once

#include <filesystem>
#include <string>

namespace takt::daemon {

/// What `takt sim` was asked to do.
struct SimOptions {
    std::filesystem::path machine;
    std::string interface;
    bool quiet{false};
};

/// Serves the simulated machine on a network interface, for a master in another process or on
/// another computer, until a signal comes. The programs of the machine need not be built. Prints
/// each change of a device and, at the end, how each one stands. \return 0; 1 machine file refused;
/// 2 could not run, with one line that says why
[[nodiscard]] int sim(const SimOptions& options);

}  // namespace takt::daemon
