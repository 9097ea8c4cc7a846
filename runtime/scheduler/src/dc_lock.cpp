#include <algorithm>
#include <cmath>
#include <takt/scheduler/dc_lock.hpp>

namespace takt::scheduler {

namespace {
/// Unlocked after so many cycles in a row with more than a quarter of a cycle of error.
constexpr std::uint32_t FarCyclesToUnlock = 3;
}  // namespace

DcLock::DcLock(const DcLockParams& params, core::Duration cycle) noexcept
    : params_{params}, cycle_{static_cast<double>(cycle.count())} {}

core::Duration DcLock::update(core::Duration phaseError) noexcept {
    lastError_ = phaseError;
    const auto error = static_cast<double>(phaseError.count());
    judge(error);

    const double limit = params_.maxCorrection * cycle_;
    integral_ = std::clamp(integral_ - params_.integral * error, -limit, limit);
    const double wanted =
        std::clamp(integral_ - params_.proportional * error, -limit, limit) + remainder_;
    const double whole = std::floor(wanted);
    remainder_ = wanted - whole;
    return core::Duration{static_cast<std::int64_t>(whole)};
}

core::Duration DcLock::coast() noexcept {
    const double wanted = integral_ + remainder_;
    const double whole = std::floor(wanted);
    remainder_ = wanted - whole;
    return core::Duration{static_cast<std::int64_t>(whole)};
}

double DcLock::driftPpm() const noexcept {
    return integral_ / cycle_ * 1e6;
}

void DcLock::judge(double error) noexcept {
    const double size = std::abs(error);
    const auto window = static_cast<double>(params_.window.count());
    goodCycles_ = size < window ? goodCycles_ + 1 : 0;
    farCycles_ = size > cycle_ / 4 ? farCycles_ + 1 : 0;
    if (!locked_ && goodCycles_ >= params_.windowCycles) locked_ = true;
    // A lock that was found is given up only for good reason: far off for several cycles.
    if (locked_ && farCycles_ >= FarCyclesToUnlock) {
        locked_ = false;
        ++relocks_;
    }
}

}  // namespace takt::scheduler
