#include "pace.hpp"

#include <thread>

namespace takt::daemon {

void Pace::wait(core::Duration simulated) const {
    if (follow_) std::this_thread::sleep_until(began_ + simulated);
}

core::Duration Pace::elapsed() const {
    return std::chrono::steady_clock::now() - began_;
}

}  // namespace takt::daemon
