#include <takt/plcopen/mc_group_read.hpp>

namespace takt::plcopen {

using axis::GroupState;
using axis::GroupView;

void MC_GroupReadStatus::operator()(axis::GroupRef group) noexcept {
    const GroupView* const view = read(group, [](const GroupView&) noexcept { return true; });
    const auto is = [view](GroupState state) { return view != nullptr && view->state == state; };
    GroupMoving = is(GroupState::Moving);
    GroupHoming = is(GroupState::Homing);
    GroupErrorStop = is(GroupState::ErrorStop);
    GroupStandby = is(GroupState::Standby);
    GroupStopping = is(GroupState::Stopping);
    GroupDisabled = is(GroupState::Disabled);
}

void MC_GroupReadActualPosition::operator()(axis::GroupRef group) noexcept {
    const GroupView* view =
        read(group, [](const GroupView& seen) noexcept { return seen.actualValid; });
    if (CoordSystem != MC_COORD_SYSTEM::mcACS && CoordSystem != MC_COORD_SYSTEM::mcMCS && Enable) {
        refuse(axis::ErrorId::CoordSystemNotSupported);
        view = nullptr;
    }
    Position.fill(0.0);
    if (view == nullptr) return;
    for (std::size_t i = 0; i < view->size(); ++i) {
        if (view->members[i] != nullptr) Position[i] = view->actual[i];
    }
}

void MC_GroupReadError::operator()(axis::GroupRef group) noexcept {
    const GroupView* const view = read(group, [](const GroupView&) noexcept { return true; });
    if (view != nullptr) ErrorID = view->error.id;
}

}  // namespace takt::plcopen
