#pragma once

#include <array>
#include <cstddef>
#include <takt/planner/path_element.hpp>

namespace takt::planner {

/// A contour in place of a corner: a polynomial of fifth degree that leaves one element and joins
/// the next with their positions, directions and curvatures, measured by its length.
///
/// Between two lines it is the cubic with both inner points in the corner,
/// corner - c (1-u)^3 q1' + c u^3 q2': the curve on which one axis may run down with constant jerk
/// while the other runs up.
class PathBlend {
public:
    /// The blend that leaves `before` at `reach` ahead of its end and joins `after` at `reach`
    /// behind its start. \pre both are longer than `reach` > 0 and have Cartesian motion, or both
    /// have none
    PathBlend(const PathElement& before, const PathElement& after, double reach) noexcept;

    /// rt. \pre 0 <= s <= length()
    void evaluate(double s, PathDerivatives& out) const noexcept;

    [[nodiscard]] double length() const noexcept { return length_; }
    [[nodiscard]] double reach() const noexcept { return reach_; }

private:
    static constexpr std::size_t kSpans = 32;

    PathSpace space_;
    PathPoint corner_;
    double reach_;
    double length_{0.0};
    /// Coefficients of u^0..u^5, from the corner.
    std::array<std::array<double, 6>, maxPathAxes> curve_{};
    /// u as polynomials of the share of a span of length: the inverse of the length. The spans are
    /// shorter where the contour turns.
    std::array<std::array<double, 6>, kSpans> parameter_{};
    std::array<double, kSpans + 1> starts_{};
};

/// How far from the corner the blend of this reach passes, or how far it is beside both elements
/// anywhere, if that is more: where they meet in one direction. Measured where the length is.
[[nodiscard]] double deviationOf(const PathElement& before, const PathElement& after,
                                 double reach) noexcept;

/// The reach, at most `most`, of the blend that passes the corner at `deviation`.
[[nodiscard]] double reachForDeviation(const PathElement& before, const PathElement& after,
                                       double deviation, double most) noexcept;

}  // namespace takt::planner
