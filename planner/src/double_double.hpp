#pragma once

#include "problem.hpp"

/// Sums of two doubles, good for some 30 digits: to measure what rounding has done to a profile.
/// Relies on a*b+c not being contracted.
namespace takt::planner::detail {

struct DoubleDouble {
    double high{0.0};
    double low{0.0};

    [[nodiscard]] double value() const noexcept { return high + low; }
};

/// Knuth's exact sum.
[[nodiscard]] inline DoubleDouble exactSum(double a, double b) noexcept {
    const double s = a + b;
    const double bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
}

/// Dekker's exact product; no overflow below 1e300.
[[nodiscard]] inline DoubleDouble exactProduct(double a, double b) noexcept {
    constexpr double split = 134217729.0;  // 2^27 + 1
    const double ca = split * a;
    const double cb = split * b;
    const double ah = ca - (ca - a);
    const double bh = cb - (cb - b);
    const double al = a - ah;
    const double bl = b - bh;
    const double p = a * b;
    return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

[[nodiscard]] inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) noexcept {
    const DoubleDouble s = exactSum(a.high, b.high);
    return exactSum(s.high, s.low + a.low + b.low);
}

[[nodiscard]] inline DoubleDouble operator*(DoubleDouble a, double b) noexcept {
    const DoubleDouble p = exactProduct(a.high, b);
    return exactSum(p.high, p.low + a.low * b);
}

/// Position from the start, velocity and acceleration without the rounding of a sum of pieces.
struct ExactState {
    DoubleDouble p, v, a;

    void advance(double time, double jerk) noexcept {
        const DoubleDouble jt = exactProduct(jerk, time);
        const DoubleDouble sixth =
            jt * (1.0 / 3.0);  // its rounding is 1e-16 of the jerk's share only
        p = p + (v + (a + sixth) * (0.5 * time)) * time;
        v = v + (a + jt * 0.5) * time;
        a = a + jt;
    }
};

}  // namespace takt::planner::detail
