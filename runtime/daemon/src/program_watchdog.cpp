#include "program_watchdog.hpp"

#include <utility>

namespace takt::daemon {

namespace {
/// The limit is looked at in so many parts: time in which the whole computer stood still counts
/// once.
constexpr int Looks = 10;
}  // namespace

ProgramWatchdog::ProgramWatchdog(core::Duration limit, OnHang onHang)
    : limit_{limit}, onHang_{std::move(onHang)}, thread_{[this] { watch(); }} {}

ProgramWatchdog::~ProgramWatchdog() {
    {
        const std::lock_guard lock{mutex_};
        over_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void ProgramWatchdog::watch() {
    std::uint64_t seen = 0;
    int looks = 0;
    std::unique_lock lock{mutex_};
    while (!changed_.wait_for(lock, limit_ / Looks, [this] { return over_; })) {
        const std::uint64_t call = call_.load(std::memory_order_acquire);
        looks = call != 0 && call == seen ? looks + 1 : 0;
        seen = call;
        if (looks < Looks) continue;
        onHang_(program_.load(std::memory_order_relaxed), cycle_.load(std::memory_order_relaxed));
        return;
    }
}

}  // namespace takt::daemon
