#include <takt/plcopen/mc_home.hpp>

namespace takt::plcopen {

void MC_Home::operator()(axis::AxisRef axis) noexcept {
    axis::Command request;
    request.kind = axis::CommandKind::Home;
    request.bufferMode = toAxis(BufferMode);
    request.position = core::Position{Position};
    Done = runMotion(axis, request) == axis::CommandPhase::Done;
}

}  // namespace takt::plcopen
