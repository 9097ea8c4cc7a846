#pragma once

#include <span>
#include <vector>

#include "banded.hpp"
#include "section.hpp"

namespace takt::planner::detail {

/// The fastest feed x(s) on a section, by a primal-dual interior-point method. All limits are
/// linear in the coefficients but the jerk's |L(x, x', x'')| <= J / sqrt(x), whose right side is
/// replaced by its tangent at the present iterate. That lies below the curve, so every iterate
/// keeps all limits. The matrix has five diagonals: a step costs as much as looking at all limits
/// once.
///
/// Not to be trusted blindly: what comes out is checked by differences afterwards.
class BarrierSolver {
public:
    /// \return false if no feed within the limits was found, which from rest never happens
    [[nodiscard]] bool solve(const Section& section, const Grid& grid, const Rows& rows);

    [[nodiscard]] std::span<const double> coefficients() const noexcept { return c_; }
    [[nodiscard]] int steps() const noexcept { return steps_; }

private:
    /// What is minimised: weight * duration, or the relaxation, by which all limits are multiplied.
    struct Goal {
        double duration;
        bool relaxing;
    };

    void prepare(const Section& section, const Grid& grid, const Rows& rows);
    void tieEnds(std::span<double> c) const noexcept;
    /// What the limits allow in a cell.
    struct Ceiling {
        double x;
        double acceleration;
        double jerk;
    };
    void findCeilings() noexcept;
    [[nodiscard]] static double climb(double x, double distance, const Ceiling& ceiling) noexcept;
    void guess() noexcept;
    /// How far the limits are used at most: 1 at a limit.
    [[nodiscard]] double greatestUse() const noexcept;
    [[nodiscard]] double duration() const noexcept;

    [[nodiscard]] bool minimise(const Goal& goal) noexcept;
    void assemble(const Goal& goal) noexcept;
    void foldEnds() noexcept;
    [[nodiscard]] bool findStep(const Goal& goal) noexcept;
    /// The greatest part of the step that keeps all limits.
    [[nodiscard]] double reach() noexcept;
    [[nodiscard]] bool inside(const Row& row, double part) const noexcept;
    /// \return the mean product of slack and multiplier after the step
    double move(double part) noexcept;

    const Section* section_{nullptr};
    const Grid* grid_{nullptr};
    const Rows* rows_{nullptr};
    std::size_t first_{0};
    std::size_t last_{0};
    double headTie_{1.0};  ///< c[1] / c[0] where the section begins at rest
    double tailTie_{1.0};
    int steps_{0};

    std::vector<double> c_;
    std::vector<double> step_;
    std::vector<double> column_;
    std::vector<double> gradient_;
    std::vector<Ceiling> ceilings_;
    std::vector<double> multipliers_;
    std::vector<double> multiplierSteps_;
    Pentadiagonal matrix_;
    double barrier_{0.0};
    double pressure_{0.0};  ///< what a step would gain if nothing were in its way
    double relax_{1.0};
    double relaxStep_{0.0};
    double relaxGradient_{0.0};
    double relaxCurvature_{0.0};
};

}  // namespace takt::planner::detail
