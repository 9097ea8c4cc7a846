#pragma once

#include <string>
#include <vector>

namespace takt::test {

/// What became of a `takt` that was started as a user starts it.
struct ProcessResult {
    int exitCode{-1};
    std::string output;  ///< stdout and stderr together
};

/// Runs `takt` of this build with the given arguments, in the folder `workDir`. Where the build has
/// the trap library it is loaded in front, so that an allocation or a lock in the cycle ends the
/// run.
ProcessResult runTakt(const std::vector<std::string>& arguments, const std::string& workDir,
                      const std::vector<std::string>& extraEnvironment = {});

/// Starts it and leaves it running, with all it prints in the file `output`.
/// \return its process number
int startTakt(const std::vector<std::string>& arguments, const std::string& workDir,
              const std::string& output, const std::vector<std::string>& extraEnvironment = {});

/// Any command of this machine.
ProcessResult runCommand(const std::vector<std::string>& command, const std::string& workDir,
                         const std::vector<std::string>& extraEnvironment = {});

/// A fresh empty folder below the build tree.
std::string freshFolder(const std::string& name);

std::string readFile(const std::string& path);
void writeFile(const std::string& path, const std::string& text);

}  // namespace takt::test
