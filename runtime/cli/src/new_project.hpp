#pragma once

#include <filesystem>
#include <string>
#include <takt/wire/device_description.hpp>
#include <vector>

namespace takt::cli {

/// What `takt new` was asked for.
struct NewProjectOptions {
    std::filesystem::path folder;
    std::vector<std::filesystem::path>
        esi;                           ///< device files; empty: one CD300E from the installed ones
    std::vector<std::string> devices;  ///< types wanted from them; empty: the only one of each file
    std::filesystem::path eni;         ///< network file that the devices are taken from
    std::string interface;             ///< take the devices that are on this network
    std::filesystem::path executableFolder;  ///< installed files are found from there
    bool json{false};
};

/// `takt new`: writes a project that is ready to build and run on the simulated machine: machine
/// file, program, build, test and CI file. Nothing is written unless everything can be. \return the
/// exit code; 2 when it cannot, with one line that says why
int newProject(const NewProjectOptions& options);

}  // namespace takt::cli
