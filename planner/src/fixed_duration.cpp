#include "duration.hpp"

namespace takt::planner::detail {

namespace {

constexpr int kMostSteps = 80;

/// One end of the move, with a ramp in either direction; the mirror image of a falling ramp rises.
struct End {
    Ramp rising;
    Ramp falling;
    double direct;  ///< the velocity at which a crosses zero when it is taken there directly

    End(double v, double a, double up, double down, double jerk, double invJerk) noexcept
        : rising{v, a, up, jerk, invJerk},
          falling{-v, -a, down, jerk, invJerk},
          direct{a > 0.0 ? v + 0.5 * a * a * invJerk : v - 0.5 * a * a * invJerk} {}
};

/// Time, distance and peak acceleration between an end and constant velocity.
struct Leg {
    double time, distance, peak;
};

Leg leg(const End& end, double vp, double jerk, double invJerk) noexcept {
    const bool up = vp >= end.direct;
    const Ramp& ramp = up ? end.rising : end.falling;
    const double v = up ? vp : -vp;
    const double w = v > ramp.vz ? v - ramp.vz : 0.0;
    double s = 0.0;
    double peak = ramp.cap;
    if (w > ramp.cap * ramp.full) {
        s = w / ramp.cap + ramp.full;
    } else {
        s = 2.0 * std::sqrt(w * invJerk);
        peak = 0.5 * s * jerk;
    }
    const double distance = 0.5 * (ramp.vz + v) * s - ramp.kd;
    return {s - ramp.kt, up ? distance : -distance, peak};
}

/// A move of given duration with one velocity vp held in the middle: rise or fall to it, rise or
/// fall from it. Where there is time to hold it, the distance rises with vp; and the vp with enough
/// time are one or two intervals, which begin or end at the velocities that the ends reach
/// directly.
class Middle {
public:
    Middle(const Problem& p, double duration) noexcept
        : jerk_{p.jerk},
          invJerk_{1.0 / p.jerk},
          first_{p.v0, p.a0, p.amax, -p.amin, p.jerk, invJerk_},
          last_{p.vf, -p.af, -p.amin, p.amax, p.jerk, invJerk_},
          duration_{duration},
          distance_{p.distance},
          slack_{p.tolerance} {
        low_ = std::min({p.vmin, first_.direct, last_.direct});
        high_ = std::max({p.vmax, first_.direct, last_.direct});
    }

    [[nodiscard]] bool solve(Pieces& out) const noexcept;

private:
    struct Value {
        double miss;   ///< distance beyond the one wanted
        double slope;  ///< by vp
        double hold;   ///< time at vp
    };

    [[nodiscard]] Value at(double vp) const noexcept {
        const Leg a = leg(first_, vp, jerk_, invJerk_);
        const Leg b = leg(last_, vp, jerk_, invJerk_);
        const double hold = duration_ - a.time - b.time;
        return {a.distance + b.distance + vp * hold - distance_,
                0.5 * (a.peak + b.peak) * invJerk_ + hold, hold};
    }
    [[nodiscard]] bool hasRoot(double lo, double hi, bool fromLow, Pieces& out) const noexcept;
    void write(double vp, Pieces& out) const noexcept;
    void writeLeg(const End& end, double vp, bool isLast, Pieces& out) const noexcept;

