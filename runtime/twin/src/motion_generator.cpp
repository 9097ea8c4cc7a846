#include "motion_generator.hpp"

#include <algorithm>
#include <cmath>

namespace takt::twin {

void MotionGenerator::begin(const Demand& from) noexcept {
    demand_ = from;
    demand_.acceleration = 0.0;
    toTarget_ = false;
    speed_ = 0.0;
}

void MotionGenerator::run(double velocity, double acceleration) noexcept {
    toTarget_ = false;
    speed_ = velocity;
    acceleration_ = acceleration;
}

void MotionGenerator::moveTo(double position, double speed, double acceleration) noexcept {
    toTarget_ = true;
    target_ = position;
    speed_ = speed;
    acceleration_ = acceleration;
}

const Demand& MotionGenerator::step(double seconds) noexcept {
    double wanted = speed_;
    if (toTarget_) {
        const double distance = target_ - demand_.position;
        const double length = distance < 0.0 ? -distance : distance;
        // The speed from which the rest of the way is enough to stop, and no faster than to arrive.
        const double braking = std::sqrt(2.0 * acceleration_ * length);
        wanted = std::min({speed_, braking, length / seconds});
        if (distance < 0.0) wanted = -wanted;
    }
    const double change = acceleration_ * seconds;
    const double velocity =
        std::clamp(wanted, demand_.velocity - change, demand_.velocity + change);
    demand_.acceleration = (velocity - demand_.velocity) / seconds;
    demand_.velocity = velocity;
    demand_.position += velocity * seconds;
    if (toTarget_) {
        const double left = target_ - demand_.position;
        const double near = change * seconds;
        if (left <= near && left >= -near && velocity <= 2.0 * change &&
            velocity >= -2.0 * change) {
            demand_ = {target_, 0.0, 0.0};
        }
    }
    return demand_;
}

}  // namespace takt::twin
