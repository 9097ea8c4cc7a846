#include "local_clock.hpp"

#include <algorithm>

namespace takt::twin {

namespace {

constexpr std::int64_t FractionMask = (std::int64_t{1} << ClockRateBits) - 1;
constexpr double RatePerPpm = 1099511.627776;  // 2^40 / 10^6

}  // namespace

ClockRate rateFromPpm(double ppm) noexcept {
    return static_cast<ClockRate>(ppm * RatePerPpm);
}

core::TrueTime LocalClock::whenReaching(std::int64_t local) const noexcept {
    const std::int64_t wanted = local - local_;
    if (wanted <= 0) return since_;
    // Newton's method: the speed differs from 1 by less than 0.2 %, so each step gains three
    // digits.
    std::int64_t elapsed = std::max<std::int64_t>(0, 2 * wanted - advance(wanted).whole);
    std::int64_t shown = advance(elapsed).whole;
    for (int i = 0; i < 8 && shown != wanted; ++i) {
        elapsed = std::max<std::int64_t>(0, elapsed + wanted - shown);
        shown = advance(elapsed).whole;
    }
    for (; shown < wanted; shown = advance(elapsed).whole) ++elapsed;
    while (elapsed > 0 && advance(elapsed - 1).whole >= wanted) --elapsed;
    return since_ + core::Duration{elapsed};
}

void LocalClock::adjust(core::TrueTime now, ClockRate trim, ClockRate slew,
                        core::Duration slewTime) noexcept {
    const Amount gone = advance((now - since_).count());
    local_ += gone.whole;
    fraction_ = gone.fraction & FractionMask;
    since_ = now;
    trim_ = trim;
    slew_ = slew;
    slewTime_ = slewTime.count();
}

}  // namespace takt::twin
