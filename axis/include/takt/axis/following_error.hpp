#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <takt/axis/axis_params.hpp>
#include <takt/core/time.hpp>
#include <takt/core/units.hpp>

namespace takt::axis {

/// Following error, compensated for the way of data: a set-point of cycle k leaves at the start of
/// k + 1, is used at SYNC0 of k + 1, and the position latched there arrives with the frame of k +
/// 2; the drive's own delay comes on top.
class FollowingError {
public:
    static constexpr std::size_t History = 32;  ///< longest delay in cycles, the bus' two included

    FollowingError(const SupervisionParams& params, core::Duration cycle) noexcept;

    /// rt. The axis stands at `set`, as if it had for ever.
    void reset(core::Position set) noexcept;
    /// rt. Once a cycle, after the set-point of the cycle is known.
    void push(core::Position set) noexcept {
        newest_ = (newest_ + 1) % History;
        sets_[newest_] = set;
    }
    /// rt. Before push(): the set-point that the actual position of this cycle answers, minus the
    /// actual one.
    [[nodiscard]] core::Distance lag(core::Position actual) const noexcept {
        return sets_[(newest_ + History + 1 - delay_) % History] - actual;
    }
    /// rt. Once a cycle. \return true when the lag has been above the limit for longer than the
    /// filter time
    [[nodiscard]] bool exceeded(core::Distance lag) noexcept;
    [[nodiscard]] core::Distance limit() const noexcept { return limit_; }
    /// rt. The lag is above the limit now; false when supervision is off.
    [[nodiscard]] bool above(core::Distance lag) const noexcept;

private:
    std::array<core::Position, History> sets_{};
    std::size_t newest_{0};
    std::size_t delay_;
    core::Distance limit_;
    std::uint32_t filter_;
    std::uint32_t aboveCycles_{0};
};

}  // namespace takt::axis
