#include "duration.hpp"

namespace takt::planner::detail {

namespace {

using Point = ExtremalCurve::Point;

Possible result(const Point& point, bool mirrored) noexcept {
    return {point.duration, point, mirrored, true, false, point.found};
}

/// From the beginning of the high block, or from a later point of it that cannot be left out.
Possible fromHigh(const Problem& problem, const ExtremalCurve& up) noexcept {
    const double u = up.highBegin();
    const Point met = up.meeting(u, problem.distance);
    if (met.found) return result(met, false);
    if (up.at(u).distance < problem.distance)
        return result(up.crossingInHigh(u, problem.distance), false);
    const ExtremalCurve down{mirrored(problem)};
    return result(down.crossingInHigh(down.highBegin(), -problem.distance), true);
}

/// The next crossing of a curve from u on, on which the distance is not reached; where the curve
/// has a gap before the crossing, everything begins anew behind it.
Possible crossing(const Problem& problem, const ExtremalCurve& curve, bool isMirror, double u,
                  double distance) noexcept {
    if (u < 0.0 && curve.hasLow()) {
        const Point point = curve.crossingInLow(u, distance);
        if (point.found) return result(point, isMirror);
        if (curve.hasGap()) {
            return isMirror ? fromHigh(problem, ExtremalCurve{problem}) : fromHigh(problem, curve);
        }
        u = curve.highBegin();
    }
    return result(curve.crossingInHigh(u, distance), isMirror);
}

/// The next crossing behind a point of the curve that is `missing` short of the distance.
Possible later(const Problem& problem, const ExtremalCurve& curve, bool isMirror, const Point& from,
               double missing) noexcept {
    const double distance = isMirror ? -problem.distance : problem.distance;
    if (from.cruise <= 0.0) return crossing(problem, curve, isMirror, from.u, distance);
    const double more = missing / curve.topVelocity();
    return result({from.u, from.cruise + more, from.duration + more, true}, isMirror);
}

/// The end of a profile is one piece of jerk. Both its duration and where it leads follow from the
/// accelerations, so a state sampled there meets the target up to rounding only, and that must not
/// count as a miss.
bool isDirect(const Problem& p, double& duration) noexcept {
    const double time = std::fabs(p.af - p.a0) / p.jerk;
    const double gain = 0.5 * (p.a0 + p.af) * time;
    // A sampled velocity is as exact as the velocities of its profile, not as itself.
    const double scale = std::min(p.vmax - p.vmin, (p.amax * p.amax + p.amin * p.amin) / p.jerk);
    const double rounding =
        4.0 * kEps *
        (scale + std::fabs(p.v0) + std::fabs(p.vf) + (std::fabs(p.a0) + std::fabs(p.af)) * time);
    const double slack = std::max(rounding, p.nearVelocity);
    if (!(std::fabs(p.vf - p.v0 - gain) <= slack)) return false;
    const double way = time * (p.v0 + time * (2.0 * p.a0 + p.af) * (1.0 / 6.0));
    duration = time;
    return std::fabs(p.distance - way) <=
           std::max(p.tolerance + rounding * (time + (p.amax - p.amin) / p.jerk), p.nearDistance);
}

/// The crossings within a stretch on which the distance only rises or only falls.
void markBetween(const ExtremalCurve& curve, double lo, double hi, double distance,
                 Marks& out) noexcept {
    const double missingLo = distance - curve.at(lo).distance;
    const double missingHi = distance - curve.at(hi).distance;
    if ((missingLo > 0.0) == (missingHi > 0.0)) return;
    const double u = curve.anyRoot(lo, hi, distance);
    static_cast<void>(out.push(curve.at(u).duration));
}

/// The crossings within a block, split where the distance turns.
void markBlock(const ExtremalCurve& curve, double lo, double hi, double distance,
               Marks& out) noexcept {
    static_cast<void>(out.push(curve.at(lo).duration));
    static_cast<void>(out.push(curve.at(hi).duration));
    const double least = lo < 0.0 ? curve.leastRate(lo, hi) : lo;
    double from = lo;
    for (const double to : {least, hi}) {
        if (!(to > from)) continue;
        double turn = to;
        if ((curve.rate(from) > 0.0) != (curve.rate(to) > 0.0)) turn = curve.rateZero(from, to);
        markBetween(curve, from, turn, distance, out);
        markBetween(curve, turn, to, distance, out);
        from = to;
    }
}

void marksOf(const ExtremalCurve& curve, double distance, Marks& out) noexcept {
    if (curve.hasLow()) markBlock(curve, curve.begin(), curve.lowEnd(), distance, out);
    markBlock(curve, curve.highBegin(), curve.top(), distance, out);
    const auto atTop = curve.at(curve.top());
    if (distance > atTop.distance) {
        static_cast<void>(
            out.push(atTop.duration + (distance - atTop.distance) / curve.topVelocity()));
    }
}

}  // namespace

Possible fastest(const Problem& problem) noexcept {
    double direct = 0.0;
    if (isDirect(problem, direct)) return {direct, {}, false, true, true, true};
    const ExtremalCurve up{problem};
    const double u = up.begin();
    const Point met = up.meeting(u, problem.distance);
    if (met.found) return result(met, false);
    if (up.at(u).distance < problem.distance)
        return crossing(problem, up, false, u, problem.distance);
    const ExtremalCurve down{mirrored(problem)};
    return crossing(problem, down, true, down.begin(), -problem.distance);
}

Possible firstPossible(const Problem& problem, double notBefore) noexcept {
    const Possible least = fastest(problem);
    if (notBefore <= least.duration) return least;
    const ExtremalCurve up{problem};
    const ExtremalCurve down{mirrored(problem)};
    const Point high = up.lasting(notBefore);
    const Point low = down.lasting(notBefore);
    if (!high.found || !low.found) return fromHigh(problem, up);
    const double beyond = problem.distance - up.distance(high);
    const double below = -problem.distance - down.distance(low);
    if (beyond > up.tolerance(high.u)) return later(problem, up, false, high, beyond);
    if (below > down.tolerance(low.u)) return later(problem, down, true, low, below);
    return {notBefore, {}, false, false, false, true};
}

void marks(const Problem& problem, Marks& out) noexcept {
    const ExtremalCurve up{problem};
    const ExtremalCurve down{mirrored(problem)};
    marksOf(up, problem.distance, out);
    marksOf(down, -problem.distance, out);
}

void piecesOf(const Problem& problem, const Possible& possible, Pieces& out) noexcept {
    if (possible.direct) {
        out.add(possible.duration, problem.af > problem.a0 ? problem.jerk : -problem.jerk);
    } else if (possible.mirrored) {
        ExtremalCurve{mirrored(problem)}.pieces(possible.point, -1.0, out);
    } else {
        ExtremalCurve{problem}.pieces(possible.point, 1.0, out);
    }
}

}  // namespace takt::planner::detail
