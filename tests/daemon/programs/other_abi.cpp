/// Says that it was built for another ABI; its create function must never be called.
#include <cstdlib>
#include <takt/program/entry.hpp>

extern "C" __attribute__((visibility("default"))) const takt::program::ProgramEntry*
taktProgramEntry() {
    static const takt::program::ProgramEntry entry{
        takt::program::AbiNumber + 1,
        takt::program::Version,
        takt::program::CompilerTag,
        takt::program::SanitizerTag,
        []() -> takt::program::Program* { std::abort(); },
        [](takt::program::Program*) {}};
    return &entry;
}
