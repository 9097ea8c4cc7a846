#include <algorithm>
#include <takt/axis/following_error.hpp>

#include "cycles.hpp"

namespace takt::axis {

namespace {
constexpr std::size_t kBusDelay = 2;
}

FollowingError::FollowingError(const SupervisionParams& params, core::Duration cycle) noexcept
    : delay_{std::min<std::size_t>(kBusDelay + params.driveDelayCycles, History)},
      limit_{params.followingError},
      filter_{cyclesFor(params.followingErrorTime, cycle)} {}

void FollowingError::reset(core::Position set) noexcept {
    sets_.fill(set);
    aboveCycles_ = 0;
}

bool FollowingError::above(core::Distance lag) const noexcept {
    return limit_ > core::Distance{} && (lag > limit_ || lag < -limit_);
}

bool FollowingError::exceeded(core::Distance lag) noexcept {
    aboveCycles_ = above(lag) ? aboveCycles_ + 1 : 0;
    return aboveCycles_ > filter_;
}

}  // namespace takt::axis
