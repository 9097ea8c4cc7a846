#pragma once

#include <cstdint>
#include <takt/program/program.hpp>
#include <takt/program/version.hpp>

namespace takt::program {

/// Changes whenever a program built against older headers could not run with a newer library.
inline constexpr std::uint32_t AbiNumber = 1;

/// What a program library says about itself before any of its code is trusted. Plain C layout, so
/// that it can be read whatever the other fields say.
struct ProgramEntry {
    std::uint32_t abi;
    const char* version;  ///< of takt
    const char* compiler;
    const char* sanitizer;
    Program* (*create)();
    void (*destroy)(Program*);
};

inline constexpr const char* EntrySymbol = "taktProgramEntry";

#if defined(__SANITIZE_ADDRESS__)
inline constexpr const char* SanitizerTag = "address";
#elif defined(__SANITIZE_THREAD__)
inline constexpr const char* SanitizerTag = "thread";
#else
inline constexpr const char* SanitizerTag = "none";
#endif

#if defined(__clang__)
inline constexpr const char* CompilerTag = "clang";
#else
inline constexpr const char* CompilerTag = "gcc";
#endif

}  // namespace takt::program

/// Ends the source of a program library: exports the one C symbol that takt looks for.
#define TAKT_PROGRAM(Class)                                                              \
    extern "C" __attribute__((visibility("default"))) const takt::program::ProgramEntry* \
    taktProgramEntry() {                                                                 \
        static const takt::program::ProgramEntry entry{                                  \
            takt::program::AbiNumber,                                                    \
            takt::program::Version,                                                      \
            takt::program::CompilerTag,                                                  \
            takt::program::SanitizerTag,                                                 \
            []() -> takt::program::Program* { return new (Class); },                     \
            [](takt::program::Program* program) { delete program; }};                    \
        return &entry;                                                                   \
    }
