#include <takt/plcopen/mc_jog.hpp>

namespace takt::plcopen {

using axis::CommandPhase;
using axis::ErrorId;

ButtonBlock::Button ButtonBlock::sample(bool forward, bool backward) noexcept {
    Done = false;
    if (!forward && !backward) {
        locked_ = false;
        CommandAborted = Error = false;
        ErrorID = ErrorId::None;
    }
    if (locked_ || forward == backward) return Button::None;
    return forward ? Button::Forward : Button::Backward;
}

void ButtonBlock::follow() noexcept {
    if (!underWay()) return;
    if (!axis_.valid()) {
        phase_ = CommandPhase::Unknown;
        fail(ErrorId::NullReference);
        return;
    }
    const axis::CommandStatus status = axis_.port().status(id_);
    phase_ = status.phase;
    if (Error || CommandAborted) return;  // the ramp behind an end that is being shown
    switch (status.phase) {
        case CommandPhase::Queued:
        case CommandPhase::Active:
            return;
        case CommandPhase::Done:
            Done = true;
            return;
        case CommandPhase::Aborted:
            CommandAborted = locked_ = true;
            return;
        case CommandPhase::Error:
            fail(status.error);
            return;
        case CommandPhase::Unknown:
            fail(ErrorId::OutcomeUnknown);
            return;
    }
}

void ButtonBlock::submit(const axis::AxisRef& axis, axis::Command command) noexcept {
    if (!axis.valid()) {
        fail(ErrorId::NullReference);
        return;
    }
    command.replaces = id_;
    const auto accepted = axis.port().submit(command);
    if (!accepted.ok()) {
        // What runs must not go on when the operator wanted something else that cannot be had.
        if (underWay() && !halting_) halt();
        fail(accepted.error());
        return;
    }
    axis_ = axis;
    id_ = accepted.value();
    phase_ = axis.port().status(id_).phase;
    halting_ = command.kind == axis::CommandKind::Halt;
    Done = halting_ && phase_ == CommandPhase::Done;
}

void ButtonBlock::halt() noexcept {
    axis::Command command;
    command.kind = axis::CommandKind::Halt;
    command.dynamics.deceleration = core::Acceleration{Deceleration};
    command.dynamics.jerk = core::Jerk{Jerk};
    command.replaces = id_;
    auto accepted = axis_.port().submit(command);
    if (!accepted.ok()) {
        // A wrong Deceleration or Jerk shall not keep a released axis moving.
        command.dynamics = {};
        accepted = axis_.port().submit(command);
    }
    if (!accepted.ok()) return;  // the next call tries again
    id_ = accepted.value();
    phase_ = axis_.port().status(id_).phase;
    halting_ = true;
    Done = phase_ == CommandPhase::Done;
}

void ButtonBlock::show() noexcept {
    Busy = Active = underWay();
    if (Busy) Done = false;
    // Exactly one of the outputs speaks; a ramp that goes on behind an error is the axis' business.
    if (Error || CommandAborted) Busy = Active = Done = false;
}

void ButtonBlock::fail(ErrorId error) noexcept {
    Error = locked_ = true;
    CommandAborted = Done = false;
    ErrorID = error;
}

axis::Command ButtonBlock::move(axis::CommandKind kind) const noexcept {
    axis::Command command;
    command.kind = kind;
    command.dynamics = {core::Velocity{Velocity}, core::Acceleration{Acceleration},
                        core::Acceleration{Deceleration}, core::Jerk{Jerk}};
    return command;
}

void MC_Jog::operator()(axis::AxisRef axis) noexcept {
    const Button wanted = sample(JogForward, JogBackward);
    follow();
    if (!underWay() || halting()) direction_ = Button::None;
    if (Error || CommandAborted || wanted == Button::None) {
        if (underWay() && !halting()) halt();
    } else if (wanted != direction_ || Velocity != velocity_) {
        direction_ = wanted;
        velocity_ = Velocity;
        if (!(Velocity > 0.0)) {
            if (underWay() && !halting()) halt();
            fail(ErrorId::InvalidParameter);
        } else {
            axis::Command command = move(axis::CommandKind::MoveVelocity);
            command.direction =
                wanted == Button::Forward ? axis::Direction::Positive : axis::Direction::Negative;
            submit(axis, command);
        }
    }
    show();
}

void MC_Inch::operator()(axis::AxisRef axis) noexcept {
    const Button wanted = sample(InchForward, InchBackward);
    const bool pressed = wanted != Button::None && wanted != last_;
    last_ = wanted;
    follow();
    if (pressed && !Error && !CommandAborted) {
        if (!(Distance > 0.0) || !(Velocity > 0.0)) {
            if (underWay() && !halting()) halt();
            fail(ErrorId::InvalidParameter);
        } else {
            axis::Command command = move(axis::CommandKind::MoveRelative);
            command.distance = core::Distance{wanted == Button::Forward ? Distance : -Distance};
            submit(axis, command);
        }
    } else if (wanted == Button::None && underWay() && !halting()) {
        halt();
    }
    show();
}

}  // namespace takt::plcopen
