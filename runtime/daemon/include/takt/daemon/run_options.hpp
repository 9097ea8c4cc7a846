#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <takt/core/time.hpp>
#include <takt/program/program_library.hpp>
#include <vector>

namespace takt::daemon {

/// What a run ended with; the process' exit code.
enum class ExitCode : int {
    Good = 0,              ///< everything asked for happened
    Refused = 1,           ///< configuration refused, nothing was started
    CouldNotRun = 2,       ///< link, permission, capability or a file: named
    MachineFault = 3,      ///< an axis in ErrorStop or a program failed
    ProgramAbandoned = 4,  ///< a program did not come back
    StopTimeout = 5,       ///< something did not stop in time: named
};

/// A program that is part of the executable instead of a library.
struct LinkedProgram {
    std::string name;  ///< of a <Program> in the machine file, or a new one
    std::function<program::ProgramPtr()> make;  ///< called again when the program is reset
};

/// What `takt run` was asked to do.
struct RunOptions {
    std::filesystem::path machine;
    std::filesystem::path
        programLibrary;  ///< replaces the libraries of the machine file; empty = none
    std::vector<std::filesystem::path> searchDirs;  ///< for program libraries named without a place
    std::string interface;                          ///< of the real network; empty = simulated
    bool fast{false};    ///< virtual time as fast as it goes, else paced by the wall clock
    bool manual{false};  ///< without programs
    std::optional<core::Duration> length;  ///< stop after so much time in OP
    std::filesystem::path trace;           ///< CSV; empty = none
    std::filesystem::path plot;            ///< SVG
    std::filesystem::path topView;         ///< SVG of the first group's plane, with keep-outs
    std::filesystem::path capture;         ///< pcapng
    /// On the wall clock, for programs of a simulated run: a call that takes longer ends the
    /// process.
    core::Duration programWatchdog{std::chrono::seconds{10}};
    std::filesystem::path faults;    ///< what goes wrong on the simulated machine; empty = nothing
    std::filesystem::path socket;    ///< of the control socket; empty = the usual place
    std::filesystem::path commands;  ///< replays the commands of this file; empty = none
    std::filesystem::path recordCommands;  ///< writes the commands taken to this file; empty = none
    bool quiet{false};
};

}  // namespace takt::daemon
