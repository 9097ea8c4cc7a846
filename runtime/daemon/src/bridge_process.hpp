#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

namespace takt::daemon {

/// Keeps the bridge process running: starts it, and starts it again when it ends, at once when it
/// had been working and later and later when it had not. Outside the cycle; the thread that calls
/// supervise() must live as long as the process is to live.
class BridgeProcess {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds FirstPause{50};
    static constexpr std::chrono::milliseconds LongestPause{5000};

    /// What it inherits, and nothing else of this process.
    struct Descriptors {
        int status{-1};
        int commands{-1};
    };

    /// \throw std::runtime_error when there is no such program
    BridgeProcess(std::filesystem::path executable, const Descriptors& descriptors);
    /// Ends it.
    ~BridgeProcess();
    BridgeProcess(const BridgeProcess&) = delete;
    BridgeProcess& operator=(const BridgeProcess&) = delete;

    enum class Change : std::uint8_t { None, Started, Ended };
    /// Looks after it; to be called often. \param working it has done something since its start
    Change supervise(bool working);
    /// Asks it to end and sees that it does.
    void stop();
    /// It hangs: supervise() will find it ended.
    void abort() noexcept;

    /// 0 while it does not run.
    [[nodiscard]] pid_t pid() const noexcept { return pid_; }
    [[nodiscard]] std::uint64_t starts() const noexcept { return starts_; }
    /// "ended by signal 9; started again in 50 ms"
    [[nodiscard]] const std::string& lastEnd() const noexcept { return lastEnd_; }

private:
    [[nodiscard]] bool start();
    [[nodiscard]] bool hasEnded(int& status) const;
    void planRestart(const std::string& end, bool working);

    std::filesystem::path executable_;
    Descriptors descriptors_;
    pid_t pid_{0};
    std::uint64_t starts_{0};
    std::chrono::milliseconds pause_{FirstPause};
    Clock::time_point notBefore_{};
    std::string lastEnd_;
};

/// The program of the bridge process of this takt: beside its library, or where it is installed.
[[nodiscard]] std::filesystem::path bridgeExecutable();

}  // namespace takt::daemon
