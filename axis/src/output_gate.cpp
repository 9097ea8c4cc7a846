#include <algorithm>
#include <cmath>
#include <limits>
#include <takt/axis/output_gate.hpp>

namespace takt::axis {

namespace {

/// A profile that runs at a limit meets it up to rounding only.
constexpr double kRelative = 1.0 + 1e-6;

/// Rounding of positions of this size, in a difference of differences.
double slack(double position) noexcept {
    return 8.0 * std::numeric_limits<double>::epsilon() * std::abs(position);
}

}  // namespace

OutputGate::OutputGate(const AxisTraits& traits, core::Duration cycle) noexcept {
    const double t = std::chrono::duration<double>(cycle).count();
    const LimitParams& l = traits.limits;
    const auto acceleration = std::max({l.acceleration, l.deceleration, l.stopDeceleration});
    maxPosition_ = traits.maxPosition.count();
    maxStep_ = l.velocity.count() * t * kRelative;
    maxChange_ = acceleration.count() * t * t * kRelative;
}

OutputGate::Verdict OutputGate::judge(core::Position candidate) const noexcept {
    const double value = candidate.count();
    if (!std::isfinite(value)) return Verdict::NotFinite;
    if (std::abs(value) > maxPosition_) return Verdict::OutOfRange;
    const double allowance = slack(value) + slack(last_.count());
    const double step = value - last_.count();
    if (std::abs(step) > maxStep_ + allowance) return Verdict::VelocityStep;
    if (std::abs(step - lastStep_.count()) > maxChange_ + allowance)
        return Verdict::AccelerationStep;
    return Verdict::Pass;
}

core::Position OutputGate::braked() const noexcept {
    const double step = lastStep_.count();
    const double slower = std::max(0.0, std::abs(step) - maxChange_ / kRelative);
    return last_ + core::Distance{step < 0.0 ? -slower : slower};
}

}  // namespace takt::axis
