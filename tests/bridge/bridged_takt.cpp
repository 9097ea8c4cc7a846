#include "bridged_takt.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

namespace takt::test {

namespace {

void replace(std::string& text, const std::string& from, const std::string& to) {
    std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << "the sample no longer has " << from;
    for (; at != std::string::npos; at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
}

}  // namespace

BridgedTakt::BridgedTakt(const std::vector<std::string>& arguments, std::string folder)
    : folder_{std::move(folder)},
      pid_{startTakt(arguments, folder_, folder_ + "/takt.txt",
                     {"TAKT_TRAP_REPORT=" + folder_ + "/trap.txt"})} {}

BridgedTakt::~BridgedTakt() {
    if (ended()) return;
    kill(SIGKILL);
    finish();
}

pid_t BridgedTakt::bridge() const {
    std::error_code fault;
    const std::string tasks = "/proc/" + std::to_string(pid_) + "/task";
    for (const auto& task : std::filesystem::directory_iterator{tasks, fault}) {
        std::ifstream children{task.path() / "children"};
        for (pid_t child = 0; children >> child;) {
            std::string name;
            std::ifstream{"/proc/" + std::to_string(child) + "/comm"} >> name;
            if (name == "takt-bridge") return child;
        }
    }
    return 0;
}

bool BridgedTakt::ended() {
    if (!reaped_) reaped_ = waitpid(pid_, &status_, WNOHANG) == pid_;
    return reaped_;
}

ProcessResult BridgedTakt::finish() {
    if (!reaped_) waitpid(pid_, &status_, 0);
    reaped_ = true;
    return {WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_),
            readFile(folder_ + "/takt.txt")};
}

void BridgedTakt::kill(int signal) const {
    if (!reaped_) ::kill(pid_, signal);
}

OwnMachine ownMachine(const std::string& folder, const std::string& dds) {
    constexpr unsigned firstDomain = 10;
    constexpr unsigned domains = 90;  // ports of higher ones may be in use by anybody
    OwnMachine machine;
    const auto process = static_cast<unsigned>(getpid());
    machine.name = "stations" + std::to_string(process);
    machine.domain = firstDomain + process % domains;
    machine.file = folder + "/machine.xml";
    machine.socket = "takt.sock";  // in the folder; the path of a socket must be short
    std::string text = readFile(std::string{TAKT_SOURCE_DIR} + "/samples/07_dds/machine.xml");
    replace(text, "Machine name=\"stations\"", "Machine name=\"" + machine.name + "\"");
    replace(text, "<Dds rate=\"100 Hz\" domain=\"7\" interface=\"lo\" commands=\"off\"/>",
            "<Dds domain=\"" + std::to_string(machine.domain) + "\" " + dds + "/>");
    replace(text, "../devices/", std::string{TAKT_SOURCE_DIR} + "/samples/devices/");
    writeFile(machine.file, text);
    return machine;
}

void pauseFor(double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>{seconds});
}

double now() {
    return std::chrono::duration<double>{std::chrono::steady_clock::now().time_since_epoch()}
        .count();
}

}  // namespace takt::test
