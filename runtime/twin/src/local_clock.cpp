#include "local_clock.hpp"

#include <algorithm>

namespace takt::twin {

namespace {

constexpr int HalfBits = ClockRateBits / 2;
constexpr std::int64_t HalfMask = (std::int64_t{1} << HalfBits) - 1;
constexpr std::int64_t FractionMask = (std::int64_t{1} << ClockRateBits) - 1;
constexpr double RatePerPpm = 1099511.627776;  // 2^40 / 10^6

}  // namespace

ClockRate rateFromPpm(double ppm) noexcept {
    return static_cast<ClockRate>(ppm * RatePerPpm);
}

LocalClock::Amount LocalClock::advance(std::int64_t elapsed) const noexcept {
    // elapsed · rate has up to 80 bits: multiply the halves of `elapsed` and add them 20 bits
    // apart.
    const ClockRate rate = oscillator_ + trim_;
    const std::int64_t high = (elapsed >> HalfBits) * rate;
    std::int64_t low = (elapsed & HalfMask) * rate + fraction_;
    if (slew_ != 0) low += std::min(elapsed, slewTime_) * slew_;
    const std::int64_t middle = high + (low >> HalfBits);
    return {elapsed + (middle >> HalfBits), ((middle & HalfMask) << HalfBits) | (low & HalfMask)};
}

core::TrueTime LocalClock::whenReaching(std::int64_t local) const noexcept {
    std::int64_t elapsed = local - local_;
    if (elapsed <= 0) return since_;
    // Newton's method: the speed differs from 1 by less than 0.2 %, so each step gains three
    // digits.
    elapsed = std::max<std::int64_t>(0, 2 * elapsed - advance(elapsed).whole);
    for (int i = 0; i < 8; ++i) {
        const std::int64_t missing = local - local_ - advance(elapsed).whole;
        if (missing == 0) break;
        elapsed = std::max<std::int64_t>(0, elapsed + missing);
    }
    while (elapsed > 0 && local_ + advance(elapsed - 1).whole >= local) --elapsed;
    while (local_ + advance(elapsed).whole < local) ++elapsed;
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
