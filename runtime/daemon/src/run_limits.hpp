#pragma once

#include <takt/core/time.hpp>

namespace takt::daemon {

/// How long the phases of a run may take, counted in cycles.
inline constexpr core::Duration OpTimeout = std::chrono::seconds{30};
inline constexpr core::Duration StopTimeout = std::chrono::seconds{10};
inline constexpr core::Duration QuickStopTime =
    std::chrono::seconds{1};  ///< for the drives, after StopTimeout
inline constexpr core::Duration InitTimeout = std::chrono::seconds{10};

}  // namespace takt::daemon
