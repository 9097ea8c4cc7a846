#include "namespaces.hpp"

#include <filesystem>
#include <sstream>

namespace takt::test {

namespace {
const std::string Here = std::string{TAKT_SOURCE_DIR} + "/tests/rt";
const std::string Build = TAKT_BINARY_DIR;
}  // namespace

std::string namespacesForbidden() {
    const ProcessResult tried = runCommand({"unshare", "-Urn", "ip", "link", "show"}, Build);
    if (tried.exitCode == 0) return {};
    return "this test needs user and network namespaces, and `unshare -Urn` fails: " +
           tried.output +
           "\ndo: sysctl kernel.unprivileged_userns_clone=1, or on Ubuntu\n"
           "    sysctl kernel.apparmor_restrict_unprivileged_userns=0, or run a container with\n"
           "    --security-opt seccomp=unconfined; install iproute2 and util-linux";
}

ProcessResult inNamespaces(const std::string& scenario, const std::string& work,
                           const std::vector<std::string>& more) {
    // `timeout` ends everything that was started, should an event never come.
    std::vector<std::string> command{"timeout",
                                     "-s",
                                     "KILL",
                                     "200",
                                     "unshare",
                                     "-Urn",
                                     "bash",
                                     Here + "/segment.sh",
                                     scenario,
                                     work,
                                     Build + "/takt",
                                     Here + "/machine.xml",
                                     Build + "/test_programs"};
    command.insert(command.end(), more.begin(), more.end());
    const std::string trap = Build + "/libtakt_trap.so";
    std::vector<std::string> environment;
    if (std::filesystem::exists(trap)) environment.push_back("TAKT_TRAP=" + trap);
    return runCommand(command, work, environment);
}

std::vector<std::string> linesWith(const std::string& text, const std::string& part) {
    std::vector<std::string> found;
    std::istringstream lines{text};
    for (std::string line; std::getline(lines, line);) {
        if (line.find(part) != std::string::npos) found.push_back(line);
    }
    return found;
}

}  // namespace takt::test
