#pragma once

#include <takt/planner/profile.hpp>

namespace takt::planner {

/// rt. The jerk with which a motion that is under way is taken over. To take its acceleration back
/// at jerk j changes its velocity by a^2 / (2 j); where that would pass a velocity limit, the jerk
/// is `limits.jerk` no longer but as much as it takes.
/// \param hardest no more than this, unless limits.jerk is; what the motion has come with is enough
/// \return limits.jerk where that will do; `hardest` where the velocity is past its limit already
[[nodiscard]] core::Jerk takeOverJerk(const State& from, const Limits& limits,
                                      core::Jerk hardest) noexcept;

}  // namespace takt::planner
