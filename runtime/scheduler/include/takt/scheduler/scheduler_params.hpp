#pragma once

#include <cstdint>
#include <takt/core/time.hpp>

namespace takt::scheduler {

/// PI control of the wake-up against the reference clock; gains per cycle.
struct DcLockParams {
    double proportional{0.08};
    double integral{0.0008};
    double maxCorrection{0.01};                           ///< of the cycle, per cycle
    core::Duration window{std::chrono::microseconds{8}};  ///< locked below …
    std::uint32_t windowCycles{100};                      ///< … for so many cycles
};

/// What is done about cycles that were missed. Counts are grid points that passed unused.
enum class OverrunPolicy : std::uint8_t {
    React,  ///< stop the machine as below
    Count,  ///< count and go on: for computers that cannot keep time, such as those that run tests
};

struct OverrunParams {
    OverrunPolicy policy{OverrunPolicy::React};
    std::uint32_t stopAfter{3};        ///< in a row: stop on path
    std::uint32_t driveStopAfter{10};  ///< in a row: the drives stop by themselves
    double rate{0.01};                 ///< share of the last 1000 cycles: stop on path
};

struct SchedulerParams {
    core::Duration cycle{std::chrono::milliseconds{1}};
    DcLockParams dcLock;
    OverrunParams overruns;
    int priority{80};  ///< SCHED_FIFO of the cycle; its programs run one below. 0 = none
    int cpu{-1};       ///< the processor of cycle and programs; -1 = any
};

}  // namespace takt::scheduler
