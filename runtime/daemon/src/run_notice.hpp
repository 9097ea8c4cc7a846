#pragma once

#include <cstdint>
#include <takt/core/spsc_ring.hpp>
#include <takt/core/time.hpp>

#include "machine_stop.hpp"

namespace takt::daemon {

/// Something a person should know, as it leaves the cycle: numbers only. RunReporter finds the
/// words.
struct RunNotice {
    enum class Kind : std::uint8_t {
        ReachedOp,      ///< `time`: since the first cycle
        NetworkFailed,  ///< while going to OP
        OpTimedOut,
        ProgramEnded,    ///< `index`: of the program
        AxisNotStopped,  ///< `index`: of the axis
        InitTimedOut,
        CycleMissed,    ///< the first one; `number`: grid points
        StoppedOnPath,  ///< too many missed cycles; `number`: in a row
        DrivesStopped,
        MachineStopped,  ///< `stop`
        MachineStopReset,
        MachineStopOverdue,  ///< `index`: of the axis
    };
    Kind kind{Kind::ReachedOp};
    std::size_t index{0};
    core::CycleNumber cycle{0};
    core::Duration time{0};
    std::uint64_t number{0};
    StopRecord stop{};
};

/// From the cycle to whoever prints.
using RunNotices = core::SpscRing<RunNotice>;

}  // namespace takt::daemon
