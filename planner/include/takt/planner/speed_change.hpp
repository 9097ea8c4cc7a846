#pragma once

/// Changes of velocity with zero acceleration at both ends, jerk-limited. Plain numbers in user
/// units and seconds, positive in the direction of travel.
namespace takt::planner {

/// What a change of velocity may use.
struct RampLimits {
    double acceleration;
    double jerk;
};

/// rt. The way from velocity `from` to `to`.
[[nodiscard]] double rampDistance(double from, double to, const RampLimits& limits) noexcept;

/// rt. The largest velocity, `cap` at most, that lies no more than `distance` from velocity
/// `other`: what can be reached from it, or what can be braked down to it. `cap` where it is below
/// `other`; 0 where not even standing still will do.
[[nodiscard]] double fastestWithin(double distance, double other, double cap,
                                   const RampLimits& limits) noexcept;

}  // namespace takt::planner
