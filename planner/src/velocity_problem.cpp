#include "velocity_problem.hpp"

namespace takt::planner::detail {

namespace {

/// Velocity gained when a goes straight from a0 to af at full jerk.
double directGain(const Problem& p) noexcept {
    const double squares = 0.5 * (p.af - p.a0) * (p.af + p.a0) / p.jerk;
    return p.af >= p.a0 ? squares : -squares;
}

double roundingOf(const Problem& p) noexcept {
    return 8.0 * kEps * (std::fabs(p.v0) + std::fabs(p.vf) + (p.a0 * p.a0 + p.af * p.af) / p.jerk);
}

/// Times of +J, constant acceleration and -J.
struct Swing {
    double up, hold, down;
    [[nodiscard]] double duration() const noexcept { return up + hold + down; }
};

/// Over a peak acceleration, vf - v0 >= directGain.
Swing overPeak(const Problem& p) noexcept {
    const double gain = p.vf - p.v0;
    const double half = 0.5 * (p.a0 * p.a0 + p.af * p.af);
    const double cap = std::max({p.amax, p.a0, p.af});
    double peak = std::sqrt(std::max(0.0, p.jerk * gain + half));
    double hold = 0.0;
    if (peak > cap) {
        hold = (gain - (cap * cap - half) / p.jerk) / cap;
        peak = cap;
    }
    peak = std::max({peak, p.a0, p.af});
    return {(peak - p.a0) / p.jerk, std::max(0.0, hold), (peak - p.af) / p.jerk};
}

void add(const Swing& swing, double jerk, Pieces& out) noexcept {
    out.add(swing.up, jerk);
    out.add(swing.hold, 0.0);
    out.add(swing.down, -jerk);
}

/// Velocity gained in `duration` when a is held at `level` for as long as possible.
double gainAt(const Problem& p, double level, double duration) noexcept {
    const double toLevel = std::fabs(level - p.a0) / p.jerk;
    const double fromLevel = std::fabs(p.af - level) / p.jerk;
    return 0.5 * (p.a0 + level) * toLevel + 0.5 * (level + p.af) * fromLevel +
           level * (duration - toLevel - fromLevel);
}

struct Range {
    double low, high;
};

/// Levels that can be reached and left within `duration`.
Range levels(const Problem& p, double duration) noexcept {
    const double sum = p.a0 + p.af;
    const double way = p.jerk * duration;
    const double low = std::min(p.a0, p.af);
    const double high = std::max(p.a0, p.af);
    return {std::clamp(0.5 * (sum - way), std::min(p.amin, low), low),
            std::clamp(0.5 * (sum + way), high, std::max(p.amax, high))};
}

/// The zero of gainAt - gain, which rises with the level; closed form in each of its three pieces.
double levelFor(const Problem& p, double duration, const Range& range, double gain) noexcept {
    const double low = std::min(p.a0, p.af);
    const double high = std::max(p.a0, p.af);
    const double half = 0.5 * (p.a0 * p.a0 + p.af * p.af);
    const double sum = p.a0 + p.af;
    const double way = p.jerk * duration;
    double level = 0.0;
    if (gain > gainAt(p, high, duration)) {  // -x^2 + (JT + sum) x - half = J gain, lesser root
        const double b = way + sum;
        const double root = std::sqrt(std::max(0.0, b * b - 4.0 * (half + p.jerk * gain)));
        level = 0.5 * (b - root);
    } else if (gain <
               gainAt(p, low, duration)) {  // x^2 + (JT - sum) x + half = J gain, greater root
        const double b = way - sum;
        const double root = std::sqrt(std::max(0.0, b * b - 4.0 * (half - p.jerk * gain)));
        level = 0.5 * (root - b);
    } else {
        const double atLow = gainAt(p, low, duration);
        const double slope = duration - (high - low) / p.jerk;
        level = slope > 0.0 ? low + (gain - atLow) / slope : low;
    }
    return std::clamp(level, range.low, range.high);
}

/// A blocked interval; none if the end is zero.
struct Gap {
    double begin, end;
};

/// The gap that follows the shortest durations: with both accelerations positive a dip gains
/// velocity too, and a longer one too much of it.
Gap gapOf(const Problem& p) noexcept {
    const double gain = p.vf - p.v0;
    if (!(p.a0 > 0.0 && p.af > 0.0) || gain < directGain(p)) return {0.0, 0.0};
    const double square = 0.5 * (p.a0 * p.a0 + p.af * p.af) - p.jerk * gain;
    if (!(square > 0.0)) return {0.0, 0.0};
    const double dip = std::sqrt(square);
    return {(p.a0 + p.af - 2.0 * dip) / p.jerk, overPeak(mirrored(p)).duration()};
}

}  // namespace

double fastestVelocity(const Problem& problem, Pieces& out) noexcept {
    const double missing = problem.vf - problem.v0 - directGain(problem);
    if (std::fabs(missing) <= roundingOf(problem)) {
        const double time = std::fabs(problem.af - problem.a0) / problem.jerk;
        out.add(time, problem.af > problem.a0 ? problem.jerk : -problem.jerk);
        return time;
    }
    const bool up = missing > 0.0;
    const Swing swing = overPeak(up ? problem : mirrored(problem));
    add(swing, up ? problem.jerk : -problem.jerk, out);
    return swing.duration();
}

double firstPossibleVelocity(const Problem& problem, double notBefore) noexcept {
    Pieces unused;
    const double least = fastestVelocity(problem, unused);
    if (notBefore <= least) return least;
    for (const Gap& gap : {gapOf(problem), gapOf(mirrored(problem))}) {
        if (notBefore > gap.begin && notBefore < gap.end) return gap.end;
    }
    return notBefore;
}

void velocityMarks(const Problem& problem, Marks& out) noexcept {
    for (const Gap& gap : {gapOf(problem), gapOf(mirrored(problem))}) {
        static_cast<void>(out.push(gap.begin));
        static_cast<void>(out.push(gap.end));
    }
}

bool velocityLasting(const Problem& problem, double duration, Pieces& out) noexcept {
    const double direct = std::fabs(problem.af - problem.a0) / problem.jerk;
    if (!(duration >= direct * (1.0 - 8.0 * kEps))) return false;
    const double gain = problem.vf - problem.v0;
    const Range range = levels(problem, duration);
    const double slack = roundingOf(problem) +
                         16.0 * kEps * duration * (std::fabs(range.low) + std::fabs(range.high));
    if (!(gain >= gainAt(problem, range.low, duration) - slack)) return false;
    if (!(gain <= gainAt(problem, range.high, duration) + slack)) return false;
    const double level = levelFor(problem, duration, range, gain);
    const double toLevel = std::fabs(level - problem.a0) / problem.jerk;
    const double fromLevel = std::fabs(problem.af - level) / problem.jerk;
    out.add(toLevel, level > problem.a0 ? problem.jerk : -problem.jerk);
    out.add(duration - toLevel - fromLevel, 0.0);
    out.add(fromLevel, problem.af > level ? problem.jerk : -problem.jerk);
    return true;
}

}  // namespace takt::planner::detail
