#include <algorithm>
#include <cmath>
#include <takt/planner/speed_change.hpp>

namespace takt::planner {

double rampDistance(double from, double to, const RampLimits& limits) noexcept {
    const double change = std::abs(to - from);
    const double full = limits.acceleration * limits.acceleration / limits.jerk;
    const double time = change >= full
                            ? change / limits.acceleration + limits.acceleration / limits.jerk
                            : 2.0 * std::sqrt(change / limits.jerk);
    return 0.5 * (from + to) * time;
}

double fastestWithin(double distance, double other, double cap, const RampLimits& limits) noexcept {
    if (cap <= other || rampDistance(other, cap, limits) <= distance) return cap;
    // From a velocity that is positive the distance grows with the velocity; from a negative one it
    // does so once it is positive. So the answer is where it passes `distance`.
    double low = std::max(other, 0.0);
    if (rampDistance(other, low, limits) > distance) return 0.0;
    double high = cap;
    constexpr int Halvings = 48;  // to the last bits of a double
    for (int i = 0; i < Halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (rampDistance(other, middle, limits) <= distance ? low : high) = middle;
    }
    return low;
}

}  // namespace takt::planner
