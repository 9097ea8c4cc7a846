#include <array>
#include <cmath>
#include <limits>
#include <takt/planner/profile_query.hpp>

#include "axis_plan.hpp"

namespace takt::planner {

using core::Position;
using core::Seconds;

namespace {

constexpr int kMostSteps = 100;

/// A piece as bare numbers, its beginning the origin.
struct Cubic {
    double v, a, j, length;

    explicit Cubic(const Segment& s) noexcept
        : v{s.from.velocity.count()},
          a{s.from.acceleration.count()},
          j{s.jerk.count()},
          length{s.duration.count()} {}

    [[nodiscard]] double at(double t) const noexcept {
        return t * (v + t * (0.5 * a + t * j * (1.0 / 6.0)));
    }
    [[nodiscard]] double speed(double t) const noexcept { return v + t * (a + 0.5 * t * j); }
};

/// Times at which a piece turns, in order, with its end behind them.
struct Turns {
    std::array<double, 3> times{};
    std::size_t size{0};

    explicit Turns(const Cubic& c) noexcept {
        double first = std::numeric_limits<double>::infinity();
        double second = first;
        if (c.j == 0.0) {
            if (c.a != 0.0) first = -c.v / c.a;
        } else if (const double d = c.a * c.a - 2.0 * c.j * c.v; d >= 0.0) {
            const double q = -(c.a + std::copysign(std::sqrt(d), c.a));
            first = q / c.j;
            second = q != 0.0 ? 2.0 * c.v / q : first;
            if (second < first) std::swap(first, second);
        }
        for (const double t : {first, second}) {
            if (t > 0.0 && t < c.length) times[size++] = t;
        }
        times[size++] = c.length;
    }
};

/// Where a monotone part of a piece takes the value; its ends lie on either side of it.
double crossing(const Cubic& c, double lo, double hi, double value) noexcept {
    const bool rising = c.at(hi) > c.at(lo);
    double t = 0.5 * (lo + hi);
    for (int i = 0; i < kMostSteps; ++i) {
        const double miss = c.at(t) - value;
        ((miss > 0.0) == rising ? hi : lo) = t;
        double next = t - miss / c.speed(t);
        if (!(next >= lo && next <= hi)) next = 0.5 * (lo + hi);
        if (std::fabs(next - t) <= 2.0 * detail::kEps * c.length) return next;
        t = next;
    }
    return t;
}

void widen(PositionExtremes& e, Position p, Seconds at) noexcept {
    if (p < e.lowest) {
        e.lowest = p;
        e.atLowest = at;
    }
    if (p > e.highest) {
        e.highest = p;
        e.atHighest = at;
    }
}

}  // namespace

PositionExtremes extremesOf(const Profile& profile) noexcept {
    const Position start = sample(profile, Seconds{0.0}).position;
    PositionExtremes extremes{start, start, {}, {}};
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const Cubic piece{profile[i]};
        const Turns turns{piece};
        for (std::size_t k = 0; k < turns.size; ++k) {
            const double t = turns.times[k];
            widen(extremes, profile[i].from.position + core::Distance{piece.at(t)},
                  profile[i].start + Seconds{t});
        }
    }
    widen(extremes, profile.end().position, profile.duration());
    return extremes;
}

std::optional<Seconds> firstTimeAt(const Profile& profile, Position position,
                                   Seconds notBefore) noexcept {
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const Cubic piece{profile[i]};
        double from = std::max(0.0, (notBefore - profile[i].start).count());
        if (from > piece.length) continue;
        const double value = (position - profile[i].from.position).count();
        const State& after = i + 1 < profile.size() ? profile[i + 1].from : profile.end();
        const double next = (after.position - profile[i].from.position).count();
        const Turns turns{piece};
        for (std::size_t k = 0; k < turns.size; ++k) {
            const double to = turns.times[k];
            if (to < from) continue;
            const double low = std::min(piece.at(from), piece.at(to));
            const double high = std::max(piece.at(from), piece.at(to));
            // Pieces join up to rounding of positions and times only.
            const double joint = k + 1 == turns.size ? next : piece.at(to);
            const double slack = 4.0 * detail::kEps *
                                 (std::fabs(position.count()) + std::fabs(value) +
                                  std::fabs(piece.speed(to)) * profile.duration().count());
            if (value >= std::min(low, joint) - slack && value <= std::max(high, joint) + slack) {
                const double inside = std::clamp(value, low, high);
                const double t = low == high ? from : crossing(piece, from, to, inside);
                return profile[i].start + Seconds{t};
            }
            from = to;
        }
    }
    if (position == profile.end().position && notBefore <= profile.duration()) {
        return profile.duration();
    }
    return std::nullopt;
}

core::Result<DurationIntervals, PlanError> possibleDurations(const State& from,
                                                             const Target& target,
                                                             const Limits& limits) noexcept {
    if (const auto fault = findFault(from, target, limits)) return fault->error;
    detail::AxisPlan axis;
    axis.begin(from, target, limits, {});
    if (!(axis.duration() >= 0.0)) return PlanError::NoSolution;
    detail::Marks marks;
    axis.marks(marks);
    DurationIntervals intervals;
    const double inf = std::numeric_limits<double>::infinity();
    double begin = axis.duration();
    for (std::size_t i = 0; i < marks.size(); ++i) {
        // Between two marks everything is possible or nothing is.
        const double end = i + 1 < marks.size() ? marks[i + 1] : 2.0 * marks[i] + 1.0;
        const double middle = 0.5 * (marks[i] + end);
        if (axis.firstPossible(middle) <= middle) continue;
        if (marks[i] > begin || intervals.empty()) {
            static_cast<void>(intervals.push({Seconds{begin}, Seconds{std::max(begin, marks[i])}}));
        }
        begin = axis.firstPossible(middle);
    }
    static_cast<void>(intervals.push({Seconds{begin}, Seconds{inf}}));
    return intervals;
}

core::Result<Profile, PlanError> planLasting(const State& from, const Target& target,
                                             const Limits& limits, Seconds duration) noexcept {
    if (const auto fault = findFault(from, target, limits)) return fault->error;
    if (!std::isfinite(duration.count())) return PlanError::NotFinite;
    detail::AxisPlan axis;
    axis.begin(from, target, limits, {});
    Profile profile;
    if (!axis.writeLasting(duration.count(), profile)) return PlanError::NoSolution;
    return profile;
}

}  // namespace takt::planner
