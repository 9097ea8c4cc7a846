#pragma once

#include "ramp.hpp"

namespace takt::planner::detail {

/// The profiles that get farthest in each possible duration T: jerk + 0 - 0 - 0 +.
///
/// For a given T the reachable end positions form an interval, whose upper end pmax(T) these
/// profiles reach; the lower end is the same of the mirrored problem. A duration is possible if the
/// distance lies between the two, so every fastest profile lies on one of the two curves.
///
/// The curve has one parameter u: the rise time of the ramp with the higher `vz` ("main"), the
/// other ramp then has sqrt(u^2 + c). u < 0 are the profiles whose acceleration keeps its sign
/// between the two peaks. With dT/du >= 0 and H = dp/dT = vp + J u uo/2 (u, uo no more than A/J), H
/// falls and then rises along u < 0 and rises along u > 0. So p has at most one maximum and one
/// minimum, both at zeros of H, and all crossings with a distance can be bracketed for certain.
class ExtremalCurve {
public:
    /// A profile on the curve: parameter and time at constant velocity.
    struct Point {
        double u;
        double cruise;
        double duration;
        bool found;
        double shift{0.0};  ///< what one ramp takes longer to make up for rounded velocities
    };
    struct Value {
        double distance;
        double slope;  ///< of the distance, by u
        double duration;
    };

    explicit ExtremalCurve(const Problem& problem) noexcept;

    /// The least duration of the velocity problem; both curves meet there.
    [[nodiscard]] double begin() const noexcept { return hasLow_ ? main_.kt : high_; }
    /// Between the low and the high block no duration is possible, whatever the position.
    [[nodiscard]] bool hasGap() const noexcept { return hasLow_ && star_ > 0.0; }
    [[nodiscard]] bool hasLow() const noexcept { return hasLow_; }
    [[nodiscard]] double lowEnd() const noexcept { return -star_; }
    [[nodiscard]] double highBegin() const noexcept { return high_; }
    [[nodiscard]] double top() const noexcept { return top_; }
    [[nodiscard]] double topVelocity() const noexcept { return vtop_; }

    [[nodiscard]] Value at(double u) const noexcept;
    /// dp/dT
    [[nodiscard]] double rate(double u) const noexcept;
    /// What rounding may do to the distance at u, with the tolerance of the problem.
    [[nodiscard]] double tolerance(double u) const noexcept;

    /// At the beginning of a block, where two times must meet velocity and position at once: the
    /// profile at u if it goes by `distance` up to rounding of the given numbers, else not found.
    [[nodiscard]] Point meeting(double u, double distance) const noexcept;

    /// The profile that takes exactly `duration`; not found below the least duration and in the
    /// gap.
    [[nodiscard]] Point lasting(double duration) const noexcept;
    [[nodiscard]] double distance(const Point& point) const noexcept;

    /// The first profile from u on, within the low or high block, that goes by `distance`. \pre
    /// at(u) is short of it
    [[nodiscard]] Point crossingInLow(double u, double distance) const noexcept;
    [[nodiscard]] Point crossingInHigh(double u, double distance) const noexcept;
    /// Within [lo, hi], where the sign of at(u).distance - distance changes.
    [[nodiscard]] double root(double lo, double hi, double distance) const noexcept;
    /// The same where the distance may also fall; by halving.
    [[nodiscard]] double anyRoot(double lo, double hi, double distance) const noexcept;
    /// The zero of the rate in [lo, hi], whose ends have different signs of it.
    [[nodiscard]] double rateZero(double lo, double hi) const noexcept;
    /// Where the rate is least on [lo, hi], lo < hi <= 0.
    [[nodiscard]] double leastRate(double lo, double hi) const noexcept;

    [[nodiscard]] Point point(double u) const noexcept { return {u, 0.0, at(u).duration, true}; }
    /// The pieces of a profile on the curve; `sign` is -1 for the mirrored problem.
    void pieces(const Point& point, double sign, Pieces& out) const noexcept;

private:
    /// The other ramp, not the main one, has no first piece at u.
    [[nodiscard]] bool startsOther(double u) const noexcept {
        return std::fabs(u) == star_ && u > main_.kt;
    }
    [[nodiscard]] double rootBothHolding(double distance) const noexcept;
    [[nodiscard]] double bothHold() const noexcept;
    [[nodiscard]] double firstGuess(double lo, const Value& atLo, double hi, const Value& atHi,
                                    double distance) const noexcept;

    double jerk_, invJerk_;
    Ramp main_, other_;
    bool mainIsLast_;
    double c_;        ///< uo^2 - u^2
    double kt_, kd_;  ///< of both ramps
    double tolerance_;
    double vtop_;
    double star_{0.0};  ///< |u| below which the other ramp would begin beyond its start
    double high_{0.0};
    double top_{0.0};
    bool hasLow_{false};
};

}  // namespace takt::planner::detail
