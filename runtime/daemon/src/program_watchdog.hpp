#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <takt/core/time.hpp>
#include <thread>

namespace takt::daemon {

/// Watches calls of programs that are made inline, by the wall clock and from a thread of its own.
/// It reads no clock inside the cycle, so that a run in virtual time does not depend on it.
class ProgramWatchdog {
public:
    /// Called once, on the watchdog's thread, while the program still has the cycle's thread.
    using OnHang = std::function<void(std::size_t program, core::CycleNumber cycle)>;

    ProgramWatchdog(core::Duration limit, OnHang onHang);
    ~ProgramWatchdog();
    ProgramWatchdog(const ProgramWatchdog&) = delete;
    ProgramWatchdog& operator=(const ProgramWatchdog&) = delete;

    /// rt. \param program its index
    void begin(std::size_t program, core::CycleNumber cycle) noexcept {
        program_.store(program, std::memory_order_relaxed);
        cycle_.store(cycle, std::memory_order_relaxed);
        call_.store(++calls_, std::memory_order_release);
    }
    /// rt.
    void end() noexcept { call_.store(0, std::memory_order_release); }

private:
    void watch();

    core::Duration limit_;
    OnHang onHang_;
    std::uint64_t calls_{0};
    std::atomic<std::uint64_t> call_{0};  ///< number of the call under way; 0 = none
    std::atomic<std::size_t> program_{0};
    std::atomic<core::CycleNumber> cycle_{0};
    std::mutex mutex_;
    std::condition_variable changed_;
    bool over_{false};
    std::thread thread_;
};

}  // namespace takt::daemon
