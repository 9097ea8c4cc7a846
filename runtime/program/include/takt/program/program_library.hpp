#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <takt/program/program.hpp>

namespace takt::program {

/// Ends a program where it was made, and holds the library with its code until then.
struct ProgramDeleter {
    std::shared_ptr<void> library;  ///< null: linked in
    void (*destroy)(Program*){nullptr};

    void operator()(Program* program) const { destroy(program); }
};

/// A program and what keeps its code in memory.
using ProgramPtr = std::unique_ptr<Program, ProgramDeleter>;

/// A program, or the reason why there is none, in words that say what to do.
struct LoadedProgram {
    ProgramPtr program;
    std::string error;
};

/// Loads a program from a shared library. Refuses, without running any of its code beyond the entry
/// function: a file that is missing or that others may write, one without entry point, and one
/// built for another ABI, version, compiler or sanitizer.
[[nodiscard]] LoadedProgram loadProgram(const std::filesystem::path& library);

}  // namespace takt::program
