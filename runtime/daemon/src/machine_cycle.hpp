#pragma once

#include <cstdint>
#include <span>
#include <takt/core/clock_source.hpp>
#include <takt/fieldbus/ethercat/master.hpp>
#include <takt/scheduler/dc_lock.hpp>
#include <takt/scheduler/grid.hpp>

#include "axes.hpp"
#include "cycle_statistics.hpp"
#include "machine_control.hpp"
#include "program_host.hpp"
#include "recorders.hpp"

namespace takt::daemon {

/// One beat of the machine, from frame out to books (docs/architecture.md, "One cycle").
class MachineCycle {
public:
    struct Parts {
        fieldbus::ethercat::Master& master;
        Movers movers;
        std::span<ProgramHost> programs;
        scheduler::Grid& grid;
        scheduler::DcLock& dcLock;
        Recorders& recorders;
        MachineControl& control;
        core::ClockSource& clock;
        core::Duration length;  ///< of a cycle
    };
    explicit MachineCycle(const Parts& parts) noexcept : parts_{parts} {}

    /// rt. The whole cycle of one wake-up.
    void run(const scheduler::Beat& beat, const CycleOrders& orders) noexcept;

    [[nodiscard]] const CycleStatistics& statistics() const noexcept { return statistics_; }

private:
    void passOver(const scheduler::Beat& beat) noexcept;
    void followReferenceClock(const scheduler::Beat& beat) noexcept;
    void keepBooks(const scheduler::Beat& beat, core::HostTime replied,
                   core::HostTime computed) noexcept;

    Parts parts_;
    CycleStatistics statistics_;
    CyclePart longest_{CyclePart::Host};  ///< what made the last cycle too long; Host: it was not
};

}  // namespace takt::daemon
