#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

/// One axis as bare numbers. The mathematics below is homogeneous in length and time: no absolute
/// tolerance, so metres, millimetres and counts give the same answer.
namespace takt::planner::detail {

inline constexpr double kEps = std::numeric_limits<double>::epsilon();

/// How far, relative to the limit, a state may lie beyond it and still count as on it: what the
/// rounding of a sampled state does.
inline constexpr double kClip = 1e-12;

/// A move by `distance` between two states of velocity and acceleration, whose starting point is
/// the origin.
struct Problem {
    double v0, a0, vf, af;
    double distance;
    double vmax, vmin, amax, amin;
    double jerk;
    /// Absolute position error that the rounding of the given positions already contains.
    double tolerance;
    /// How near to the target counts as there, if no more than the accelerations is left to change.
    double nearDistance;
    double nearVelocity;
};

/// Signs of everything swapped: the least position of a problem is the greatest of its mirror
/// image.
[[nodiscard]] inline Problem mirrored(const Problem& p) noexcept {
    return {-p.v0,   -p.a0,   -p.vf,  -p.af,       -p.distance,    -p.vmin,       -p.vmax,
            -p.amin, -p.amax, p.jerk, p.tolerance, p.nearDistance, p.nearVelocity};
}

/// Up to `capacity` pieces of constant jerk (third order) or constant acceleration (second order).
struct Pieces {
    static constexpr std::size_t capacity = 20;

    std::array<double, capacity> time;
    std::array<double, capacity> value;
    std::size_t size{0};

    /// Pieces of no length are left out; negative lengths are rounding.
    void add(double duration, double what) noexcept {
        if (!(duration > 0.0)) return;
        time[size] = duration;
        value[size] = what;
        ++size;
    }
    /// Puts a piece before the one at `index`. \pre size < capacity
    void insert(std::size_t index, double duration, double what) noexcept {
        for (std::size_t i = size; i > index; --i) {
            time[i] = time[i - 1];
            value[i] = value[i - 1];
        }
        time[index] = duration;
        value[index] = what;
        ++size;
    }
    void add(const Pieces& other) noexcept {
        for (std::size_t i = 0; i < other.size; ++i) add(other.time[i], other.value[i]);
    }
};

}  // namespace takt::planner::detail
