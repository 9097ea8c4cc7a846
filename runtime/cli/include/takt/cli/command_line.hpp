#pragma once

#include <takt/daemon/run_options.hpp>
#include <vector>

namespace takt::cli {

/// The `takt` command. An executable of the machine builder's own calls it with the programs it
/// brings:
///
///     int main(int argc, char** argv) {
///         std::vector<takt::daemon::LinkedProgram> programs;
///         programs.push_back(takt::cli::linked<Pick>("pick"));
///         return takt::cli::commandLine(argc, argv, std::move(programs));
///     }
/// \return the process' exit code
int commandLine(int argc, char** argv, std::vector<daemon::LinkedProgram> programs = {});

template <typename ProgramClass>
[[nodiscard]] daemon::LinkedProgram linked(std::string name) {
    return {std::move(name), [] {
                return program::ProgramPtr{
                    new ProgramClass,
                    program::ProgramDeleter{nullptr, [](program::Program* p) { delete p; }}};
            }};
}

}  // namespace takt::cli
