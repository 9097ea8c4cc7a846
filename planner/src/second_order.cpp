#include "second_order.hpp"

namespace takt::planner::detail {

namespace {

/// Accelerate to vp, hold it, decelerate: pmax of a duration.
class Hill {
public:
    explicit Hill(const Problem& p) noexcept
        : p_{p},
          up_{1.0 / p.amax},
          down_{-1.0 / p.amin},
          foot_{std::max(p.v0, p.vf)},
          top_{std::max(p.vmax, foot_)} {}

    struct Point {
        double vp, cruise;
    };

    [[nodiscard]] Point foot() const noexcept { return {foot_, 0.0}; }
    [[nodiscard]] double duration(const Point& x) const noexcept {
        return (x.vp - p_.v0) * up_ + x.cruise + (x.vp - p_.vf) * down_;
    }
    [[nodiscard]] double distance(const Point& x) const noexcept {
        return 0.5 * ((x.vp - p_.v0) * (x.vp + p_.v0) * up_ +
                      (x.vp - p_.vf) * (x.vp + p_.vf) * down_) +
               x.vp * x.cruise;
    }
    /// The last profile that goes by the distance of the problem; from below there is no other.
    [[nodiscard]] Point crossing() const noexcept {
        const double most = distance({top_, 0.0});
        if (most <= p_.distance) return {top_, (p_.distance - most) / top_};
        const double squares = 2.0 * p_.distance + p_.v0 * p_.v0 * up_ + p_.vf * p_.vf * down_;
        const double vp = std::sqrt(std::max(0.0, squares / (up_ + down_)));
        return {std::clamp(vp, foot_, top_), 0.0};
    }
    /// Where the distance is passed while it still falls with vp, which is below zero there.
    [[nodiscard]] Point fallingCrossing() const noexcept {
        return {std::clamp(-crossing().vp, foot_, top_), 0.0};
    }
    [[nodiscard]] Point lasting(double time) const noexcept {
        const double vp = (time + p_.v0 * up_ + p_.vf * down_) / (up_ + down_);
        if (vp <= top_) return {std::max(vp, foot_), 0.0};
        return {top_, time - duration({top_, 0.0})};
    }
    void pieces(const Point& x, double sign, Pieces& out) const noexcept {
        out.add((x.vp - p_.v0) * up_, sign * p_.amax);
        out.add(x.cruise, 0.0);
        out.add((x.vp - p_.vf) * down_, sign * p_.amin);
    }
    [[nodiscard]] double tolerance() const noexcept {
        const double squares = p_.v0 * p_.v0 + p_.vf * p_.vf;
        return p_.tolerance + 16.0 * kEps * (squares * (up_ + down_) + std::fabs(p_.distance));
    }

private:
    const Problem& p_;
    double up_, down_;
    double foot_, top_;
};

double crossingDuration(const Hill& hill) noexcept {
    return hill.duration(hill.crossing());
}

/// The speed to hold for a given duration, in the mirrored problem if `mirror`; closed form on
/// either side of v0 and vf and between them.
bool hold(const Problem& p, double duration, Pieces& out) noexcept {
    const bool rising = p.vf > p.v0;
    const double a = rising ? p.amax : p.amin;
    const double ramps = (p.vf - p.v0) / a;
    const double ways = 0.5 * (p.vf - p.v0) * (p.vf + p.v0) / a;
    const double left = duration - ramps;
    if (!(left >= -8.0 * kEps * duration)) return false;
    const double vp = left > 0.0 ? (p.distance - ways) / left : p.v0;
    out.add((vp - p.v0) / a, a);
    out.add(left, 0.0);
    out.add((p.vf - vp) / a, a);
    return true;
}

/// vp above both ends: lesser root of a quadratic.
bool over(const Problem& p, double duration, double sign, Pieces& out) noexcept {
    const double u = 1.0 / p.amax;
    const double d = -1.0 / p.amin;
    const double foot = std::max(p.v0, p.vf);
    // With w = vp - foot: distance = distance at foot + w left - w^2 (u + d)/2
    const double left = duration - (foot - p.v0) * u - (foot - p.vf) * d;
    const double atFoot =
        0.5 * ((foot - p.v0) * (foot + p.v0) * u + (foot - p.vf) * (foot + p.vf) * d) + foot * left;
    const double missing = p.distance - atFoot;
    const double discriminant = left * left - 2.0 * (u + d) * missing;
    const double rounding = p.tolerance + 64.0 * kEps * (std::fabs(atFoot) + std::fabs(missing));
    if (discriminant < -2.0 * (u + d) * rounding) return false;
    const double w = 2.0 * missing / (left + std::sqrt(std::max(0.0, discriminant)));
    const double vp = foot + std::max(0.0, w);
    const double limit = std::max(p.vmax, foot);
    if (!(vp <= limit + kClip * std::fabs(limit))) return false;
    out.add((vp - p.v0) * u, sign * p.amax);
    out.add(duration - (vp - p.v0) * u - (vp - p.vf) * d, 0.0);
    out.add((vp - p.vf) * d, sign * p.amin);
    return true;
}

}  // namespace

void brakeSecondOrder(Problem& problem, Pieces& out) noexcept {
    const bool fast = problem.v0 > problem.vmax * (1.0 + kClip);
    if (!fast && !(problem.v0 < problem.vmin * (1.0 + kClip))) return;
    const double limit = fast ? problem.vmax : problem.vmin;
    const double a = fast ? problem.amin : problem.amax;
    const double time = (limit - problem.v0) / a;
    problem.distance -= 0.5 * time * (problem.v0 + limit);
    problem.v0 = limit;
    out.add(time, a);
}

double fastestSecondOrder(const Problem& problem, Pieces& out) noexcept {
    const Hill up{problem};
    const double missing = problem.distance - up.distance(up.foot());
    if (std::fabs(missing) <= up.tolerance()) {
        up.pieces(up.foot(), 1.0, out);
        return up.duration(up.foot());
    }
    if (missing > 0.0) {
        up.pieces(up.crossing(), 1.0, out);
        return crossingDuration(up);
    }
    const Problem mirror = mirrored(problem);
    const Hill down{mirror};
    down.pieces(down.crossing(), -1.0, out);
    return crossingDuration(down);
}

double firstPossibleSecondOrder(const Problem& problem, double notBefore) noexcept {
    Pieces unused;
    const double least = fastestSecondOrder(problem, unused);
    if (notBefore <= least) return least;
    const Problem mirror = mirrored(problem);
    const Hill up{problem};
    const Hill down{mirror};
    if (problem.distance > up.distance(up.lasting(notBefore)) + up.tolerance()) {
        return std::max(notBefore, crossingDuration(up));
    }
    if (mirror.distance > down.distance(down.lasting(notBefore)) + down.tolerance()) {
        return std::max(notBefore, crossingDuration(down));
    }
    return notBefore;
}

void secondOrderMarks(const Problem& problem, Marks& out) noexcept {
    const Problem mirror = mirrored(problem);
    for (const Hill& hill : {Hill{problem}, Hill{mirror}}) {
        static_cast<void>(out.push(hill.duration(hill.foot())));
        static_cast<void>(out.push(hill.duration(hill.crossing())));
        static_cast<void>(out.push(hill.duration(hill.fallingCrossing())));
    }
}

bool lastingSecondOrder(const Problem& problem, double duration, Pieces& out) noexcept {
    const double rise = std::max(problem.v0, problem.vf);
    const double fall = std::min(problem.v0, problem.vf);
    const double a = problem.vf > problem.v0 ? problem.amax : problem.amin;
    const double ramps = (problem.vf - problem.v0) / a;
    const double left = duration - ramps;
    const double ways = 0.5 * (problem.vf - problem.v0) * (problem.vf + problem.v0) / a;
    if (problem.distance > ways + rise * left) return over(problem, duration, 1.0, out);
    if (problem.distance < ways + fall * left) return over(mirrored(problem), duration, -1.0, out);
    return hold(problem, duration, out);
}

}  // namespace takt::planner::detail
