#pragma once

#include <span>
#include <vector>

#include "banded.hpp"
#include "section.hpp"

namespace takt::planner::detail {

/// The fastest feed x(s) on a section by an interior-point method: Newton steps on the duration
/// plus a barrier in front of every limit. All limits are linear in the coefficients but the jerk's
/// |L(x, x', x'')| <= J / sqrt(x), whose right side is replaced by its tangent at the present
/// iterate. It lies below the curve, so every iterate keeps all limits, and the duration falls.
/// The matrix has five diagonals: a step costs as much as looking at all limits once.
///
/// Not to be trusted blindly: what comes out is checked by differences afterwards.
class BarrierSolver {
public:
    /// \return false if no feed within the limits was found, which from rest never happens
    [[nodiscard]] bool solve(const Section& section, const Grid& grid, const Rows& rows);

    [[nodiscard]] std::span<const double> coefficients() const noexcept { return c_; }
    [[nodiscard]] int steps() const noexcept { return steps_; }

private:
    /// How far a limit is used: 1 at the limit.
    [[nodiscard]] double greatestUse(std::span<const double> c) const noexcept;
    void tieEnds(std::span<double> c) const noexcept;
    void start() noexcept;
    void startFromRest() noexcept;
    void startInMotion() noexcept;

    /// Gradient and matrix at the present coefficients. `relax` multiplies all limits.
    void assemble(double objective, double barrier, double relax) noexcept;
    void addRow(const Row& row, double objective, double barrier, double relax) noexcept;
    void foldEnds() noexcept;
    [[nodiscard]] double slope() const noexcept;
    /// The greatest part of the step that stays within relaxed limits.
    [[nodiscard]] double reach(double relax, double relaxStep) const noexcept;
    [[nodiscard]] bool inside(const Row& row, std::span<const double> c,
                              double relax) const noexcept;
    void move(double part) noexcept;

    [[nodiscard]] bool findInside() noexcept;
    [[nodiscard]] bool improve() noexcept;
    [[nodiscard]] double duration() const noexcept;

    const Section* section_{nullptr};
    const Grid* grid_{nullptr};
    const Rows* rows_{nullptr};
    std::size_t first_{0};
    std::size_t last_{0};
    double headTie_{1.0};  ///< c[1] / c[0] where the section begins at rest
    double tailTie_{1.0};
    double limitCount_{0.0};
    int steps_{0};

    std::vector<double> c_;
    std::vector<double> step_;
    std::vector<double> gradient_;
    std::vector<double> relaxColumn_;
    double relaxGradient_{0.0};
    double relaxCurvature_{0.0};
    Pentadiagonal matrix_;
    std::vector<double> trial_;
};

}  // namespace takt::planner::detail
