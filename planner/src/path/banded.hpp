#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace takt::planner::detail {

/// A symmetric matrix with two diagonals on either side of the main one, positive definite; rows
/// first..last-1 of it take part.
class Pentadiagonal {
public:
    void reset(std::size_t size) { rows_.assign(size, {0.0, 0.0, 0.0}); }
    /// Entry (i, i + distance), distance 0..2.
    [[nodiscard]] double& at(std::size_t i, std::size_t distance) noexcept {
        return rows_[i][distance];
    }

    /// L D L^T in place. \return false if it is not positive definite
    [[nodiscard]] bool factor(std::size_t first, std::size_t last) noexcept {
        for (std::size_t i = first; i < last; ++i) {
            const double d = rows_[i][0];
            if (!(d > 0.0)) return false;
            const double l1 = rows_[i][1] / d;
            const double l2 = rows_[i][2] / d;
            if (i + 1 < last) {
                rows_[i + 1][0] -= l1 * rows_[i][1];
                rows_[i + 1][1] -= l1 * rows_[i][2];
            }
            if (i + 2 < last) rows_[i + 2][0] -= l2 * rows_[i][2];
            rows_[i][1] = l1;
            rows_[i][2] = l2;
        }
        return true;
    }

    /// Solves for a right side in place. \pre factor() with the same rows
    void solve(std::size_t first, std::size_t last, std::span<double> b) const noexcept {
        for (std::size_t i = first; i < last; ++i) {
            if (i + 1 < last) b[i + 1] -= rows_[i][1] * b[i];
            if (i + 2 < last) b[i + 2] -= rows_[i][2] * b[i];
        }
        for (std::size_t i = last; i-- > first;) {
            b[i] /= rows_[i][0];
            if (i + 1 < last) b[i] -= rows_[i][1] * b[i + 1];
            if (i + 2 < last) b[i] -= rows_[i][2] * b[i + 2];
        }
    }

private:
    std::vector<std::array<double, 3>> rows_;
};

}  // namespace takt::planner::detail
