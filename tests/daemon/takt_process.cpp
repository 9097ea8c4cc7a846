#include "takt_process.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace takt::test {

namespace {

[[noreturn]] void becomeCommand(const std::vector<std::string>& command, const std::string& workDir,
                                const std::vector<std::string>& extraEnvironment, int outputEnd) {
    dup2(outputEnd, STDOUT_FILENO);
    dup2(outputEnd, STDERR_FILENO);
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    if (chdir(workDir.c_str()) != 0) _exit(126);
    for (const std::string& entry : extraEnvironment) {
        const std::size_t equals = entry.find('=');
        setenv(entry.substr(0, equals).c_str(), entry.substr(equals + 1).c_str(), 1);
    }
    std::vector<char*> arguments;
    for (const std::string& argument : command)
        arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    _exit(127);
}

/// `takt` of this build, with the trap in front where there is one.
struct TaktCommand {
    TaktCommand(const std::vector<std::string>& arguments,
                const std::vector<std::string>& extraEnvironment)
        : command{std::string{TAKT_BINARY_DIR} + "/takt"}, environment{extraEnvironment} {
        command.insert(command.end(), arguments.begin(), arguments.end());
        const std::string trap = std::string{TAKT_BINARY_DIR} + "/libtakt_trap.so";
        if (std::filesystem::exists(trap)) environment.push_back("LD_PRELOAD=" + trap);
    }

    std::vector<std::string> command;
    std::vector<std::string> environment;
};

}  // namespace

ProcessResult runCommand(const std::vector<std::string>& command, const std::string& workDir,
                         const std::vector<std::string>& extraEnvironment) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw std::runtime_error("pipe");
    const pid_t child = fork();
    if (child == 0) becomeCommand(command, workDir, extraEnvironment, ends[1]);
    close(ends[1]);
    ProcessResult result;
    std::array<char, 4096> buffer{};
    for (ssize_t got = 0; (got = read(ends[0], buffer.data(), buffer.size())) > 0;) {
        result.output.append(buffer.data(), static_cast<std::size_t>(got));
    }
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return result;
}

ProcessResult runTakt(const std::vector<std::string>& arguments, const std::string& workDir,
                      const std::vector<std::string>& extraEnvironment) {
    const TaktCommand takt{arguments, extraEnvironment};
    return runCommand(takt.command, workDir, takt.environment);
}

int startTakt(const std::vector<std::string>& arguments, const std::string& workDir,
              const std::string& output, const std::vector<std::string>& extraEnvironment) {
    const TaktCommand takt{arguments, extraEnvironment};
    constexpr mode_t forOwner = 0600;
    const int file = open(output.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, forOwner);
    const pid_t child = fork();
    if (child == 0) becomeCommand(takt.command, workDir, takt.environment, file);
    close(file);
    return child;
}

std::string freshFolder(const std::string& name) {
    const auto path = std::filesystem::path{TAKT_BINARY_DIR} / "test_runs" / name;
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
    return path.string();
}

std::string readFile(const std::string& path) {
    std::ifstream file{path, std::ios::binary};
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

void writeFile(const std::string& path, const std::string& text) {
    std::ofstream file{path, std::ios::binary};
    file << text;
}

}  // namespace takt::test
