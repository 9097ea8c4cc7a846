#include <takt/plcopen/execute_block.hpp>

namespace takt::plcopen {

using axis::CommandPhase;
using axis::ErrorId;

namespace {

constexpr bool pending(CommandPhase phase) noexcept {
    return phase == CommandPhase::Queued || phase == CommandPhase::Active;
}

}  // namespace

CommandPhase ExecuteBlock::run(axis::AxisRef axis, const axis::Command& request) noexcept {
    const bool edge = Execute && !lastExecute_;
    if (edge) {
        start(axis, request);
    } else if (pending(status_.phase)) {
        follow();
    }
    // An end that has been shown goes with Execute; one that comes later is shown for one call.
    if (!pending(status_.phase)) {
        if (!edge && shown_ && !Execute) status_ = {};
        shown_ = status_.phase != CommandPhase::Unknown;
    } else {
        shown_ = false;
    }
    lastExecute_ = Execute;

    Busy = pending(status_.phase);
    Error = status_.phase == CommandPhase::Error;
    ErrorID = Error ? status_.error : ErrorId::None;
    return status_.phase;
}

void ExecuteBlock::start(const axis::AxisRef& axis, const axis::Command& request) noexcept {
    if (!axis.valid()) {
        status_ = {CommandPhase::Error, ErrorId::NullReference};
        return;
    }
    axis::Command command = request;
    command.replaces = id_;
    const auto accepted = axis.port().submit(command);
    if (!accepted.ok()) {
        status_ = {CommandPhase::Error, accepted.error()};
        return;
    }
    axis_ = axis;
    id_ = accepted.value();
    status_ = axis.port().status(id_);
}

void ExecuteBlock::follow() noexcept {
    if (!axis_.valid()) {
        status_ = {CommandPhase::Error, ErrorId::NullReference};
        return;
    }
    status_ = axis_.port().status(id_);
    if (status_.phase == CommandPhase::Unknown) {
        status_ = {CommandPhase::Error, ErrorId::OutcomeUnknown};
    }
}

CommandPhase MotionBlock::runMotion(axis::AxisRef axis, const axis::Command& request) noexcept {
    const CommandPhase phase = run(axis, request);
    Active = phase == CommandPhase::Active;
    CommandAborted = phase == CommandPhase::Aborted;
    return phase;
}

}  // namespace takt::plcopen
