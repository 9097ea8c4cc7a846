#include "extremal_curve.hpp"

namespace takt::planner::detail {

namespace {

constexpr int kMostSteps = 100;

}  // namespace

ExtremalCurve::ExtremalCurve(const Problem& problem) noexcept
    : jerk_{problem.jerk},
      invJerk_{1.0 / problem.jerk},
      main_{problem.v0, problem.a0, problem.amax, jerk_, invJerk_},
      other_{problem.vf, -problem.af, -problem.amin, jerk_, invJerk_},
      mainIsLast_{false},
      c_{(main_.vz - other_.vz) * invJerk_},
      kt_{main_.kt + other_.kt},
      kd_{main_.kd + other_.kd},
      tolerance_{problem.tolerance},
      vtop_{problem.vmax} {
    if (c_ < 0.0) {
        std::swap(main_, other_);
        mainIsLast_ = true;
        c_ = -c_;
    }
    // A state that rounding has put just beyond the limit raises the limit to itself.
    vtop_ = std::max({vtop_, main_.direct(jerk_), other_.direct(jerk_)});
    const double beyond = other_.kt > 0.0 ? other_.kt * other_.kt - c_ : 0.0;
    star_ = beyond > 0.0 ? std::sqrt(beyond) : 0.0;
    hasLow_ = main_.kt < -star_;
    high_ = std::max(star_, main_.kt);
    const double room = (vtop_ - main_.vz) * invJerk_;
    top_ = std::max(high_, room > 0.0 ? std::sqrt(room) : 0.0);
}

ExtremalCurve::Value ExtremalCurve::at(double u) const noexcept {
    const double uu = u * u;
    const double vp = main_.vz + jerk_ * uu;
    const double uo = std::sqrt(uu + c_);
    double sMain = 2.0 * u;
    double dMain = 2.0;
    if (u > main_.full) {
        sMain = uu / main_.full + main_.full;
        dMain = 2.0 * u / main_.full;
    }
    double sOther = 2.0 * uo;
    double dOther = uo > 0.0 ? 2.0 * u / uo : 2.0;
    if (uo > other_.full) {
        sOther = (uu + c_) / other_.full + other_.full;
        dOther = 2.0 * u / other_.full;
    }
    const double sumMain = main_.vz + vp;
    const double sumOther = other_.vz + vp;
    return {0.5 * (sumMain * sMain + sumOther * sOther) - kd_,
            0.5 * (sumMain * dMain + sumOther * dOther) + jerk_ * u * (sMain + sOther),
            sMain + sOther - kt_};
}

double ExtremalCurve::rate(double u) const noexcept {
    const double vp = main_.vz + jerk_ * u * u;
    const double uo = std::min(std::sqrt(u * u + c_), other_.full);
    return vp + 0.5 * jerk_ * std::min(u, main_.full) * uo;
}

double ExtremalCurve::tolerance(double u) const noexcept {
    const double uu = u * u;
    const double uo = std::sqrt(uu + c_);
    const double sMain = u > main_.full ? uu / main_.full + main_.full : 2.0 * std::fabs(u);
    const double sOther = uo > other_.full ? (uu + c_) / other_.full + other_.full : 2.0 * uo;
    const double vp = jerk_ * uu;
    return tolerance_ +
           64.0 * kEps *
               ((std::fabs(main_.vz) + vp) * sMain + (std::fabs(other_.vz) + vp) * sOther +
                std::fabs(main_.kd) + std::fabs(other_.kd));
}

ExtremalCurve::Point ExtremalCurve::meeting(double u, double distance) const noexcept {
    const Value v = at(u);
    const double missing = distance - v.distance;
    // The rounding of the velocities moves the beginning in time, hence in position by `pace` times
    // that.
    const double dc = 4.0 * kEps * (std::fabs(main_.vz) + std::fabs(other_.vz)) * invJerk_;
    // One ramp begins at its start there, so the other one makes up for it.
    const double free = startsOther(u) ? std::fabs(u) : std::sqrt(u * u + c_);
    const double movable = free * free > dc ? dc / free : std::sqrt(dc);
    const double pace = rate(u);
    const double room = std::fabs(pace) * movable;
    if (!(std::fabs(missing) <= tolerance(u) + room)) return {0.0, 0.0, 0.0, false};
    const double shift = room > 0.0 && std::fabs(missing) <= room ? missing / pace : 0.0;
    return {u, 0.0, v.duration + shift, true, shift};
}

double ExtremalCurve::bothHold() const noexcept {
    const double other = other_.full * other_.full - c_;
    return std::max(main_.full, other > 0.0 ? std::sqrt(other) : 0.0);
}

double ExtremalCurve::distance(const Point& point) const noexcept {
    return at(point.u).distance + vtop_ * point.cruise;
}

ExtremalCurve::Point ExtremalCurve::lasting(double duration) const noexcept {
    const double s = duration + kt_;
    const double longest = at(top_).duration;
    if (duration >= longest) return {top_, duration - longest, duration, true};
    // Neither ramp at its limit, then one, then both.
    double u = s > 0.0 ? (0.25 * s * s - c_) / s : main_.kt - 1.0;
    const double uo = std::sqrt(u * u + c_);
    if (uo > other_.full || u > main_.full) {
        const double full = other_.full;
        u = full * (std::sqrt(std::max(0.0, 1.0 + (s - full - c_ / full) / full)) - 1.0);
        if (!(u <= main_.full) || u * u + c_ < full * full) {
            const double f = main_.full;
            const double o = f * (std::sqrt(std::max(0.0, 1.0 + (s - f + c_ / f) / f)) - 1.0);
            u = std::sqrt(std::max(0.0, o * o - c_));
            if (o > full) {
                u = std::sqrt(std::max(0.0, (s - full - f - c_ / full) * full * f / (full + f)));
            }
        }
    }
    const bool inLow = hasLow_ && u >= main_.kt && u <= -star_;
    return {u, 0.0, duration, inLow || u >= high_};
}

double ExtremalCurve::rootBothHolding(double distance) const noexcept {
    // With y = vp - vz of the main ramp the distance is a quadratic: q2 y^2 + q1 y + q0.
    const double jc = jerk_ * c_;
    const double m = 1.0 / main_.cap;
    const double o = 1.0 / other_.cap;
    const double sum = main_.vz + other_.vz;
    const double q2 = 0.5 * (m + o);
    const double q1 = 0.5 * (2.0 * main_.vz * m + main_.full + (sum + jc) * o + other_.full);
    const double q0 =
        0.5 * (2.0 * main_.vz * main_.full + sum * (jc * o + other_.full)) - kd_ - distance;
    const double root = std::sqrt(std::max(0.0, q1 * q1 - 4.0 * q2 * q0));
    const double y = q1 > 0.0 ? -2.0 * q0 / (q1 + root) : (root - q1) / (2.0 * q2);
    return y > 0.0 ? std::sqrt(y * invJerk_) : 0.0;
}

double ExtremalCurve::firstGuess(double lo, const Value& atLo, double hi, const Value& atHi,
                                 double distance) const noexcept {
    // Cubic through both ends with their slopes, of u over the distance.
    const double span = atHi.distance - atLo.distance;
    const double width = hi - lo;
    if (!(span > 0.0)) return 0.5 * (lo + hi);
    const double f = std::clamp((distance - atLo.distance) / span, 0.0, 1.0);
    const double secant = span / width;
    const double m0 = atLo.slope * 3.0 > secant ? secant / atLo.slope : 3.0;
    const double m1 = atHi.slope * 3.0 > secant ? secant / atHi.slope : 3.0;
    const double g = 1.0 - f;
    return lo + width * f * (g * g * m0 + f * (3.0 - 2.0 * f) - f * g * m1);
}

double ExtremalCurve::root(double lo, double hi, double distance) const noexcept {
    if (!(hi > lo)) return hi;
    Value atLo = at(lo);
    Value atHi = at(hi);
    const double knee = bothHold();
    if (hi > knee) {
        const bool inside = knee > lo;
        const Value atKnee = inside ? at(knee) : atLo;
        if (atKnee.distance <= distance) {
            const double u = std::clamp(rootBothHolding(distance), std::max(knee, lo), hi);
            const Value v = at(u);
            const double next = u - (v.distance - distance) / v.slope;
            return v.slope > 0.0 ? std::clamp(next, lo, hi) : u;
        }
        hi = knee;
        atHi = atKnee;
    }
    double u = firstGuess(lo, atLo, hi, atHi, distance);
    double last = hi - lo;
    for (int i = 0; i < kMostSteps; ++i) {
        const Value v = at(u);
        const double miss = v.distance - distance;
        (miss > 0.0 ? hi : lo) = u;
        double next = u - miss / v.slope;
        if (!(v.slope > 0.0) || !(next >= lo) || !(next <= hi)) next = 0.5 * (lo + hi);
        const double step = std::fabs(next - u);
        u = next;
        // Newton doubles the digits; a step that no longer shrinks is rounding.
        if (step <= 1e-10 * std::fabs(u) || (step >= last && step <= 1e-6 * std::fabs(u))) break;
        last = step;
    }
    return u;
}

double ExtremalCurve::anyRoot(double lo, double hi, double distance) const noexcept {
    const bool rising = at(hi).distance > distance;
    for (int i = 0; i < kMostSteps; ++i) {
        const double middle = 0.5 * (lo + hi);
        if (middle <= lo || middle >= hi) break;
        ((at(middle).distance > distance) == rising ? hi : lo) = middle;
    }
    return 0.5 * (lo + hi);
}

double ExtremalCurve::rateZero(double lo, double hi) const noexcept {
    const bool rising = rate(hi) > 0.0;
    for (int i = 0; i < kMostSteps; ++i) {
        const double middle = 0.5 * (lo + hi);
        if (middle <= lo || middle >= hi) break;
        ((rate(middle) > 0.0) == rising ? hi : lo) = middle;
    }
    return 0.5 * (lo + hi);
}

double ExtremalCurve::leastRate(double lo, double hi) const noexcept {
    // Stationary where -u/uo is 2 - sqrt(3) without and 1/4 with the other ramp at its limit, or at
    // the change.
    constexpr double ratio = 0.2679491924311227;
    const double free = -ratio * std::sqrt(c_ / (1.0 - ratio * ratio));
    const double holding = -0.25 * other_.full;
    const double knee = -std::sqrt(std::max(0.0, other_.full * other_.full - c_));
    double best = lo;
    for (const double candidate : {hi, free, holding, knee}) {
        const double u = std::clamp(candidate, lo, hi);
        if (rate(u) < rate(best)) best = u;
    }
    return best;
}

ExtremalCurve::Point ExtremalCurve::crossingInLow(double u, double distance) const noexcept {
    const double end = -star_;
    double from = u;
    if (rate(from) > 0.0) {
        const double least = leastRate(from, end);
        if (rate(least) < 0.0) {
            const double most = rateZero(from, least);
            const double missing = distance - at(most).distance;
            if (missing <= 0.0) return point(root(from, most, distance));
            if (missing <= tolerance(most)) return point(most);
            from = least;
        }
    }
    const double missing = distance - at(end).distance;
    if (missing <= 0.0) return point(root(from, end, distance));
    return meeting(end, distance);
}

ExtremalCurve::Point ExtremalCurve::crossingInHigh(double u, double distance) const noexcept {
    const Value atTop = at(top_);
    if (atTop.distance <= distance) {
        const double cruise = (distance - atTop.distance) / vtop_;
        return {top_, cruise, atTop.duration + cruise, true};
    }
    return point(root(u, top_, distance));
}

void ExtremalCurve::pieces(const Point& p, double sign, Pieces& out) const noexcept {
    const double uu = p.u * p.u;
    double u = p.u;
    double uo = std::sqrt(uu + c_);
    // Without a zero crossing the two descents are one; c/(uo - u) = uo + u without cancellation.
    double both = u < 0.0 ? c_ / (uo - u) : 0.0;
    double hold = 0.0;
    double holdOther = 0.0;
    const double shift = startsOther(p.u) ? 0.0 : p.shift;
    const double shiftMain = p.shift - shift;
    if (u > main_.full) {
        hold = (uu - main_.full * main_.full) / main_.full + shiftMain;
        u = main_.full;
    } else {
        u += 0.5 * shiftMain;
        both += 0.5 * shiftMain;
    }
    if (uo > other_.full) {
        holdOther = (uu + c_ - other_.full * other_.full) / other_.full + shift;
        if (u < 0.0) both = other_.full + u;
        uo = other_.full;
    } else {
        uo += 0.5 * shift;
        both += 0.5 * shift;
    }
    const double firstU = mainIsLast_ ? uo : u;
    const double lastU = mainIsLast_ ? u : uo;
    const double firstKt = mainIsLast_ ? other_.kt : main_.kt;
    const double lastKt = mainIsLast_ ? main_.kt : other_.kt;
    const double j = sign * jerk_;
    out.add(firstU - firstKt, j);
    out.add(mainIsLast_ ? holdOther : hold, 0.0);
    if (u < 0.0) {
        out.add(both, -j);
    } else if (p.cruise > 0.0) {
        out.add(firstU, -j);
        out.add(p.cruise, 0.0);
        out.add(lastU, -j);
    } else {
        out.add(firstU + lastU, -j);
    }
    out.add(mainIsLast_ ? hold : holdOther, 0.0);
    out.add(lastU - lastKt, j);
}

}  // namespace takt::planner::detail
