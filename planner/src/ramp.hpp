#pragma once

#include "problem.hpp"

namespace takt::planner::detail {

/// The way between a state (v, a) and (vp, 0) that first raises the acceleration by full jerk,
/// holds it at its limit if it gets there, and takes it back to zero by full jerk.
///
/// Prolonged backwards to a = 0 it begins at velocity `vz` and is symmetric: with w = vp - vz and
/// s(w) its whole time,
///     s = 2 sqrt(w/J)  while the limit is not reached,  s = w/A + A/J  above,
///     time = s - kt,   distance = (vz + vp)/2 s - kd.
/// Time reversal turns the ramp that ends a move into one of these as well (a -> -a).
struct Ramp {
    double vz;    ///< virtual velocity at a = 0 before the start
    double kt;    ///< virtual time from there to the start, negative if a < 0
    double kd;    ///< virtual distance from there to the start
    double cap;   ///< greatest acceleration A
    double full;  ///< A/J, the time to reach it

    Ramp(double v, double a, double limit, double jerk, double invJerk) noexcept
        : vz{v - 0.5 * a * a * invJerk},
          kt{a * invJerk},
          kd{kt * (vz + jerk * kt * kt * (1.0 / 6.0))},
          cap{a > limit ? a : limit},
          full{cap * invJerk} {}

    /// The velocity at which a crosses zero when it is taken there directly: the least vp of this
    /// ramp.
    [[nodiscard]] double direct(double jerk) const noexcept {
        return kt > 0.0 ? vz + jerk * kt * kt : vz;
    }
};

/// A ramp to one velocity: rise time of the acceleration, time at the limit.
struct RampTimes {
    double rise;
    double hold;
};

[[nodiscard]] inline RampTimes timesFor(const Ramp& ramp, double w, double invJerk) noexcept {
    const double positive = w > 0.0 ? w : 0.0;
    const double most = ramp.cap * ramp.full;
    if (positive > most) return {ramp.full, (positive - most) / ramp.cap};
    return {std::sqrt(positive * invJerk), 0.0};
}

}  // namespace takt::planner::detail
