#include <cerrno>
#include <ctime>
#include <takt/core/monotonic_clock.hpp>

namespace takt::core {

namespace {
constexpr std::int64_t NanosPerSecond = 1'000'000'000;
}

HostTime MonotonicClock::now() const noexcept {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return HostTime{Duration{time.tv_sec * NanosPerSecond + time.tv_nsec}};
}

void MonotonicClock::sleepUntil(HostTime wake) noexcept {
    const std::int64_t ns = wake.time_since_epoch().count();
    if (ns <= 0) return;
    timespec time{};
    time.tv_sec = ns / NanosPerSecond;
    time.tv_nsec = ns % NanosPerSecond;
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
    }
}

}  // namespace takt::core
