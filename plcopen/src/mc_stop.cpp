#include <takt/plcopen/mc_stop.hpp>

namespace takt::plcopen {

using axis::CommandPhase;

void MC_Stop::operator()(axis::AxisRef axis) noexcept {
    if (!Execute && wasExecuted()) release_ = true;
    const CommandPhase phase = run(axis, [this]() noexcept {
        axis::Command command;
        command.kind = axis::CommandKind::Stop;
        command.dynamics.deceleration = core::Acceleration{Deceleration};
        command.dynamics.jerk = core::Jerk{Jerk};
        return command;
    });
    Done = phase == CommandPhase::Done;
    CommandAborted = phase == CommandPhase::Aborted;
    if (Execute) release_ = false;
    if (release_) release(axis);
    Active = phase == CommandPhase::Active || (Done && Execute);
}

void MC_Stop::release(const axis::AxisRef& axis) noexcept {
    if (!axis.valid() || command() == axis::CommandId::None) {
        release_ = false;
        return;
    }
    axis::Command unlock;
    unlock.kind = axis::CommandKind::ReleaseStop;
    unlock.replaces = command();
    // Refused only while this cycle's list of commands is full; then the next call tries again.
    release_ = !axis.port().submit(unlock).ok();
}

void MC_Halt::operator()(axis::AxisRef axis) noexcept {
    const CommandPhase phase = runMotion(axis, [this]() noexcept {
        axis::Command command;
        command.kind = axis::CommandKind::Halt;
        command.bufferMode = toAxis(BufferMode);
        command.dynamics.deceleration = core::Acceleration{Deceleration};
        command.dynamics.jerk = core::Jerk{Jerk};
        return command;
    });
    Done = phase == CommandPhase::Done;
}

}  // namespace takt::plcopen
