#include <array>
#include <cmath>
#include <takt/plcopen/mc_path.hpp>

namespace takt::plcopen {

using axis::CommandId;
using axis::CommandPhase;
using axis::ErrorId;
using axis::GroupCommand;
using axis::GroupPort;
using axis::GroupRef;
using axis::GroupState;
using axis::GroupView;
using axis::RouteDesk;

namespace {

/// A buffered motion begins where the last one ends, any other where the group is.
bool isAtStart(const GroupView& view, bool waits, const axis::GroupPoint& start) noexcept {
    constexpr double Near = 1e-6;  // u: less than any drive resolves
    if (waits ? !view.endKnown : view.inMotion()) return false;
    const axis::GroupPoint& from = waits ? view.end : view.set;
    for (std::size_t i = 0; i < view.size(); ++i) {
        if (!(std::abs(start[i] - from[i]) <= Near)) return false;
    }
    return true;
}

}  // namespace

void MC_MovePath::operator()(GroupRef group, const MC_PATH_DATA_REF& path) noexcept {
    if (!Busy) ref_ = group;
    const CommandPhase phase =
        runWith(group, [this, &path](GroupPort& port, CommandId previous) noexcept {
            return submit(port, previous, path);
        });
    Done = showMotion(phase) == CommandPhase::Done;
    // The last segment is followed; the path is under way from the first on.
    if (Busy && ref_.valid()) Active = ref_.port().status(first_).phase != CommandPhase::Queued;
}

core::Result<CommandId, ErrorId> MC_MovePath::submit(GroupPort& port, CommandId previous,
                                                     const MC_PATH_DATA_REF& path) noexcept {
    if (BufferMode > MC_BUFFER_MODE::mcBuffered) return ErrorId::BlendingNotPossible;
    if (path.segments.empty()) return ErrorId::InvalidParameter;
    const GroupView& view = port.view();
    const bool waits = BufferMode == MC_BUFFER_MODE::mcBuffered && view.inMotion();
    if (!isAtStart(view, waits, path.start)) return ErrorId::NotAtPathStart;
    std::array<GroupCommand, axis::PathData::MaxSegments> commands;
    double corner = 0.0;
    for (std::size_t i = 0; i < path.segments.size(); ++i) {
        const axis::PathData::Segment& segment = path.segments[i];
        GroupCommand& command = commands[i];
        command = request(segment.kind, segment.point);
        command.arc = segment.arc;
        if (i == 0) {
            command.replaces = previous;
        } else if (corner > 0.0) {
            command.bufferMode = axis::BufferMode::BlendingHigh;
            command.transition = {axis::TransitionMode::CornerDistance, corner, {}};
        } else {
            command.bufferMode = axis::BufferMode::Buffered;
        }
        corner = segment.corner;
    }
    const auto ids = port.submit(std::span{commands}.first(path.segments.size()));
    if (!ids.ok()) return ids.error();
    first_ = ids.value().first;
    return ids.value().last;
}

void TK_PlanPath::operator()(GroupRef group, MC_PATH_DATA_REF& path) noexcept {
    const bool edge = Execute && !lastExecute_;
    lastExecute_ = Execute;
    if (edge) {
        ref_ = group;
        begin();
    } else if (!Busy && !Execute) {
        Done = false;
        fail(ErrorId::None);
    }
    if (Busy) follow(path);
}

void TK_PlanPath::fail(ErrorId error) noexcept {
    Error = error != ErrorId::None;
    ErrorID = error;
    Busy = false;
}

void TK_PlanPath::begin() noexcept {
    Done = false;
    KeepOut = 0;
    Duration = 0.0;
    ticket_ = RouteDesk::Ticket::None;
    fail(ErrorId::None);
    if (!ref_.valid()) return fail(ErrorId::NullReference);
    GroupPort& port = ref_.port();
    const GroupView& view = port.view();
    if (!port.routes().served()) return fail(ErrorId::ObstaclesMissing);
    if (view.size() == 0) return fail(ErrorId::GroupIncomplete);
    if (view.state == GroupState::Stopping && !view.stopDone) return fail(ErrorId::GroupLocked);
    if (view.inMotion() && !view.endKnown) return fail(ErrorId::InvalidState);
    order_ = {view.members, view.inMotion() ? view.end : view.set, Goal, Rounding, Seed};
    Busy = true;
}

void TK_PlanPath::follow(MC_PATH_DATA_REF& path) noexcept {
    if (!ref_.valid()) return fail(ErrorId::NullReference);
    RouteDesk& desk = ref_.port().routes();
    const core::CycleNumber now = ref_.port().view().cycle;
    if (ticket_ == RouteDesk::Ticket::None) {
        ticket_ = desk.ask(order_, now);  // another instance may be waiting for its answer
        return;
    }
    if (!desk.owns(ticket_)) return fail(ErrorId::OutcomeUnknown);
    const RouteDesk::Answer* const answer = desk.answer(now);
    if (answer == nullptr) return;
    fail(answer->error);
    KeepOut = answer->keepOut;
    Duration = answer->duration;
    if (Error) return;
    path = answer->path;
    Done = true;
}

}  // namespace takt::plcopen
