#include "reachable.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace takt::planner::test {

namespace {

using Real = long double;

struct Numbers {
    Real v0, a0, vf, af, vmax, amax, amin, jerk;
};

struct Piece {
    Real time, jerk;
};

struct Outcome {
    Real time{0}, distance{0}, v{0}, a{0}, travelled{0};
};

Outcome integrate(const Numbers& n, const std::vector<Piece>& pieces) {
    Outcome o;
    o.v = n.v0;
    o.a = n.a0;
    for (const Piece& piece : pieces) {
        const Real t = piece.time;
        o.travelled += std::fabs(o.v) * t + std::fabs(o.a) * t * t;
        o.distance += t * (o.v + t * (o.a / 2 + t * piece.jerk / 6));
        o.v += t * (o.a + t * piece.jerk / 2);
        o.a += t * piece.jerk;
        o.time += t;
    }
    return o;
}

/// From (v, a) to (vp, 0), a rising first; the three times by the textbook.
std::vector<Piece> rise(Real v, Real a, Real vp, Real cap, Real jerk) {
    const Real peak = std::sqrt(std::max<Real>(0, jerk * (vp - v) + a * a / 2));
    if (peak <= cap) return {{(peak - a) / jerk, jerk}, {peak / jerk, -jerk}};
    const Real hold = (vp - v - (2 * cap * cap - a * a) / (2 * jerk)) / cap;
    return {{(cap - a) / jerk, jerk}, {hold, 0}, {cap / jerk, -jerk}};
}

Real directVelocity(Real v, Real a, Real jerk) {
    return v + a * std::fabs(a) / (2 * jerk);
}

/// Up to vp, hold it, and down to the end: the way down is the way up in reversed time.
std::vector<Piece> hill(const Numbers& n, Real vp, Real hold) {
    std::vector<Piece> pieces = rise(n.v0, n.a0, vp, n.amax, n.jerk);
    pieces.push_back({hold, 0});
    const std::vector<Piece> back = rise(n.vf, -n.af, vp, -n.amin, n.jerk);
    for (auto piece = back.rbegin(); piece != back.rend(); ++piece) pieces.push_back(*piece);
    return pieces;
}

/// A peak, a valley of positive acceleration am and up to af; the peak follows from the velocities.
std::vector<Piece> peakAndValley(const Numbers& n, Real am) {
    const Real j = n.jerk;
    const Real gain = n.vf - n.v0 - (n.af * n.af - am * am) / (2 * j);
    const Real peak = std::sqrt(std::max<Real>(0, j * gain + (n.a0 * n.a0 + am * am) / 2));
    if (peak <= n.amax)
        return {{(peak - n.a0) / j, j}, {(peak - am) / j, -j}, {(n.af - am) / j, j}};
    const Real cap = n.amax;
    const Real hold = (gain - (2 * cap * cap - n.a0 * n.a0 - am * am) / (2 * j)) / cap;
    return {{(cap - n.a0) / j, j}, {hold, 0}, {(cap - am) / j, -j}, {(n.af - am) / j, j}};
}

Numbers reversedInTime(const Numbers& n) {
    return {n.vf, -n.af, n.v0, -n.a0, n.vmax, -n.amin, -n.amax, n.jerk};
}

Numbers mirrored(const Numbers& n, Real vmin) {
    return {-n.v0, -n.a0, -n.vf, -n.af, -vmin, -n.amin, -n.amax, n.jerk};
}

/// The farthest profile of a duration in which the velocity problem has an answer.
Outcome farthest(const Numbers& n, Real duration) {
    const Real low =
        std::max(directVelocity(n.v0, n.a0, n.jerk), directVelocity(n.vf, -n.af, n.jerk));
    const Real high = std::max(low, n.vmax);
    const Outcome atLow = integrate(n, hill(n, low, 0));
    if (duration >= atLow.time) {
        const Outcome atHigh = integrate(n, hill(n, high, 0));
        if (duration >= atHigh.time) return integrate(n, hill(n, high, duration - atHigh.time));
        Real lo = low;
        Real hi = high;
        for (int i = 0; i < 200; ++i) {
            const Real middle = (lo + hi) / 2;
            (integrate(n, hill(n, middle, 0)).time > duration ? hi : lo) = middle;
        }
        return integrate(n, hill(n, (lo + hi) / 2, 0));
    }
    if (!(n.af > 0) || directVelocity(n.v0, n.a0, n.jerk) > directVelocity(n.vf, -n.af, n.jerk)) {
        // Then the acceleration keeps its sign at the start instead.
        if (n.a0 < 0) return farthest(reversedInTime(n), duration);
    }
    Real lo = 0;
    Real hi = n.af;
    for (int i = 0; i < 200; ++i) {
        const Real middle = (lo + hi) / 2;
        (integrate(n, peakAndValley(n, middle)).time > duration ? lo : hi) = middle;
    }
    return integrate(n, peakAndValley(n, (lo + hi) / 2));
}

/// Velocity gained in `duration` when the acceleration goes to `level` first and is held there.
Real gained(const Numbers& n, Real level, Real duration) {
    const Real to = std::fabs(level - n.a0) / n.jerk;
    const Real from = std::fabs(level - n.af) / n.jerk;
    return to * (n.a0 + level) / 2 + from * (n.af + level) / 2 + level * (duration - to - from);
}

bool velocityReachable(const Numbers& n, Real duration, Real slack) {
    if (duration * (1 + slack) < std::fabs(n.af - n.a0) / n.jerk) return false;
    const Real reach = n.jerk * duration;
    const Real top = std::min(std::max({n.amax, n.a0, n.af}), (n.a0 + n.af + reach) / 2);
    const Real bottom = std::max(std::min({n.amin, n.a0, n.af}), (n.a0 + n.af - reach) / 2);
    const Real gain = n.vf - n.v0;
    const Real room = slack * (std::fabs(n.v0) + std::fabs(n.vf) + (n.amax - n.amin) * duration);
    return gain <= gained(n, top, duration) + room && gain >= gained(n, bottom, duration) - room;
}

Numbers numbersOf(const Case& c) {
    return {c.from.velocity.count(),          c.from.acceleration.count(),
            c.target.state.velocity.count(),  c.target.state.acceleration.count(),
            c.limits.maxVelocity.count(),     c.limits.maxAcceleration.count(),
            c.limits.minAcceleration.count(), c.limits.jerk.count()};
}

}  // namespace

bool velocityReachable(const Case& c, long double duration, long double slack) {
    return velocityReachable(numbersOf(c), duration, slack);
}

bool reachable(const Case& c, long double duration, long double slack) {
    const Numbers n = numbersOf(c);
    if (!velocityReachable(n, duration, slack)) return false;
    const Real d = static_cast<Real>(c.target.state.position.count()) - c.from.position.count();
    const Outcome high = farthest(n, duration);
    const Outcome low = farthest(mirrored(n, c.limits.minVelocity.count()), duration);
    const Real room = slack * (high.travelled + low.travelled + std::fabs(d));
    return d <= high.distance + room && d >= -low.distance - room;
}

}  // namespace takt::planner::test
