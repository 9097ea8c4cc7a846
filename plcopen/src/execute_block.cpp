#include <takt/plcopen/execute_block.hpp>

namespace takt::plcopen {

using axis::CommandPhase;
using axis::ErrorId;

namespace {

constexpr bool pending(CommandPhase phase) noexcept {
    return phase == CommandPhase::Queued || phase == CommandPhase::Active;
}

}  // namespace

CommandPhase ExecuteBlock::show(bool edge) noexcept {
    pending_ = pending(status_.phase);
    // An end that has been shown goes with Execute; one that comes later is shown for one call.
    if (!pending_) {
        if (!edge && shown_ && !Execute) status_ = {};
        shown_ = status_.phase != CommandPhase::Unknown;
    } else {
        shown_ = false;
    }
    lastExecute_ = Execute;

    Busy = pending_;
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

}  // namespace takt::plcopen
