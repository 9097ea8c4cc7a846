#pragma once

#include <pthread.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace takt::daemon {

/// What could not be had and what that means, one line each, every line once.
class Notes {
public:
    void add(const std::string& text);
    [[nodiscard]] const std::vector<std::string>& lines() const noexcept { return lines_; }

private:
    std::vector<std::string> lines_;
};

struct ThreadPlace {
    std::string name;  ///< up to 15 characters, as `top -H` shows it
    int priority{0};   ///< SCHED_FIFO 1 … 99; 0 = normal
    int cpu{-1};       ///< -1 = any
};

/// A thread with a real-time priority, a fixed stack and denormal numbers flushed to zero. It gives
/// up the capabilities it has inherited before it does anything else.
class RealtimeThread {
public:
    /// Where priority or processor are refused the thread runs without and a note says so.
    /// \throw std::runtime_error when there is no thread to be had
    RealtimeThread(const ThreadPlace& place, std::function<void()> body, Notes& notes);
    /// Waits for the end unless let go.
    ~RealtimeThread();
    RealtimeThread(const RealtimeThread&) = delete;
    RealtimeThread& operator=(const RealtimeThread&) = delete;

    void join();
    /// It will never end: nobody waits for it.
    void letGo() noexcept;

private:
    pthread_t thread_{};
    bool running_{false};
};

/// Keeps what the process has in memory from being paged out; a note where that is refused.
void lockMemory(Notes& notes);
/// The calling thread gives up CAP_NET_RAW, CAP_SYS_NICE and CAP_IPC_LOCK for good.
void dropCapabilities() noexcept;

}  // namespace takt::daemon
