#include <takt/scheduler/overrun_guard.hpp>

namespace takt::scheduler {

OverrunVerdict OverrunGuard::update(std::uint32_t skipped) noexcept {
    overruns_ += skipped > 0 ? 1 : 0;
    skipped_ += skipped;
    inRow_ = skipped > 0 ? inRow_ + skipped : 0;
    const bool rateExceeded = tooMany(skipped);
    if (params_.policy == OverrunPolicy::Count) return OverrunVerdict::Fine;
    if (inRow_ >= params_.driveStopAfter) return OverrunVerdict::DriveStop;
    return inRow_ >= params_.stopAfter || rateExceeded ? OverrunVerdict::StopOnPath
                                                       : OverrunVerdict::Fine;
}

/// Of the stretch of cycles that is being counted; a new stretch begins every RateWindow.
bool OverrunGuard::tooMany(std::uint32_t skipped) noexcept {
    if (windowCycles_ >= RateWindow) windowCycles_ = windowSkipped_ = 0;
    windowCycles_ += 1 + skipped;
    windowSkipped_ += skipped;
    return static_cast<double>(windowSkipped_) > params_.rate * RateWindow;
}

}  // namespace takt::scheduler
