#pragma once

#include <cstdint>
#include <takt/axis/axis_params.hpp>
#include <takt/core/units.hpp>

namespace takt::axis {

/// The one place where drive counts become user units and back.
///
/// Counts are 64 bit wide and unfolded, so that a wrap of the drive's 32-bit position is invisible
/// here. The ratio is kept as a reduced fraction and every conversion starts from the count, so
/// nothing adds up. A coordinate is (count - originCount) scaled, plus the origin's position.
class Scaling {
public:
    /// \throws std::invalid_argument when a number of the ratio or the modulo period is not
    /// positive
    explicit Scaling(const ScalingParams& params);

    /// rt. Error at most 1 ulp of the distance from the origin plus 1 ulp of the result.
    [[nodiscard]] core::Position toUnits(std::int64_t counts) const noexcept {
        return origin_ + toDistance(counts - originCounts_);
    }
    /// rt. A difference of counts as a distance (or, per second, a velocity).
    [[nodiscard]] core::Distance toDistance(std::int64_t counts) const noexcept {
        return core::Distance{static_cast<double>(counts) * unitsNumerator_ / countsNumerator_};
    }
    /// rt. The nearest count. \pre position is finite and |position| <= maxPosition() from the
    /// origin
    [[nodiscard]] std::int64_t toCounts(core::Position position) const noexcept {
        const double exact = (position - origin_).count() * countsNumerator_ / unitsNumerator_;
        return originCounts_ + static_cast<std::int64_t>(exact < 0.0 ? exact - 0.5 : exact + 0.5);
    }

    /// rt. From now on `counts` reads as `position`.
    void setOrigin(std::int64_t counts, core::Position position) noexcept {
        originCounts_ = counts;
        origin_ = position;
    }

    /// rt. The position folded into [0, period) on a modulo axis, unchanged on a linear one.
    [[nodiscard]] core::Position fold(core::Position position) const noexcept {
        return core::Position{foldInto(position.count(), period_)};
    }
    /// rt. Period of a modulo axis, 0 on a linear one.
    [[nodiscard]] core::Distance period() const noexcept { return core::Distance{period_}; }
    [[nodiscard]] bool modulo() const noexcept { return period_ > 0.0; }

    /// rt. Size of one count, always positive.
    [[nodiscard]] core::Distance resolution() const noexcept { return resolution_; }
    /// rt. Beyond this distance from 0 a double no longer tells single counts apart.
    [[nodiscard]] core::Distance maxPosition() const noexcept { return maxPosition_; }

    /// rt. `value` modulo `period` in [0, period); unchanged when period is 0.
    [[nodiscard]] static double foldInto(double value, double period) noexcept;

private:
    double countsNumerator_{1.0};  ///< signed: negative when reversed
    double unitsNumerator_{1.0};
    double period_{0.0};
    std::int64_t originCounts_{0};
    core::Position origin_{};
    core::Distance resolution_{};
    core::Distance maxPosition_{};
};

}  // namespace takt::axis
