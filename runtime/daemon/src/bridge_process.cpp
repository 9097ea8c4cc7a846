#include "bridge_process.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <takt/bridge/protocol.hpp>
#include <utility>

namespace takt::daemon {

namespace {

/// Above those that the bridge gets, so that none is overwritten before it was handed over.
constexpr int FirstFreeDescriptor = 16;
constexpr int EndPollMs = 10;
constexpr int MostEndPolls = 100;

int duplicate(int descriptor) {
    const int copy = fcntl(descriptor, F_DUPFD_CLOEXEC, FirstFreeDescriptor);
    if (copy < 0) throw std::runtime_error{fmt::format("bridge: {}", std::strerror(errno))};
    return copy;
}

/// What the new process gets instead of what this one has.
class SpawnPlan {
public:
    explicit SpawnPlan(const BridgeProcess::Descriptors& descriptors) {
        posix_spawn_file_actions_init(&files_);
        posix_spawn_file_actions_addopen(&files_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&files_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
        posix_spawn_file_actions_adddup2(&files_, descriptors.status, bridge::StatusDescriptor);
        posix_spawn_file_actions_adddup2(&files_, descriptors.commands, bridge::CommandDescriptor);
        posix_spawn_file_actions_addclosefrom_np(&files_, bridge::CommandDescriptor + 1);
        posix_spawnattr_init(&attributes_);
        sigset_t none;
        sigset_t all;
        sigemptyset(&none);
        sigfillset(&all);
        posix_spawnattr_setsigmask(&attributes_, &none);
        posix_spawnattr_setsigdefault(&attributes_, &all);
        // ^C at the terminal is for the machine, which then ends the bridge.
        posix_spawnattr_setpgroup(&attributes_, 0);
        posix_spawnattr_setflags(
            &attributes_, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    }
    ~SpawnPlan() {
        posix_spawn_file_actions_destroy(&files_);
        posix_spawnattr_destroy(&attributes_);
    }
    SpawnPlan(const SpawnPlan&) = delete;
    SpawnPlan& operator=(const SpawnPlan&) = delete;

    /// Does not copy the memory of this process, locked as it may be. \return 0 or an errno
    int spawn(pid_t& pid, const std::string& program) const {
        std::string parent = std::to_string(getpid());
        std::string name = program;
        const std::array<char*, 3> arguments{name.data(), parent.data(), nullptr};
        const std::array<char*, 1> environment{nullptr};
        return posix_spawn(&pid, program.c_str(), &files_, &attributes_, arguments.data(),
                           environment.data());
    }

private:
    posix_spawn_file_actions_t files_{};
    posix_spawnattr_t attributes_{};
};

std::string describeEnd(int status) {
    if (WIFSIGNALED(status)) return fmt::format("ended by signal {}", WTERMSIG(status));
    return fmt::format("ended with code {}", WEXITSTATUS(status));
}

}  // namespace

BridgeProcess::BridgeProcess(std::filesystem::path executable, const Descriptors& descriptors)
    : executable_{std::move(executable)},
      descriptors_{duplicate(descriptors.status), duplicate(descriptors.commands)} {
    std::error_code fault;
    if (std::filesystem::is_regular_file(executable_, fault)) return;
    throw std::runtime_error{
        fmt::format("{}: there is no such program, which <Bridge> of the machine file needs; do: "
                    "install takt-bridge, or take <Bridge> out",
                    executable_.string())};
}

BridgeProcess::~BridgeProcess() {
    stop();
    close(descriptors_.status);
    close(descriptors_.commands);
}

BridgeProcess::Change BridgeProcess::supervise(bool working) {
    if (pid_ != 0) {
        int status = 0;
        if (!hasEnded(status)) return Change::None;
        planRestart(describeEnd(status), working);
        return Change::Ended;
    }
    if (Clock::now() < notBefore_) return Change::None;
    return start() ? Change::Started : Change::Ended;
}

bool BridgeProcess::start() {
    const int error = SpawnPlan{descriptors_}.spawn(pid_, executable_.string());
    if (error != 0) {
        planRestart(fmt::format("could not be started: {}", std::strerror(error)), false);
        return false;
    }
    ++starts_;
    return true;
}

bool BridgeProcess::hasEnded(int& status) const {
    // Where nobody else waits for it, the process itself says how it ended.
    const pid_t ended = waitpid(pid_, &status, WNOHANG);
    return ended == pid_ || (ended < 0 && errno == ECHILD);
}

void BridgeProcess::planRestart(const std::string& end, bool working) {
    pid_ = 0;
    if (working) pause_ = FirstPause;
    lastEnd_ = fmt::format("{}; started again in {} ms", end, pause_.count());
    notBefore_ = Clock::now() + pause_;
    pause_ = std::min(pause_ * 2, LongestPause);
}

void BridgeProcess::stop() {
    // Where even the second one is not permitted, the process ends with this thread.
    for (const int signal : {SIGTERM, SIGKILL}) {
        if (pid_ != 0) kill(pid_, signal);
        for (int i = 0; i < MostEndPolls && pid_ != 0; ++i) {
            int status = 0;
            if (hasEnded(status)) {
                pid_ = 0;
            } else {
                ::poll(nullptr, 0, EndPollMs);
            }
        }
    }
}

void BridgeProcess::abort() noexcept {
    if (pid_ != 0) kill(pid_, SIGKILL);
}

std::filesystem::path bridgeExecutable() {
    Dl_info self{};
    std::filesystem::path folder;
    if (dladdr(reinterpret_cast<const void*>(&bridgeExecutable), &self) != 0 &&
        self.dli_fname != nullptr) {
        folder = std::filesystem::absolute(self.dli_fname).parent_path();
    }
    std::filesystem::path beside = folder / "takt-bridge";
    std::error_code fault;
    if (std::filesystem::is_regular_file(beside, fault)) return beside;
    return (folder / TAKT_LIBEXEC_FROM_LIB / "takt-bridge").lexically_normal();
}

}  // namespace takt::daemon
