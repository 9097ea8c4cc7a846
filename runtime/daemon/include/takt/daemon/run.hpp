#pragma once

#include <takt/daemon/run_options.hpp>
#include <vector>

namespace takt::daemon {

/// Loads a machine, puts it together, runs it on its twin and takes it down again. Prints
/// diagnostics, progress and a summary. `linked` are programs that are part of the executable; they
/// replace those of the same name in the machine file. \return the exit code; 128 + n when signal n
/// ended the run
[[nodiscard]] int run(const RunOptions& options, std::vector<LinkedProgram> linked = {});

/// Loads a machine, loads its programs, and says what the network needs: timing, layout, warnings.
/// Moves nothing and opens nothing. \return 0 good, 1 errors, 2 could not run
[[nodiscard]] int check(const RunOptions& options);

}  // namespace takt::daemon
