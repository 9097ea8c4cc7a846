#pragma once

#include <cstdint>
#include <string>

namespace takt::program {

struct ProgramParams {
    std::string name;
    std::string library;  ///< path of the shared library, resolved; empty = linked in
    std::uint32_t everyCycles{1};
    double budgetShare{0.5};  ///< of the cycle
    std::string origin;       ///< "machine.xml:70"
};

}  // namespace takt::program
