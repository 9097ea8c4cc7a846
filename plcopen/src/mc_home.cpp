#include <takt/plcopen/mc_home.hpp>

namespace takt::plcopen {

void MC_Home::operator()(axis::AxisRef axis) noexcept {
    const axis::CommandPhase phase = runMotion(axis, [this]() noexcept {
        axis::Command command;
        command.kind = axis::CommandKind::Home;
        command.bufferMode = toAxis(BufferMode);
        command.position = core::Position{Position};
        return command;
    });
    Done = phase == axis::CommandPhase::Done;
}

}  // namespace takt::plcopen
