#include "planning_thread.hpp"

namespace takt::daemon {

PlanningThread::PlanningThread(const ThreadPlace& place, Groups& groups, Notes& notes)
    : groups_{groups}, thread_{place, [this] { serve(); }, notes} {}

PlanningThread::~PlanningThread() {
    over_.store(true, std::memory_order_release);
    bell_.fetch_add(1, std::memory_order_release);
    bell_.notify_one();
    thread_.join();
}

void PlanningThread::wakeIfWanted() noexcept {
    bool wanted = false;
    for (axis::Group& group : groups_) wanted = group.planner().takeCall() || wanted;
    if (!wanted) return;
    bell_.fetch_add(1, std::memory_order_release);
    bell_.notify_one();
}

void PlanningThread::serve() {
    std::uint32_t heard = 0;
    for (;;) {
        bell_.wait(heard, std::memory_order_acquire);
        heard = bell_.load(std::memory_order_acquire);
        if (over_.load(std::memory_order_acquire)) return;
        for (axis::Group& group : groups_) {
            if (group.planner().wanted()) group.planner().work();
        }
    }
}

}  // namespace takt::daemon
