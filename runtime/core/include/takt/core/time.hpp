#pragma once

#include <chrono>
#include <cstdint>

namespace takt::core {

using Duration = std::chrono::nanoseconds;

/// The number of a bus cycle since the cyclic task began; the only time base of motion code.
using CycleNumber = std::uint64_t;

namespace detail {
struct HostTimeBase {
    using rep = std::int64_t;
    using period = std::nano;
    using duration = Duration;
};
struct TrueTimeBase {
    using rep = std::int64_t;
    using period = std::nano;
    using duration = Duration;
};
struct DcTimeBase {
    using rep = std::int64_t;
    using period = std::nano;
    using duration = Duration;
};
}  // namespace detail

/// A reading of the controller's own clock (virtual or CLOCK_MONOTONIC).
using HostTime = std::chrono::time_point<detail::HostTimeBase, Duration>;
/// The simulated world's time, which no clock inside that world shows exactly.
using TrueTime = std::chrono::time_point<detail::TrueTimeBase, Duration>;
/// EtherCAT system time, ns since 2000-01-01 00:00 UTC.
using DcTime = std::chrono::time_point<detail::DcTimeBase, Duration>;

}  // namespace takt::core
