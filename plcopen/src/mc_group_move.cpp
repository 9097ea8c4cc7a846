#include <takt/plcopen/mc_group_move.hpp>

namespace takt::plcopen {

using axis::CommandPhase;
using axis::GroupCommand;
using axis::GroupCommandKind;
using axis::GroupRef;

GroupCommand GroupMoveBlock::request(GroupCommandKind kind,
                                     const GroupArray& point) const noexcept {
    GroupCommand command;
    command.kind = kind;
    command.bufferMode = toAxis(BufferMode);
    command.coordSystem = toAxis(CoordSystem);
    command.dynamics = {core::Velocity{Velocity}, core::Acceleration{Acceleration},
                        core::Acceleration{Deceleration}, core::Jerk{Jerk}};
    command.point = point;
    return command;
}

GroupCommand GroupPathBlock::request(GroupCommandKind kind,
                                     const GroupArray& point) const noexcept {
    GroupCommand command = GroupMoveBlock::request(kind, point);
    command.transition = {toAxis(TransitionMode), TransitionParameter,
                          core::Velocity{TransitionVelocity}};
    return command;
}

void MC_MoveLinearAbsolute::operator()(GroupRef group) noexcept {
    const auto command = [this]() noexcept {
        return request(GroupCommandKind::MoveLinear, Position);
    };
    Done = runMotion(group, command) == CommandPhase::Done;
}

void MC_MoveLinearRelative::operator()(GroupRef group) noexcept {
    const auto command = [this]() noexcept {
        GroupCommand line = request(GroupCommandKind::MoveLinear, Distance);
        line.relative = true;
        return line;
    };
    Done = runMotion(group, command) == CommandPhase::Done;
}

CommandPhase CircularBlock::move(const GroupRef& group, bool relative) noexcept {
    return runMotion(group, [this, relative]() noexcept {
        GroupCommand arc = request(GroupCommandKind::MoveCircular, EndPoint);
        arc.relative = relative;
        arc.arc = {toAxis(CircMode), toAxis(PathChoice), Tolerance, AuxPoint};
        return arc;
    });
}

void MC_MoveCircularAbsolute::operator()(GroupRef group) noexcept {
    Done = move(group, false) == CommandPhase::Done;
}

void MC_MoveCircularRelative::operator()(GroupRef group) noexcept {
    Done = move(group, true) == CommandPhase::Done;
}

void MC_MoveDirectAbsolute::operator()(GroupRef group) noexcept {
    const auto command = [this]() noexcept {
        return request(GroupCommandKind::MoveDirect, Position);
    };
    Done = runMotion(group, command) == CommandPhase::Done;
}

void MC_MoveDirectRelative::operator()(GroupRef group) noexcept {
    const auto command = [this]() noexcept {
        GroupCommand direct = request(GroupCommandKind::MoveDirect, Distance);
        direct.relative = true;
        return direct;
    };
    Done = runMotion(group, command) == CommandPhase::Done;
}

}  // namespace takt::plcopen
