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
    if (Enable != port.view().powerRequested) {
        axis::Command command;
        command.kind = Enable ? axis::CommandKind::PowerOn : axis::CommandKind::PowerOff;
        // A full list is the only refusal; the level asks again in the next cycle.
        static_cast<void>(port.submit(command));
    }
    const axis::AxisView& view = port.view();
    Status = view.powered;
    Error = Enable && view.state == axis::AxisState::ErrorStop && !view.powered;
    ErrorID = Error ? view.error.id : axis::ErrorId::None;
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
