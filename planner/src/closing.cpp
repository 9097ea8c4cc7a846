#include "closing.hpp"

#include "double_double.hpp"

namespace takt::planner::detail {

namespace {

struct Cruise {
    std::size_t index;
    double velocity;
    double time;
};

/// The longest piece at constant velocity.
Cruise longestCruise(const Problem& p, const Pieces& pieces) noexcept {
    Cruise best{0, 0.0, 0.0};
    double v = p.v0;
    double a = p.a0;
    const double still = 1e-9 * std::max(p.amax, -p.amin);
    for (std::size_t i = 0; i < pieces.size; ++i) {
        const double t = pieces.time[i];
        const double j = pieces.value[i];
        if (j == 0.0 && std::fabs(a) <= still && t > best.time) best = {i, v, t};
        v += t * (a + 0.5 * t * j);
        a += t * j;
    }
    return best;
}

/// The exact state before a piece.
ExactState stateBefore(const Problem& problem, const Pieces& pieces, std::size_t index) noexcept {
    ExactState state;
    state.v.high = problem.v0;
    state.a.high = problem.a0;
    for (std::size_t i = 0; i < index; ++i) state.advance(pieces.time[i], pieces.value[i]);
    return state;
}

}  // namespace

bool closeOnTarget(const Problem& problem, Pieces& pieces) noexcept {
    const Cruise cruise = longestCruise(problem, pieces);
    // What an ulp of acceleration does on the way, against 1e-13 of the way.
    const double limit = std::max(problem.amax, -problem.amin);
    if (!(kEps * limit * cruise.time > 1e-13 * std::fabs(cruise.velocity))) return false;
    std::size_t index = cruise.index;
    const double left = stateBefore(problem, pieces, index).a.value();
    if (left != 0.0 && pieces.size < Pieces::capacity) {
        // Shorter than the resolution of any time stamp, so it costs no time.
        pieces.insert(index++, std::fabs(left) / problem.jerk,
                      left > 0.0 ? -problem.jerk : problem.jerk);
    }
    const ExactState end = stateBefore(problem, pieces, pieces.size);
    const double miss = (end.p + DoubleDouble{-problem.distance, 0.0}).value();
    const double change = miss / cruise.velocity;
    if (std::fabs(change) <= kClip * cruise.time) pieces.time[index] -= change;
    return true;
}

}  // namespace takt::planner::detail
