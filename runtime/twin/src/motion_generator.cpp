#include "motion_generator.hpp"

#include <algorithm>
#include <cmath>

namespace takt::twin {

void MotionGenerator::begin(const Demand& from) noexcept {
    demand_ = from;
    demand_.acceleration = 0.0;
    toTarget_ = false;
    passed_ = false;
    speed_ = 0.0;
}

void MotionGenerator::run(double velocity, double acceleration, double deceleration) noexcept {
    toTarget_ = false;
    passed_ = false;
    speed_ = velocity;
    acceleration_ = acceleration;
    deceleration_ = deceleration;
}

void MotionGenerator::moveTo(double position, const MotionLimits& limits,
                             double endSpeed) noexcept {
    toTarget_ = true;
    passed_ = false;
    target_ = position;
    speed_ = limits.speed;
    endSpeed_ = endSpeed;
    acceleration_ = limits.acceleration;
    deceleration_ = limits.deceleration;
}

double MotionGenerator::wanted(double seconds) const noexcept {
    if (!toTarget_) return speed_;
    const double distance = target_ - demand_.position;
    const double length = distance < 0.0 ? -distance : distance;
    // The speed from which the rest of the way is enough to slow down, and no faster than to
    // arrive, unless it goes on behind the target.
    const double braking = std::sqrt(endSpeed_ * endSpeed_ + 2.0 * deceleration_ * length);
    const double arriving = std::max(length / seconds, endSpeed_);
    const double speed = std::min({speed_, braking, arriving});
    return distance < 0.0 ? -speed : speed;
}

const Demand& MotionGenerator::step(double seconds) noexcept {
    const double before = demand_.velocity;
    const double faster = acceleration_ * seconds;
    const double slower = deceleration_ * seconds;
    const double up = before >= 0.0 ? faster : slower;
    const double down = before > 0.0 ? slower : faster;
    const double velocity = std::clamp(wanted(seconds), before - down, before + up);
    demand_.acceleration = (velocity - before) / seconds;
    demand_.velocity = velocity;
    const double ahead = target_ - demand_.position;
    demand_.position += velocity * seconds;
    if (!toTarget_) return demand_;
    const double left = target_ - demand_.position;
    if (endSpeed_ > 0.0) {
        passed_ = passed_ || left == 0.0 || (left > 0.0) != (ahead > 0.0);
        return demand_;
    }
    const double near = slower * seconds;
    if (left <= near && left >= -near && velocity <= 2.0 * slower && velocity >= -2.0 * slower) {
        demand_ = {target_, 0.0, 0.0};
    }
    return demand_;
}

}  // namespace takt::twin
