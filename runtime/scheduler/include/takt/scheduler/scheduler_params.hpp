#pragma once

#include <cstdint>

#include <takt/core/time.hpp>

namespace takt::scheduler {

/// PI control of the wake-up against the reference clock; gains per cycle.
struct DcLockParams {
    double proportional{0.08};
    double integral{0.0008};
    double maxCorrection{0.01};                 ///< of the cycle, per cycle
    core::Duration window{std::chrono::microseconds{8}};  ///< locked below …
    std::uint32_t windowCycles{100};            ///< … for so many cycles
};

struct SchedulerParams {
    core::Duration cycle{std::chrono::milliseconds{1}};
    DcLockParams dcLock;
};

}  // namespace takt::scheduler
