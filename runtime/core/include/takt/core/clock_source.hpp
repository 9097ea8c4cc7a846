#pragma once

#include <takt/core/time.hpp>

namespace takt::core {

/// The one place where the runtime reads time. Implemented by the twin's host clock (virtual time)
/// and by the monotonic clock of the machine.
class ClockSource {
public:
    virtual ~ClockSource() = default;

    /// rt.
    [[nodiscard]] virtual HostTime now() const noexcept = 0;
    /// rt. Returns at or after `wake`; at once when `wake` has passed.
    virtual void sleepUntil(HostTime wake) noexcept = 0;
};

}  // namespace takt::core
