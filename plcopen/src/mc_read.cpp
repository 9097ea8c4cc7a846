#include <takt/plcopen/mc_read.hpp>

namespace takt::plcopen {

using axis::AxisState;
using axis::AxisView;

bool ReadBlock::begin(bool valid) noexcept {
    Valid = Busy = Error = false;
    ErrorID = axis::ErrorId::None;
    if (!Enable) {
        refused_ = axis::ErrorId::None;
        return false;
    }
    if (!valid && refused_ == axis::ErrorId::None) refused_ = axis::ErrorId::NullReference;
    if (refused_ != axis::ErrorId::None) {
        refuse(refused_);
        return false;
    }
    Busy = true;
    return true;
}

void ReadBlock::refuse(axis::ErrorId error) noexcept {
    refused_ = error;
    Valid = Busy = false;
    Error = true;
    ErrorID = error;
}

void MC_ReadStatus::operator()(axis::AxisRef axis) noexcept {
    const AxisView* const view = read(axis, [](const AxisView&) noexcept { return true; });
    const auto is = [view](AxisState state) { return view != nullptr && view->state == state; };
    ErrorStop = is(AxisState::ErrorStop);
    Disabled = is(AxisState::Disabled);
    Stopping = is(AxisState::Stopping);
    Homing = is(AxisState::Homing);
    Standstill = is(AxisState::Standstill);
    DiscreteMotion = is(AxisState::DiscreteMotion);
    ContinuousMotion = is(AxisState::ContinuousMotion);
    SynchronizedMotion = is(AxisState::SynchronizedMotion);
}

void MC_ReadActualPosition::operator()(axis::AxisRef axis) noexcept {
    const AxisView* const view =
        read(axis, [](const AxisView& seen) noexcept { return seen.inputsValid; });
    Position = view != nullptr ? view->folded(view->actual).count() : 0.0;
}

void MC_ReadAxisError::operator()(axis::AxisRef axis) noexcept {
    const AxisView* const view = read(axis, [](const AxisView&) noexcept { return true; });
    AxisErrorID = 0;
    if (view == nullptr) return;
    ErrorID = view->error.id;
    AxisErrorID = view->error.driveError;
}

}  // namespace takt::plcopen