    double jerk_, invJerk_;
    End first_, last_;
    double duration_, distance_, slack_;
    double low_{0.0}, high_{0.0};
};

bool Middle::solve(Pieces& out) const noexcept {
    const double c1 = std::min(first_.direct, last_.direct);
    const double c2 = std::max(first_.direct, last_.direct);
    const Value at1 = at(c1);
    const Value at2 = at(c2);
    if (at2.hold >= 0.0 && at2.miss <= 0.0) return hasRoot(c2, high_, true, out);
    if (at1.hold >= 0.0 && at1.miss >= 0.0) return hasRoot(low_, c1, false, out);
    if (at1.hold >= 0.0 && hasRoot(c1, c2, true, out)) return true;
    return at2.hold >= 0.0 && hasRoot(c1, c2, false, out);
}

/// \param fromLow the interval with enough time begins at lo, otherwise it ends at hi
bool Middle::hasRoot(double lo, double hi, bool fromLow, Pieces& out) const noexcept {
    double vp = fromLow ? lo : hi;
    const double scale = std::max(std::fabs(lo), std::fabs(hi));
    double last = hi - lo;
    for (int i = 0; i < kMostSteps; ++i) {
        const Value v = at(vp);
        const bool tooHigh = v.hold < 0.0 ? fromLow : v.miss > 0.0;
        (tooHigh ? hi : lo) = vp;
        double next = vp - v.miss / v.slope;
        if (v.hold < 0.0 || !(next >= lo) || !(next <= hi)) next = 0.5 * (lo + hi);
        const double step = std::fabs(next - vp);
        const bool done = step <= 1e-10 * std::fabs(vp) ||
                          (i > 5 && step >= last && step <= kClip * scale) ||
                          step <= 4.0 * kEps * scale;
        vp = next;
        if (done) break;
        last = step;
    }
    const Value v = at(vp);
    const double slack = slack_ + 64.0 * kEps * (scale * duration_ + std::fabs(distance_));
    if (!(v.hold >= -8.0 * kEps * duration_) || !(std::fabs(v.miss) <= slack)) return false;
    write(vp, out);
    return true;
}

void Middle::writeLeg(const End& end, double vp, bool isLast, Pieces& out) const noexcept {
    const bool up = vp >= end.direct;
    const Ramp& ramp = up ? end.rising : end.falling;
    const RampTimes t = timesFor(ramp, (up ? vp : -vp) - ramp.vz, invJerk_);
    // Towards vp a rise starts with +J; away from it, with -J.
    const double j = up != isLast ? jerk_ : -jerk_;
    out.add(isLast ? t.rise : t.rise - ramp.kt, j);
    out.add(t.hold, 0.0);
    out.add(isLast ? t.rise - ramp.kt : t.rise, -j);
}

void Middle::write(double vp, Pieces& out) const noexcept {
    writeLeg(first_, vp, false, out);
    out.add(at(vp).hold, 0.0);
    writeLeg(last_, vp, true, out);
}

/// l X + (1-l) N of two profiles of the same duration: all limits are convex, so it keeps them too.
void combine(const Pieces& x, const Pieces& n, double l, Pieces& out) noexcept {
    std::size_t i = 0;
    std::size_t k = 0;
    double leftX = x.size > 0 ? x.time[0] : 0.0;
    double leftN = n.size > 0 ? n.time[0] : 0.0;
    while (i < x.size && k < n.size && out.size < Pieces::capacity) {
        const double step = std::min(leftX, leftN);
        out.add(step, l * x.value[i] + (1.0 - l) * n.value[k]);
        leftX -= step;
        leftN -= step;
        if (leftX <= 0.0) leftX = ++i < x.size ? x.time[i] : 0.0;
        if (leftN <= 0.0) leftN = ++k < n.size ? n.time[k] : 0.0;
    }
    // One of the two may end some ulps earlier.
    for (; i < x.size && out.size < Pieces::capacity; leftX = ++i < x.size ? x.time[i] : 0.0) {
        out.add(leftX, x.value[i]);
    }
    for (; k < n.size && out.size < Pieces::capacity; leftN = ++k < n.size ? n.time[k] : 0.0) {
        out.add(leftN, n.value[k]);
    }
}

bool combined(const Problem& problem, double duration, Pieces& out) noexcept {
    const ExtremalCurve up{problem};
    const ExtremalCurve down{mirrored(problem)};
    const auto high = up.lasting(duration);
    const auto low = down.lasting(duration);
    if (!high.found || !low.found) return false;
    const double pmax = up.distance(high);
    const double pmin = -down.distance(low);
    if (problem.distance >= pmax - up.tolerance(high.u)) {
        if (problem.distance > pmax + up.tolerance(high.u)) return false;
        up.pieces(high, 1.0, out);
        return true;
    }
    if (problem.distance <= pmin + down.tolerance(low.u)) {
        if (problem.distance < pmin - down.tolerance(low.u)) return false;
        down.pieces(low, -1.0, out);
        return true;
    }
    Pieces x;
    Pieces n;
    up.pieces(high, 1.0, x);
    down.pieces(low, -1.0, n);
    combine(x, n, (problem.distance - pmin) / (pmax - pmin), out);
    return true;
}

}  // namespace

bool lasting(const Problem& problem, double duration, Pieces& out) noexcept {
    if (Middle{problem, duration}.solve(out)) return true;
    return combined(problem, duration, out);
}

}  // namespace takt::planner::detail
