#pragma once

#include <takt/core/fixed_vector.hpp>

#include "extremal_curve.hpp"

namespace takt::planner::detail {

/// The least possible duration from a given one on, and the extremal profile that has it. Where
/// that given duration itself is possible, `extremal` is false: any profile of that length will do.
struct Possible {
    double duration;
    ExtremalCurve::Point point;
    bool mirrored;  ///< the profile belongs to the mirrored problem
    bool extremal;
    bool direct;  ///< one piece of full jerk
    bool found;
};

/// The fastest way to the target. \pre the start is viable (brakePosition)
[[nodiscard]] Possible fastest(const Problem& problem) noexcept;

/// The least possible duration >= notBefore.
[[nodiscard]] Possible firstPossible(const Problem& problem, double notBefore) noexcept;

/// Durations at which a target may begin or cease to be possible.
using Marks = core::FixedVector<double, 24>;

/// All crossings of both curves with the distance, and the ends of their blocks; in no order.
void marks(const Problem& problem, Marks& out) noexcept;

/// The profile of a fastest() or firstPossible() that is extremal.
void piecesOf(const Problem& problem, const Possible& possible, Pieces& out) noexcept;

/// A profile that takes exactly `duration`, which must be possible; false if it is not.
[[nodiscard]] bool lasting(const Problem& problem, double duration, Pieces& out) noexcept;

}  // namespace takt::planner::detail
