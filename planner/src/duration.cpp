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
    const double missing = problem.distance - up.at(u).distance;
    if (std::fabs(missing) <= up.tolerance(u)) return result(up.point(u), false);
    if (missing > 0.0) return result(up.crossingInHigh(u, problem.distance), false);
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

/// The end of a profile is one piece of jerk. Both its duration and where it leads follow from the
/// accelerations, so a state sampled there meets the target up to rounding only, and that must not
/// count as a miss.
bool isDirect(const Problem& p, double& duration) noexcept {
    const double time = std::fabs(p.af - p.a0) / p.jerk;
    const double gain = 0.5 * (p.a0 + p.af) * time;
    const double slack =
        8.0 * kEps *
        (std::fabs(p.v0) + std::fabs(p.vf) + (std::fabs(p.a0) + std::fabs(p.af)) * time);
    if (!(std::fabs(p.vf - p.v0 - gain) <= slack)) return false;
    const double way = time * (p.v0 + time * (2.0 * p.a0 + p.af) * (1.0 / 6.0));
    duration = time;
    return std::fabs(p.distance - way) <= p.tolerance + slack * time;
}

}  // namespace

Possible fastest(const Problem& problem) noexcept {
    double direct = 0.0;
    if (isDirect(problem, direct)) return {direct, {}, false, true, true, true};
    const ExtremalCurve up{problem};
    const double u = up.begin();
    const double missing = problem.distance - up.at(u).distance;
    if (std::fabs(missing) <= up.tolerance(u)) return result(up.point(u), false);
    if (missing > 0.0) return crossing(problem, up, false, u, problem.distance);
    const ExtremalCurve down{mirrored(problem)};
    return crossing(problem, down, true, down.begin(), -problem.distance);
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
