#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/planner/path_planner.hpp>
#include <vector>

namespace takt::planner::detail {

/// A stretch of path without a stop inside: from rest, or from a state in motion, to rest.
///
/// The unknown of the feed on it is x(s) = s1^2. Then s2 = x'/2 and s3 = x'' sqrt(x)/2, and all
/// limits but those of jerk are linear in x.
struct Section {
    double from;
    double to;
    bool fromRest;
    double x0;      ///< at `from`, if not at rest there
    double slope0;  ///< x' there
};

/// Limits in bare numbers, and what they are multiplied with.
struct LimitSet {
    std::span<const PathAxisLimits> axes;
    double cycle;
    double share;       ///< of the limits of acceleration and jerk; at most 1
    double speedShare;  ///< of those of velocity
};

/// What limits the feed at a point of the path, when one number is enough: as if along a line.
struct LineLimits {
    double x;  ///< s1^2
    double acceleration;
    double deceleration;
    double jerk;
};

/// The limits that hold on a piece as far as it is straight there: those of velocity, and the
/// others where no axis bends.
[[nodiscard]] LineLimits lineLimits(const PathGeometry& geometry, std::size_t piece,
                                    const PathDerivatives& at, const LimitSet& limits) noexcept;

/// The greatest s1^2 with which a joint between two pieces can be run through: a jump of curvature
/// is a jump of acceleration, a kink one of velocity, and both are spread over a cycle.
[[nodiscard]] double jointLimit(const PathGeometry& geometry, std::size_t before,
                                const LimitSet& limits) noexcept;

/// The greatest s1^2 that the curvature allows by itself, at a constant speed.
[[nodiscard]] double curveLimit(const PathDerivatives& at, const LimitSet& limits) noexcept;

/// Both pieces lie on one line and have the same limits.
[[nodiscard]] bool isSameLine(const PathGeometry& geometry, std::size_t before, std::size_t after,
                              const LimitSet& limits) noexcept;

/// Nodes of a section. Between `head` and `tail` x is a quadratic of s in every cell and smooth;
/// before the first node and behind the last, where the section begins or ends at rest, the jerk is
/// constant.
struct Grid {
    std::vector<double> nodes;
    std::vector<std::uint32_t> pieces;  ///< in which a cell lies
    double head;                        ///< length from rest to the first node, or 0
    double tail;

    [[nodiscard]] std::size_t cells() const noexcept { return nodes.size() - 1; }
};

inline constexpr std::size_t mostCells = 8192;

/// \return false if the section needs more than mostCells
[[nodiscard]] bool makeGrid(const PathGeometry& geometry, const Section& section,
                            const LimitSet& limits, Grid& out);

/// One limit of acceleration and jerk at a point: of an axis, or of the path.
/// -low <= q1 x'/2 + q2 x <= high; |q3 x + 3/2 q2 x' + q1 x''/2| <= jerk / sqrt(x)
struct Term {
    double q1;
    double q2;
    double q3;
    double low;
    double high;
    double jerk;
};

/// A point of the grid at which limits are kept. x, x' and x'' are sums of three coefficients of
/// the spline, from `coefficient` on.
struct Row {
    std::uint32_t coefficient;
    std::uint32_t firstTerm;
    std::uint32_t endTerm;
    bool acceleration;  ///< x and x' are limited here; else only x'', for it differs on both sides
    double x[3];
    double slope[3];
    double bend[3];
    double xMax;
    double time;  ///< weight of 1/sqrt(x) in the duration
};

struct Rows {
    std::vector<Row> rows;
    std::vector<Term> terms;
};

void makeRows(const PathGeometry& geometry, const Section& section, const Grid& grid,
              const LimitSet& limits, Rows& out);

/// The judge of a feed, who knows nothing of how it came about.
/// \param firstPiece of the feed that is to be judged
/// \return the factor on time with which the differences of its positions from cycle to cycle keep
/// all limits, up to the rounding of positions; 1 or less if they do
[[nodiscard]] double stretchNeeded(const PathGeometry& geometry, const FeedProfile& feed,
                                   std::size_t firstPiece, const LimitSet& limits);

/// Adds a section's feed to a profile, whose end it begins at.
/// \param coefficients of the spline x(s)
void addPieces(const Section& section, const Grid& grid, std::span<const double> coefficients,
               FeedProfile& out);

/// The feed on a straight section with the same limits everywhere, in closed form.
/// \return false if it is not such a section
[[nodiscard]] bool addStraight(const PathGeometry& geometry, const Section& section,
                               const LimitSet& limits, FeedProfile& out);

}  // namespace takt::planner::detail
