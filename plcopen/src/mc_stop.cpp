#include <takt/plcopen/mc_stop.hpp>

namespace takt::plcopen {

using axis::CommandPhase;

void MC_Stop::operator()(axis::AxisRef axis) noexcept {
    axis::Command request;
    request.kind = axis::CommandKind::Stop;
    request.dynamics.deceleration = core::Acceleration{Deceleration};
    request.dynamics.jerk = core::Jerk{Jerk};

    if (!Execute && wasExecuted()) release_ = true;
    const CommandPhase phase = run(axis, request);
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
    axis::Command request;
    request.kind = axis::CommandKind::Halt;
    request.bufferMode = toAxis(BufferMode);
    request.dynamics.deceleration = core::Acceleration{Deceleration};
    request.dynamics.jerk = core::Jerk{Jerk};
    Done = runMotion(axis, request) == CommandPhase::Done;
}

}  // namespace takt::plcopen
