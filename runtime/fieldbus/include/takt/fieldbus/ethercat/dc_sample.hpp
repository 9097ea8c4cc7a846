#pragma once

#include <takt/core/time.hpp>

namespace takt::fieldbus::ethercat {

/// What one cycle's frame tells about the host's place on the SYNC0 grid.
struct DcSample {
    bool valid{false};             ///< the reference clock answered in this cycle
    core::HostTime sent{};         ///< when that frame left, by the host's clock
    core::DcTime referenceTime{};  ///< when the frame passed the reference clock
    /// > 0: the frame passed the reference later than the SYNC0 grid − sync0AfterSend; within ±T/2.
    core::Duration phaseError{0};
};

}  // namespace takt::fieldbus::ethercat
