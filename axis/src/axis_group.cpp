#include <takt/axis/axis.hpp>

namespace takt::axis {

bool Axis::claim() noexcept {
    const bool free = !claimed_;
    claimed_ = true;
    return free;
}

void Axis::joinGroup() noexcept {
    view_.state = AxisState::SynchronizedMotion;
    view_.grouped = true;
    view_.atRest = false;
    led_ = motion_.set();
    motion_.lead(led_);
}

void Axis::leaveGroup() noexcept {
    if (!view_.grouped) return;
    view_.grouped = false;
    const planner::State& set = motion_.set();
    const bool rests = set.velocity == core::Velocity{} && set.acceleration == core::Acceleration{};
    if (rests) {
        motion_.hold(set.position);
    } else if (view_.state == AxisState::SynchronizedMotion) {
        brake(CommandKind::Halt);
        return;
    } else if (!motion_.beginStop()) {
        emergency_ = true;
    }
    view_.commandedPosition = set.position;
    view_.atRest = motion_.resting();
    if (view_.state == AxisState::SynchronizedMotion) enterStandstill();
}

void Axis::failWithGroup() noexcept {
    if (live()) raise(ErrorId::GroupFault, {}, Reaction::Ramp);
}

void Axis::resetWithGroup() noexcept {
    Command reset;
    reset.kind = CommandKind::Reset;
    execute(reset);
}

}  // namespace takt::axis
