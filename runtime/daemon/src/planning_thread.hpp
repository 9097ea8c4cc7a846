#pragma once

#include <atomic>
#include <cstdint>

#include "axes.hpp"
#include "realtime_thread.hpp"

namespace takt::daemon {

/// Plans the paths of all groups on a real clock, below the priority of cycle and programs.
class PlanningThread {
public:
    /// The groups outlive the object.
    PlanningThread(const ThreadPlace& place, Groups& groups, Notes& notes);
    /// Ends when the plan at hand is done.
    ~PlanningThread();
    PlanningThread(const PlanningThread&) = delete;
    PlanningThread& operator=(const PlanningThread&) = delete;

    /// rt. One system call when a group has asked for a plan since the last time, none otherwise.
    void wakeIfWanted() noexcept;

private:
    void serve();

    Groups& groups_;
    std::atomic<std::uint32_t> bell_{0};  ///< changes with every ring
    std::atomic<bool> over_{false};
    RealtimeThread thread_;
};

}  // namespace takt::daemon
