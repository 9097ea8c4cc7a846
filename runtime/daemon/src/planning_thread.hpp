#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "realtime_thread.hpp"

namespace takt::daemon {

/// Does jobs on a real clock, below the priority of cycle and programs.
class PlanningThread {
public:
    /// \param work does all that is asked for when it is called
    PlanningThread(const ThreadPlace& place, std::function<void()> work, Notes& notes);
    /// Ends when the work at hand is done.
    ~PlanningThread();
    PlanningThread(const PlanningThread&) = delete;
    PlanningThread& operator=(const PlanningThread&) = delete;

    /// rt. Something has been asked for. One system call.
    void ring() noexcept;

private:
    void serve();

    std::function<void()> work_;
    std::atomic<std::uint32_t> bell_{0};  ///< changes with every ring
    std::atomic<bool> over_{false};
    RealtimeThread thread_;
};

}  // namespace takt::daemon
