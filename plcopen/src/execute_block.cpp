#include <takt/plcopen/execute_block.hpp>

namespace takt::plcopen {

using axis::CommandPhase;
using axis::ErrorId;

namespace {

constexpr bool pending(CommandPhase phase) noexcept {
    return phase == CommandPhase::Queued || phase == CommandPhase::Active;
}

}  // namespace

template <typename Ref, typename Command>
CommandPhase CommandBlock<Ref, Command>::show(bool edge) noexcept {
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

template <typename Ref, typename Command>
void CommandBlock<Ref, Command>::accept(const Ref& ref, const Accepted& accepted) noexcept {
    if (!accepted.ok()) {
        status_ = {CommandPhase::Error, accepted.error()};
        return;
    }
    ref_ = ref;
    id_ = accepted.value();
    status_ = ref.port().status(id_);
}

template <typename Ref, typename Command>
void CommandBlock<Ref, Command>::follow() noexcept {
    if (!ref_.valid()) {
        status_ = {CommandPhase::Error, ErrorId::NullReference};
        return;
    }
    status_ = ref_.port().status(id_);
    if (status_.phase == CommandPhase::Unknown) {
        status_ = {CommandPhase::Error, ErrorId::OutcomeUnknown};
    }
}

template class CommandBlock<axis::AxisRef, axis::Command>;
template class CommandBlock<axis::GroupRef, axis::GroupCommand>;

}  // namespace takt::plcopen
