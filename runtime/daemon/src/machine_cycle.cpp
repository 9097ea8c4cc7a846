#include "machine_cycle.hpp"

#include <algorithm>

#include <takt/core/cycle_guard.hpp>

namespace takt::daemon {

void MachineCycle::run(const scheduler::Beat& beat, const CycleOrders& orders) noexcept {
    const core::CycleGuard guard;
    parts_.master.exchange(beat.number);
    followReferenceClock(beat);
    for (axis::Axis& axis : parts_.axes) axis.readInputs(beat.number);
    parts_.control.beforePrograms(beat.number, orders);
    if (orders.runPrograms) {
        for (ProgramHost& program : parts_.programs) program.cycle(beat.number, parts_.axes);
    }
    parts_.control.afterPrograms(beat.number, orders);
    for (axis::Axis& axis : parts_.axes) axis.step();
    for (axis::Axis& axis : parts_.axes) axis.writeOutputs();
    parts_.master.prepare();
    parts_.recorders.row(beat.number, parts_.axes);
    parts_.control.publish(beat.number, orders);
    ++cycles_;
}

void MachineCycle::followReferenceClock(const scheduler::Beat& beat) noexcept {
    const fieldbus::ethercat::DcSample sample = parts_.master.dcSample();
    if (!sample.valid) {
        parts_.grid.shift(parts_.dcLock.coast());
        return;
    }
    // How late this wake-up came is known and no fault of the clocks.
    const core::Duration error = sample.phaseError - beat.lateness();
    parts_.grid.shift(parts_.dcLock.update(error));
    parts_.master.setClockLocked(parts_.dcLock.locked());
    if (parts_.dcLock.locked()) {
        worstPhaseError_ = std::max(worstPhaseError_, std::chrono::abs(error));
    }
}

}  // namespace takt::daemon
