#include "brake.hpp"

#include "double_double.hpp"

namespace takt::planner::detail {

namespace {

/// Times of jerk -J, then of constant acceleration.
struct Brake {
    double ramp;
    double hold;
};

/// v above its limit, or bound to get there. Ends with v at its limit, or at the last instant from
/// which the limit on the other side is still kept.
Brake fromVelocity(const Problem& p) noexcept {
    const double j = p.jerk;
    const double toLimit = p.a0 * p.a0 + 2.0 * j * (p.v0 - p.vmax);
    const double toOther = 0.5 * p.a0 * p.a0 + j * (p.v0 - p.vmin);
    const double ramp = (p.a0 + std::sqrt(std::max(0.0, std::min(toLimit, toOther)))) / j;
    const double toMin = (p.a0 - p.amin) / j;
    if (toMin >= ramp) return {ramp, 0.0};
    const double v = p.v0 + toMin * (p.a0 - 0.5 * j * toMin);
    const double limit = (p.vmax - v) / p.amin;
    const double other = (p.vmin - v) / p.amin + 0.5 * p.amin / j;
    return {toMin, std::max(0.0, std::min(limit, other))};
}

/// a above its limit.
Brake fromAcceleration(const Problem& p) noexcept {
    const double j = p.jerk;
    if (p.v0 + 0.5 * p.a0 * p.a0 / j > p.vmax) return fromVelocity(p);
    const double ramp = (p.a0 - p.amax) / j;
    const double v = p.v0 + ramp * (p.a0 - 0.5 * j * ramp);
    if (!(v < p.vmin)) return {ramp, 0.0};
    const double inside = (p.vmin - v) / p.amax;
    const double latest = (p.vmax - v) / p.amax - 0.5 * p.amax / j;
    return {ramp, std::max(0.0, std::min(inside, latest))};
}

bool tooFast(const Problem& p) noexcept {
    const double swing = 0.5 * p.a0 * p.a0 / p.jerk;
    const double clip = kClip * p.vmax;
    return (p.v0 > p.vmax + clip && p.v0 - swing > p.vmin) ||
           (p.a0 > 0.0 && p.v0 + swing > p.vmax + clip);
}

/// Moves the beginning of the problem to the end of the braking, without adding up its rounding:
/// what follows may take many times as long.
void apply(Problem& p, const Brake& brake, double sign, Pieces& out) noexcept {
    const double j = -sign * p.jerk;
    ExactState state;
    state.v.high = p.v0;
    state.a.high = p.a0;
    if (brake.ramp > 0.0) state.advance(brake.ramp, j);
    if (brake.hold > 0.0) state.advance(brake.hold, 0.0);
    p.distance -= state.p.value();
    p.v0 = state.v.value();
    p.a0 = state.a.value();
    out.add(brake.ramp, j);
    out.add(brake.hold, 0.0);
}

}  // namespace

void brakePosition(Problem& problem, Pieces& out) noexcept {
    const double clipUp = problem.amax * (1.0 + kClip);
    const double clipDown = problem.amin * (1.0 + kClip);
    if (problem.a0 > clipUp) {
        apply(problem, fromAcceleration(problem), 1.0, out);
    } else if (problem.a0 < clipDown) {
        apply(problem, fromAcceleration(mirrored(problem)), -1.0, out);
    } else if (tooFast(problem)) {
        apply(problem, fromVelocity(problem), 1.0, out);
    } else if (const Problem mirror = mirrored(problem); tooFast(mirror)) {
        apply(problem, fromVelocity(mirror), -1.0, out);
    }
}

void brakeAcceleration(Problem& problem, Pieces& out) noexcept {
    if (problem.a0 > problem.amax * (1.0 + kClip)) {
        apply(problem, {(problem.a0 - problem.amax) / problem.jerk, 0.0}, 1.0, out);
    } else if (problem.a0 < problem.amin * (1.0 + kClip)) {
        apply(problem, {(problem.amin - problem.a0) / problem.jerk, 0.0}, -1.0, out);
    }
}

}  // namespace takt::planner::detail
