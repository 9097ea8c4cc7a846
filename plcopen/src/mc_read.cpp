#include <takt/plcopen/mc_read.hpp>

namespace takt::plcopen {

using axis::AxisState;
using axis::AxisView;

const AxisView* ReadBlock::read(const axis::AxisRef& axis, bool needsInputs) noexcept {
    Valid = Busy = Error = false;
    ErrorID = axis::ErrorId::None;
    if (!Enable) {
        refused_ = false;
        return nullptr;
    }
    refused_ = refused_ || !axis.valid();
    if (refused_) {
        Error = true;
        ErrorID = axis::ErrorId::NullReference;
        return nullptr;
    }
    Busy = true;
    const AxisView& view = axis.port().view();
    // Recoverable: the block is ready again when the bus is.
    if (view.traits == nullptr || (needsInputs && !view.inputsValid)) return nullptr;
    Valid = true;
    return &view;
}

void MC_ReadStatus::operator()(axis::AxisRef axis) noexcept {
    const AxisView* const view = read(axis, false);
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
    const AxisView* const view = read(axis, true);
    Position = view != nullptr ? view->folded(view->actual).count() : 0.0;
}

void MC_ReadAxisError::operator()(axis::AxisRef axis) noexcept {
    const AxisView* const view = read(axis, false);
    AxisErrorID = 0;
    if (view == nullptr) return;
    ErrorID = view->error.id;
    AxisErrorID = view->error.driveError;
}

}  // namespace takt::plcopen
