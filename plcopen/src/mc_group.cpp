#include <takt/plcopen/mc_group.hpp>

namespace takt::plcopen {

using axis::CommandPhase;
using axis::GroupCommand;
using axis::GroupCommandKind;
using axis::GroupRef;

namespace {

GroupCommand commandOf(GroupCommandKind kind) noexcept {
    GroupCommand command;
    command.kind = kind;
    return command;
}

}  // namespace

void MC_AddAxisToGroup::operator()(GroupRef group, axis::AxisRef axis) noexcept {
    const CommandPhase phase = run(group, [this, &axis]() noexcept {
        GroupCommand command = commandOf(GroupCommandKind::AddAxis);
        command.place = IdentInGroup;
        if (axis.valid()) command.axis = axis.port().view().traits;
        return command;
    });
    Done = phase == CommandPhase::Done;
}

void MC_RemoveAxisFromGroup::operator()(GroupRef group) noexcept {
    const CommandPhase phase = run(group, [this]() noexcept {
        GroupCommand command = commandOf(GroupCommandKind::RemoveAxis);
        command.place = IdentInGroup;
        return command;
    });
    Done = phase == CommandPhase::Done;
}

void MC_UngroupAllAxes::operator()(GroupRef group) noexcept {
    const auto request = []() noexcept { return commandOf(GroupCommandKind::UngroupAll); };
    Done = run(group, request) == CommandPhase::Done;
}

void MC_GroupEnable::operator()(GroupRef group) noexcept {
    const auto request = []() noexcept { return commandOf(GroupCommandKind::Enable); };
    Done = run(group, request) == CommandPhase::Done;
}

void MC_GroupDisable::operator()(GroupRef group) noexcept {
    const auto request = []() noexcept { return commandOf(GroupCommandKind::Disable); };
    Done = run(group, request) == CommandPhase::Done;
}

void MC_GroupReset::operator()(GroupRef group) noexcept {
    const auto request = []() noexcept { return commandOf(GroupCommandKind::Reset); };
    Done = run(group, request) == CommandPhase::Done;
}

void MC_GroupStop::operator()(GroupRef group) noexcept {
    if (!Execute && wasExecuted()) release_ = true;
    const CommandPhase phase = run(group, [this]() noexcept {
        GroupCommand command = commandOf(GroupCommandKind::Stop);
        command.dynamics.deceleration = core::Acceleration{Deceleration};
        command.dynamics.jerk = core::Jerk{Jerk};
        return command;
    });
    Done = phase == CommandPhase::Done;
    CommandAborted = phase == CommandPhase::Aborted;
    if (Execute) release_ = false;
    if (release_) release(group);
    Active = phase == CommandPhase::Active || (Done && Execute);
}

void MC_GroupStop::release(const GroupRef& group) noexcept {
    if (!group.valid() || command() == axis::CommandId::None) {
        release_ = false;
        return;
    }
    GroupCommand unlock = commandOf(GroupCommandKind::ReleaseStop);
    unlock.replaces = command();
    // Refused only while this cycle's list of commands is full; then the next call tries again.
    release_ = !group.port().submit(unlock).ok();
}

void MC_GroupHalt::operator()(GroupRef group) noexcept {
    const CommandPhase phase = runMotion(group, [this]() noexcept {
        GroupCommand command = commandOf(GroupCommandKind::Halt);
        command.bufferMode = toAxis(BufferMode);
        command.dynamics.deceleration = core::Acceleration{Deceleration};
        command.dynamics.jerk = core::Jerk{Jerk};
        return command;
    });
    Done = phase == CommandPhase::Done;
}

}  // namespace takt::plcopen
