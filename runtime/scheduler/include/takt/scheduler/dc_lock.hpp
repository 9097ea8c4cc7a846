#pragma once

#include <cstdint>
#include <takt/core/time.hpp>
#include <takt/scheduler/scheduler_params.hpp>

namespace takt::scheduler {

/// Keeps the controller's wake-ups on the grid of the segment's reference clock.
///
/// The reference clock runs free and the controller follows it, so the operating system's jitter
/// never enters a drive's clock. A PI controller turns the phase error of each cycle into a
/// correction of the next wake-up; its integral part learns the difference of the two clocks.
///
///     DcLock lock{params, cycle};
///     each cycle: grid.shift(lock.update(phaseError - lateness));
class DcLock {
public:
    DcLock(const DcLockParams& params, core::Duration cycle) noexcept;

    /// rt. One phase error: positive when the frame passed the reference too late. The caller takes
    /// the known lateness of its own wake-up off, so that only the clocks' difference is left.
    /// \return by how much the next wake-up must come later than one cycle (negative: earlier)
    core::Duration update(core::Duration phaseError) noexcept;

    /// rt. A cycle without a measurement: the learnt drift goes on.
    core::Duration coast() noexcept;

    [[nodiscard]] bool locked() const noexcept { return locked_; }
    /// Times the lock was lost after it had been found.
    [[nodiscard]] std::uint32_t relocks() const noexcept { return relocks_; }
    /// Learnt rate of the controller's clock against the reference, in parts per million; positive:
    /// fast.
    [[nodiscard]] double driftPpm() const noexcept;
    [[nodiscard]] core::Duration lastError() const noexcept { return lastError_; }

private:
    void judge(double error) noexcept;

    DcLockParams params_;
    double cycle_;           ///< ns
    double integral_{0.0};   ///< ns per cycle
    double remainder_{0.0};  ///< part of a nanosecond not yet given out
    std::uint32_t goodCycles_{0};
    std::uint32_t farCycles_{0};
    std::uint32_t relocks_{0};
    bool locked_{false};
    core::Duration lastError_{0};
};

}  // namespace takt::scheduler
