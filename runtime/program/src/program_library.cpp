#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cstring>
#include <takt/program/entry.hpp>
#include <takt/program/program_library.hpp>

namespace takt::program {

namespace {

bool othersMayWrite(const std::filesystem::path& path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0 && (info.st_mode & (S_IWGRP | S_IWOTH)) != 0;
}

/// Motion programs are code: whoever can change the file moves the machine.
std::string refusedFile(const std::filesystem::path& path) {
    if (!std::filesystem::is_regular_file(path)) {
        return fmt::format("program library '{}' does not exist; build it, or correct the name",
                           path.string());
    }
    for (const auto& place : {path, std::filesystem::absolute(path).parent_path()}) {
        if (othersMayWrite(place)) {
            return fmt::format(
                "'{}' may be written by group or others; only its owner may be able to change "
                "a program: chmod go-w '{}'",
                place.string(), place.string());
        }
    }
    return {};
}

std::string mismatch(const char* what, const std::string& has, const std::string& needs) {
    return fmt::format("it was built for {} {}, this takt needs {}; rebuild the program", what, has,
                       needs);
}

std::string refusedEntry(const ProgramEntry& entry) {
    if (entry.abi != AbiNumber) {
        return mismatch("program ABI", std::to_string(entry.abi), std::to_string(AbiNumber));
    }
    if (std::strcmp(entry.version, Version) != 0) return mismatch("takt", entry.version, Version);
    if (std::strcmp(entry.compiler, CompilerTag) != 0) {
        return mismatch("compiler", entry.compiler, CompilerTag);
    }
    if (std::strcmp(entry.sanitizer, SanitizerTag) != 0) {
        return mismatch("sanitizer", entry.sanitizer, SanitizerTag);
    }
    return {};
}

}  // namespace

LoadedProgram loadProgram(const std::filesystem::path& library) {
    if (std::string error = refusedFile(library); !error.empty())
        return {nullptr, std::move(error)};
    const std::shared_ptr<void> handle{
        ::dlopen(std::filesystem::absolute(library).c_str(), RTLD_NOW | RTLD_LOCAL),
        [](void* opened) {
            if (opened != nullptr) ::dlclose(opened);
        }};
    if (!handle) {
        return {nullptr, fmt::format("program library '{}' cannot be loaded: {}", library.string(),
                                     ::dlerror())};
    }
    using EntryFunction = const ProgramEntry* (*)();
    const auto entryFunction = reinterpret_cast<EntryFunction>(::dlsym(handle.get(), EntrySymbol));
    if (entryFunction == nullptr) {
        return {nullptr,
                fmt::format("program library '{}' has no entry point '{}'; end its source with "
                            "TAKT_PROGRAM(YourClass)",
                            library.string(), EntrySymbol)};
    }
    const ProgramEntry* entry = entryFunction();
    if (std::string error = refusedEntry(*entry); !error.empty()) {
        return {nullptr,
                fmt::format("program library '{}' is refused: {}", library.string(), error)};
    }
    return {ProgramPtr{entry->create(), ProgramDeleter{handle, entry->destroy}}, {}};
}

}  // namespace takt::program
