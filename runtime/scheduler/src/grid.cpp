#include <takt/scheduler/grid.hpp>

namespace takt::scheduler {

Beat Grid::wait(core::ClockSource& clock) noexcept {
    Beat beat;
    const core::HostTime now = clock.now();
    if (number_ > 0 && now > next_) {
        const auto missed = (now - next_) / cycle_ + 1;
        beat.skipped = static_cast<std::uint32_t>(missed);
        next_ += missed * cycle_;
        if (beat.skipped <= bridgeable_) beat.madeUpFor = beat.skipped;
        number_ += beat.madeUpFor;
    }
    clock.sleepUntil(next_);
    beat.number = number_++;
    beat.planned = next_;
    beat.woke = clock.now();
    next_ += cycle_;
    return beat;
}

}  // namespace takt::scheduler
