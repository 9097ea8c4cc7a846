#pragma once

#include <cstdint>
#include <takt/axis/axis_view.hpp>
#include <takt/core/time.hpp>
#include <takt/core/units.hpp>

namespace takt::axis {

/// The last check before a set-point becomes a target (fault F26). Whatever computed the value, it
/// leaves only when it is finite, expressible in counts, and within the axis' velocity and
/// acceleration against the two set-points before it.
class OutputGate {
public:
    enum class Verdict : std::uint8_t {
        Pass,
        NotFinite,
        OutOfRange,
        VelocityStep,
        AccelerationStep
    };

    OutputGate(const AxisTraits& traits, core::Duration cycle) noexcept;

    /// rt. The drive does not follow: the next set-point is compared with standing at `position`.
    void prime(core::Position position) noexcept {
        last_ = position;
        lastStep_ = core::Distance{};
    }
    /// rt. Judges without remembering.
    [[nodiscard]] Verdict judge(core::Position candidate) const noexcept;
    /// rt. The candidate leaves. \pre judge(candidate) == Pass
    void accept(core::Position candidate) noexcept {
        lastStep_ = candidate - last_;
        last_ = candidate;
    }
    /// rt. The set-point of a plain ramp to standstill from the last two; always passes.
    [[nodiscard]] core::Position braked() const noexcept;

    [[nodiscard]] core::Position last() const noexcept { return last_; }
    [[nodiscard]] core::Distance lastStep() const noexcept { return lastStep_; }

private:
    double maxPosition_;
    double maxStep_;    ///< per cycle
    double maxChange_;  ///< of the step, per cycle
    core::Position last_{};
    core::Distance lastStep_{};
};

}  // namespace takt::axis
