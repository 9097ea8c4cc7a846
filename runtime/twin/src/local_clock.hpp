#pragma once

#include <cstdint>
#include <takt/core/time.hpp>

namespace takt::twin {

/// A relative clock speed in steps of 2^-40 (about one part in 10^12); 0 = as fast as true time.
using ClockRate = std::int64_t;

inline constexpr int ClockRateBits = 40;

/// The rate of an oscillator that is `ppm` parts per million fast.
[[nodiscard]] ClockRate rateFromPpm(double ppm) noexcept;

/// A clock inside the simulated world: its own speed, read in whole nanoseconds, kept exact to
/// 2^-40 ns, in integers only so that every processor computes the same.
///
/// Two speed corrections act on it: a lasting trim and a slew that ends by itself.
class LocalClock {
public:
    LocalClock(double ppm, std::int64_t start) noexcept
        : oscillator_{rateFromPpm(ppm)}, local_{start} {}

    /// rt. What the clock shows at `now`. \pre `now` is not before the last `adjust`
    [[nodiscard]] std::int64_t at(core::TrueTime now) const noexcept {
        return local_ + advance((now - since_).count()).whole;
    }
    /// rt. The first instant, not before the last `adjust`, at which the clock shows at least
    /// `local`.
    [[nodiscard]] core::TrueTime whenReaching(std::int64_t local) const noexcept;
    /// rt. From `now` on: run faster by `trim`, and for the next `slewTime` also by `slew`.
    void adjust(core::TrueTime now, ClockRate trim, ClockRate slew,
                core::Duration slewTime) noexcept;

    [[nodiscard]] ClockRate trim() const noexcept { return trim_; }

private:
    struct Amount {
        std::int64_t whole;     ///< ns
        std::int64_t fraction;  ///< 2^-40 ns
    };
    static constexpr int HalfBits = ClockRateBits / 2;
    static constexpr std::int64_t HalfMask = (std::int64_t{1} << HalfBits) - 1;

    [[nodiscard]] Amount advance(std::int64_t elapsed) const noexcept {
        // elapsed · rate has up to 80 bits: multiply the halves of `elapsed`, add them 20 bits
        // apart.
        const ClockRate rate = oscillator_ + trim_;
        const std::int64_t high = (elapsed >> HalfBits) * rate;
        const std::int64_t slewed = elapsed < slewTime_ ? elapsed : slewTime_;
        const std::int64_t low = (elapsed & HalfMask) * rate + fraction_ + slewed * slew_;
        const std::int64_t middle = high + (low >> HalfBits);
        return {elapsed + (middle >> HalfBits),
                ((middle & HalfMask) << HalfBits) | (low & HalfMask)};
    }

    ClockRate oscillator_;
    ClockRate trim_{0};
    ClockRate slew_{0};
    std::int64_t slewTime_{0};
    core::TrueTime since_{};
    std::int64_t local_;        ///< at since_
    std::int64_t fraction_{0};  ///< of local_, 2^-40 ns
};

}  // namespace takt::twin
