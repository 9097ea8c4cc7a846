#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <takt/fieldbus/ethercat/master.hpp>
#include <takt/scheduler/dc_lock.hpp>
#include <takt/scheduler/grid.hpp>

#include "axes.hpp"
#include "machine_control.hpp"
#include "program_host.hpp"
#include "recorders.hpp"

namespace takt::daemon {

/// One beat of the machine, from frame out to books (docs/architecture.md, "One cycle").
class MachineCycle {
public:
    struct Parts {
        fieldbus::ethercat::Master& master;
        Axes& axes;
        std::span<ProgramHost> programs;
        scheduler::Grid& grid;
        scheduler::DcLock& dcLock;
        Recorders& recorders;
        MachineControl& control;
    };
    explicit MachineCycle(const Parts& parts) noexcept : parts_{parts} {}

    /// rt. The whole cycle of one wake-up.
    void run(const scheduler::Beat& beat, const CycleOrders& orders) noexcept;

    [[nodiscard]] std::uint64_t cycles() const noexcept { return cycles_; }
    [[nodiscard]] core::Duration worstPhaseError() const noexcept { return worstPhaseError_; }

private:
    void followReferenceClock(const scheduler::Beat& beat) noexcept;

    Parts parts_;
    std::uint64_t cycles_{0};
    core::Duration worstPhaseError_{0};  ///< while locked
};

}  // namespace takt::daemon
