#include "axis_station.hpp"

#include <cmath>
#include <utility>

namespace takt::daemon {

using axis::AxisState;
using axis::ErrorId;

bool AxisStation::begin(const ControlCommand& command) noexcept {
    if (running_ && command.order != Order::PowerOff) return false;
    if (running_) superseded_ = task_.ticket;
    release();
    task_ = command;
    running_ = fresh_ = true;
    prepare(command);
    return true;
}

void AxisStation::prepare(const ControlCommand& command) noexcept {
    if (command.order == Order::Inch) {
        inch_.Distance = std::abs(command.distance);
        inch_.Velocity = command.velocity;
        inch_.InchForward = command.distance > 0.0;
        inch_.InchBackward = !inch_.InchForward;
    }
    home_.Execute = command.order == Order::Home;
    reset_.Execute = command.order == Order::Reset;
}

void AxisStation::release() noexcept {
    inch_.InchForward = inch_.InchBackward = false;
    home_.Execute = reset_.Execute = false;
}

void AxisStation::letGo() noexcept {
    if (!moves()) return;
    if (task_.order == Order::Home) stop_.Execute = true;
    release();
}

std::optional<ControlAnswer> AxisStation::cycle(axis::Axis& axis) noexcept {
    axis.openPort(port_);
    const Progress progress = call();
    stopHoming();
    axis.takeCommands(port_);
    if (!running_) return std::nullopt;
    if (superseded_ != 0) {
        const std::uint64_t ticket = std::exchange(superseded_, 0);
        return ControlAnswer{
            .ticket = ticket, .cycle = port_.view().cycle, .kind = AnswerKind::Aborted};
    }

    ControlAnswer answer;
    answer.ticket = task_.ticket;
    answer.cycle = port_.view().cycle;
    answer.error = progress.id;
    const bool over = progress.error || progress.aborted || progress.done;
    if (fresh_ && progress.error) {
        answer.kind = AnswerKind::Refused;
        answer.refusal = Refusal::Block;
    } else if (over) {
        answer.kind = AnswerKind::Done;
        if (progress.aborted) answer.kind = AnswerKind::Aborted;
        if (progress.error) answer.kind = AnswerKind::Failed;
    } else if (!fresh_) {
        return std::nullopt;
    }
    fresh_ = false;
    if (over) {
        running_ = false;
        release();
    }
    return answer;
}

template <typename Block>
AxisStation::Progress AxisStation::progressOf(const Block& block) noexcept {
    Progress progress{.error = block.Error, .done = block.Done, .id = block.ErrorID};
    if constexpr (requires { block.CommandAborted; }) progress.aborted = block.CommandAborted;
    return progress;
}

AxisStation::Progress AxisStation::call() noexcept {
    // All are called in every cycle, so that each sees its button released.
    inch_(ref_);
    home_(ref_);
    reset_(ref_);
    if (!running_) return {};
    switch (task_.order) {
        case Order::PowerOn:
            return callPower(true);
        case Order::PowerOff:
            return callPower(false);
        case Order::Reset:
            return progressOf(reset_);
        case Order::Home:
            return progressOf(home_);
        case Order::Inch:
            return progressOf(inch_);
        case Order::Heartbeat:
        case Order::Leave:
        case Order::Halt:
        case Order::MachineStop:
        case Order::ResetStop:
        case Order::ProgramStart:
        case Order::ProgramStop:
        case Order::ProgramReset:
        case Order::Upload:
        case Order::Download:
            break;
    }
    return {.done = true};
}

AxisStation::Progress AxisStation::callPower(bool on) noexcept {
    const axis::AxisView& view = port_.view();
    if (!on) {
        axis::Command off;
        off.kind = axis::CommandKind::PowerOff;
        if (view.powerRequested) static_cast<void>(port_.submit(off));
        return {.done = !view.powered};
    }
    if (view.state == AxisState::ErrorStop) return {.error = true, .id = ErrorId::AxisInErrorStop};
    if (fresh_) {
        // The operator's word is the new edge that a machine stop asks for.
        axis::Command edge;
        edge.kind = axis::CommandKind::PowerOff;
        if (view.needsEnableEdge && !view.powerRequested) static_cast<void>(port_.submit(edge));
        axis::Command command;
        command.kind = axis::CommandKind::PowerOn;
        const auto accepted = port_.submit(command);
        if (!accepted.ok()) return {.error = true, .id = accepted.error()};
    }
    if (view.machineStop) return {.error = true, .id = ErrorId::MachineStopped};
    if (!view.powerRequested) return {.aborted = true};
    return {.done = view.powered && view.state != AxisState::Disabled};
}

/// A homing is the drive's own motion: it ends by MC_Stop, which holds the axis until it rests.
void AxisStation::stopHoming() noexcept {
    const bool wasStopping = stop_.Execute;
    stop_(ref_);
    if (wasStopping && (stop_.Done || stop_.Error || stop_.CommandAborted)) stop_.Execute = false;
}

}  // namespace takt::daemon
