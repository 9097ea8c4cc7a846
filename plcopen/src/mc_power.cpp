#include <takt/plcopen/mc_power.hpp>

namespace takt::plcopen {

void MC_Power::operator()(axis::AxisRef axis) noexcept {
    if (!axis.valid()) {
        Status = Valid = false;
        Error = Enable;
        ErrorID = Enable ? axis::ErrorId::NullReference : axis::ErrorId::None;
        return;
    }
    axis::AxisPort& port = axis.port();
    // After a machine stop the axis waits to see Enable low, though it is off already.
    const bool acknowledge = !Enable && port.view().needsEnableEdge && !port.view().machineStop;
    if (Enable != port.view().powerRequested || acknowledge) {
        axis::Command command;
        command.kind = Enable ? axis::CommandKind::PowerOn : axis::CommandKind::PowerOff;
        // Refused while the list is full or a machine stop bars it; the level asks again.
        static_cast<void>(port.submit(command));
    }
    const axis::AxisView& view = port.view();
    Status = view.powered;
    const bool failed = Enable && view.state == axis::AxisState::ErrorStop && !view.powered;
    const bool barred = Enable && !view.powered && (view.machineStop || view.needsEnableEdge);
    Error = failed || barred;
    ErrorID = axis::ErrorId::None;
    if (barred) ErrorID = axis::ErrorId::MachineStopped;
    if (failed) ErrorID = view.error.id;
    Valid = Enable && !Error && view.inputsValid;
}

void MC_Reset::operator()(axis::AxisRef axis) noexcept {
    const axis::CommandPhase phase = run(axis, []() noexcept {
        axis::Command command;
        command.kind = axis::CommandKind::Reset;
        return command;
    });
    Done = phase == axis::CommandPhase::Done;
}

}  // namespace takt::plcopen
