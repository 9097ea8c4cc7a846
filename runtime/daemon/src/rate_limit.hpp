#pragma once

#include <algorithm>
#include <chrono>

namespace takt::daemon {

/// How often somebody may ask: so many times in a second, and as many at once after a pause. Time
/// is an argument.
class RateLimit {
public:
    using Time = std::chrono::steady_clock::time_point;

    RateLimit(double perSecond, Time now) noexcept
        : perSecond_{perSecond}, left_{perSecond}, seen_{now} {}

    /// \return false: once more would be too often, and it does not count
    [[nodiscard]] bool take(Time now) noexcept {
        const double passed = std::chrono::duration<double>{now - seen_}.count();
        left_ = std::min(left_ + std::max(passed, 0.0) * perSecond_, perSecond_);
        seen_ = now;
        if (left_ < 1.0) return false;
        left_ -= 1.0;
        return true;
    }

private:
    double perSecond_;
    double left_;
    Time seen_;
};

}  // namespace takt::daemon
