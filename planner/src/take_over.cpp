#include <algorithm>
#include <takt/planner/take_over.hpp>

namespace takt::planner {

core::Jerk takeOverJerk(const State& from, const Limits& limits, core::Jerk hardest) noexcept {
    const double a = from.acceleration.count();
    if (a == 0.0) return limits.jerk;
    const core::Velocity left =
        a > 0.0 ? limits.maxVelocity - from.velocity : from.velocity - limits.minVelocity;
    const double room = left.count();
    const double most = hardest.count();
    const double needed = room > 0.0 ? std::min(a * a / (2.0 * room), most) : most;
    return std::max(limits.jerk, core::Jerk{needed});
}

}  // namespace takt::planner
