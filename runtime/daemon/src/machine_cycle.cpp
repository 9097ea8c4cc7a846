#include "machine_cycle.hpp"

#include <algorithm>
#include <takt/core/cycle_guard.hpp>

namespace takt::daemon {

void MachineCycle::run(const scheduler::Beat& beat, const CycleOrders& orders) noexcept {
    const core::CycleGuard guard;
    parts_.master.exchange(beat.number);
    const core::HostTime replied = parts_.clock.now();
    followReferenceClock(beat);
    if (beat.skipped > 0) passOver(beat);
    const Movers& movers = parts_.movers;
    for (axis::Axis& axis : movers.axes) axis.readInputs(beat.number);
    for (axis::Group& group : movers.groups) group.readMembers(beat.number);
    parts_.control.beforePrograms(beat.number, orders);
    if (orders.runPrograms) {
        for (ProgramHost& program : parts_.programs) program.cycle(beat.number, movers);
    }
    parts_.control.afterPrograms(beat.number, orders);
    const core::HostTime computed = parts_.clock.now();
    for (axis::Group& group : movers.groups) group.step();
    for (axis::Axis& axis : movers.axes) axis.step();
    for (axis::Axis& axis : movers.axes) axis.writeOutputs();
    parts_.master.prepare();
    parts_.recorders.row(beat.number, movers);
    parts_.control.publish(beat.number, orders);
    keepBooks(beat, replied, computed);
}

/// Lost set-points are those of the cycles that were missed, so they come before this one's inputs.
void MachineCycle::passOver(const scheduler::Beat& beat) noexcept {
    const Movers& movers = parts_.movers;
    for (std::uint32_t i = beat.madeUpFor; i > 0; --i) {
        for (axis::Group& group : movers.groups) group.missCycle();
        for (axis::Axis& axis : movers.axes) axis.missCycle();
        parts_.recorders.row(beat.number - i, movers);
    }
    for (axis::Axis& axis : movers.axes) axis.standFor(beat.skipped - beat.madeUpFor);
}

void MachineCycle::followReferenceClock(const scheduler::Beat& beat) noexcept {
    const fieldbus::ethercat::DcSample sample = parts_.master.dcSample();
    if (!sample.valid) {
        parts_.grid.shift(parts_.dcLock.coast());
        return;
    }
    // How late the frame left is known and no fault of the clocks. The difference of two phases is
    // one.
    const core::Duration half = parts_.length / 2;
    core::Duration error = (sample.phaseError - (sample.sent - beat.planned)) % parts_.length;
    if (error > half) error -= parts_.length;
    if (error <= -half) error += parts_.length;
    parts_.grid.shift(parts_.dcLock.update(error));
    parts_.master.setClockLocked(parts_.dcLock.locked());
    if (parts_.dcLock.locked()) {
        statistics_.phaseError.add(std::chrono::abs(error).count());
    }
}

void MachineCycle::keepBooks(const scheduler::Beat& beat, core::HostTime replied,
                             core::HostTime computed) noexcept {
    const core::HostTime done = parts_.clock.now();
    statistics_.lateness.add(beat.lateness().count());
    statistics_.reply.add((replied - beat.woke).count());
    statistics_.execution.add((done - beat.woke).count());
    if (beat.skipped > 0) ++statistics_.missedBy[static_cast<std::size_t>(longest_)];
    longest_ = CyclePart::Host;
    if (done - beat.woke <= parts_.length) return;
    const core::Duration bus = replied - beat.woke;
    const core::Duration programs = computed - replied;
    const core::Duration axes = done - computed;
    longest_ = programs > bus ? CyclePart::Programs : CyclePart::Bus;
    if (axes > std::max(bus, programs)) longest_ = CyclePart::Motion;
}

}  // namespace takt::daemon
