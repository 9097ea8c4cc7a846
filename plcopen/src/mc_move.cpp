#include <takt/plcopen/mc_move.hpp>

namespace takt::plcopen {

axis::Command MoveBlock::request(axis::CommandKind kind) const noexcept {
    axis::Command command;
    command.kind = kind;
    command.bufferMode = toAxis(BufferMode);
    command.dynamics = {core::Velocity{Velocity}, core::Acceleration{Acceleration},
                        core::Acceleration{Deceleration}, core::Jerk{Jerk}};
    return command;
}

void MC_MoveAbsolute::operator()(axis::AxisRef axis) noexcept {
    const axis::CommandPhase phase = runMotion(axis, [this]() noexcept {
        axis::Command command = request(axis::CommandKind::MoveAbsolute);
        command.position = core::Position{Position};
        command.direction = toAxis(Direction);
        return command;
    });
    Done = phase == axis::CommandPhase::Done;
}

void MC_MoveRelative::operator()(axis::AxisRef axis) noexcept {
    const axis::CommandPhase phase = runMotion(axis, [this]() noexcept {
        axis::Command command = request(axis::CommandKind::MoveRelative);
        command.distance = core::Distance{Distance};
        return command;
    });
    Done = phase == axis::CommandPhase::Done;
}

void MC_MoveVelocity::operator()(axis::AxisRef axis) noexcept {
    const axis::CommandPhase phase = runMotion(axis, [this]() noexcept {
        axis::Command request = this->request(axis::CommandKind::MoveVelocity);
        request.direction = toAxis(Direction);
        return request;
    });
    InVelocity = phase == axis::CommandPhase::Active && axis.valid() &&
                 axis.port().view().active == command() && axis.port().view().inVelocity;
}

void MC_MoveAdditive::operator()(axis::AxisRef axis) noexcept {
    const axis::CommandPhase phase = runMotion(axis, [this]() noexcept {
        axis::Command command = request(axis::CommandKind::MoveAdditive);
        command.distance = core::Distance{Distance};
        return command;
    });
    Done = phase == axis::CommandPhase::Done;
}

void ContinuousMoveBlock::showEnd(const axis::AxisRef& axis, axis::CommandPhase phase) noexcept {
    InEndVelocity = phase == axis::CommandPhase::Active && axis.valid() &&
                    axis.port().view().active == command() && axis.port().view().inVelocity;
}

void MC_MoveContinuousAbsolute::operator()(axis::AxisRef axis) noexcept {
    const axis::CommandPhase phase = runMotion(axis, [this]() noexcept {
        axis::Command request = this->request(axis::CommandKind::MoveContinuousAbsolute);
        request.position = core::Position{Position};
        request.direction = toAxis(Direction);
        request.endVelocity = core::Velocity{EndVelocity};
        return request;
    });
    showEnd(axis, phase);
}

void MC_MoveContinuousRelative::operator()(axis::AxisRef axis) noexcept {
    const axis::CommandPhase phase = runMotion(axis, [this]() noexcept {
        axis::Command request = this->request(axis::CommandKind::MoveContinuousRelative);
        request.distance = core::Distance{Distance};
        request.endVelocity = core::Velocity{EndVelocity};
        return request;
    });
    showEnd(axis, phase);
}

}  // namespace takt::plcopen
