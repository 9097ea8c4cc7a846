#include <takt/axis/axis.hpp>

#include "look_ahead.hpp"

namespace takt::axis {

core::Velocity Axis::jointAt(core::Position from, core::Position goal) const noexcept {
    if (queue_.empty() || isEndless(active_.kind) || goal == from) return {};
    return jointSpeed(traits_, {goal, goal > from, active_.dynamics.velocity},
                      {queue_.begin(), queue_.size()});
}

/// More is known of the way ahead than when the command in control was planned.
void Axis::speedUpJoint() noexcept {
    jointPending_ = false;
    const bool moves = view_.state == AxisState::DiscreteMotion && isPositioning(active_.kind);
    if (!moves || emergency_) return;
    motion_.changeJoint(active_, jointAt(motion_.set().position, motion_.target()));
}

/// The end of the command in control lies between the last set-point and the next one. Moves
/// shorter than a cycle are passed all at once.
void Axis::passJoints() noexcept {
    for (std::size_t i = 0; i < MaxQueue && motion_.atJoint() && !queue_.empty(); ++i) {
        report(active_.id, {CommandPhase::Done, ErrorId::None});
        active_ = queue_.front();
        queue_.popFront();
        const core::Position from = motion_.target();
        const core::Position goal = goalFrom(traits_, active_, from, view_.movedBackward);
        const ErrorId bad = motion_.pass(active_, jointAt(from, goal));
        if (bad != ErrorId::None) {
            report(active_.id, {CommandPhase::Error, bad});
            view_.queued = static_cast<std::uint8_t>(queue_.size());
            brake(CommandKind::Halt);
            planActive();
            return;
        }
        noteTaken(active_);
        report(active_.id, {CommandPhase::Active, ErrorId::None});
        inPositionSince_ = 0;
        view_.commandedPosition = motion_.target();
    }
}

}  // namespace takt::axis
