#include "planning_thread.hpp"

#include <utility>

namespace takt::daemon {

PlanningThread::PlanningThread(const ThreadPlace& place, std::function<void()> work, Notes& notes)
    : work_{std::move(work)}, thread_{place, [this] { serve(); }, notes} {}

PlanningThread::~PlanningThread() {
    over_.store(true, std::memory_order_release);
    ring();
    thread_.join();
}

void PlanningThread::ring() noexcept {
    bell_.fetch_add(1, std::memory_order_release);
    bell_.notify_one();
}

void PlanningThread::serve() {
    std::uint32_t heard = 0;
    for (;;) {
        bell_.wait(heard, std::memory_order_acquire);
        heard = bell_.load(std::memory_order_acquire);
        if (over_.load(std::memory_order_acquire)) return;
        work_();
    }
}

}  // namespace takt::daemon
