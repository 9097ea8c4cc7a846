#include <algorithm>
#include <cmath>
#include <takt/planner/path_brake.hpp>

namespace takt::planner {

namespace {

/// Steps of the look ahead, and their number for a recovery at the present pace.
constexpr int kMostLookAhead = 32;
constexpr double kLookAheadSteps = 12.0;

/// Of a jerk limit, what may be spent on stopping at once.
constexpr double kLastShare = 0.2;

/// Velocity, acceleration and jerk that a plan has in one direction, and the limits there.
struct Direction {
    double v;
    double a;
    double j;
    double down;  ///< acceleration, as magnitudes
    double up;
    double jerk;
};

/// Calls `f` for every axis and for the path at a moment of the plan.
template <typename F>
void forEachDirection(const PathMotion& motion, std::span<const PathAxisLimits> limits,
                      const PathFeed& path, double time, F&& f) noexcept {
    const FeedState p = motion.feed.atTime(time);
    PathDerivatives at;
    motion.geometry.evaluate(p.s, at);
    // Where the plan itself uses more, the limit gives way: as planned is always allowed.
    const auto call = [&](double v, double a, double j, double down, double up, double jerk) {
        f(Direction{v, a, j, std::max(down, -a), std::max(up, a), std::max(jerk, std::fabs(j))});
    };
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const double a = limits[i].acceleration.count();
        call(at.d1[i] * p.s1, at.d1[i] * p.s2 + at.d2[i] * p.s1 * p.s1,
             at.d1[i] * p.s3 + 3.0 * at.d2[i] * p.s1 * p.s2 + at.d3[i] * p.s1 * p.s1 * p.s1, a, a,
             limits[i].jerk.count());
    }
    call(p.s1, p.s2, p.s3, path.deceleration.count(), unlimited, path.jerk.count());
}

/// Narrows a range to that of x with low <= offset + slope x <= high.
template <typename Range>
void narrow(Range& range, double offset, double slope, double low, double high) noexcept {
    // What hardly depends on x cannot be helped by it.
    if (!(std::fabs(slope) > 1e-9)) return;
    const double a = (low - offset) / slope;
    const double b = (high - offset) / slope;
    range.low = std::max(range.low, std::min(a, b));
    range.high = std::min(range.high, std::max(a, b));
}

template <typename Clock>
Clock advanced(const Clock& c, double rate2, double dt) noexcept {
    return {c.time + dt * (c.rate + dt * (0.5 * c.rate1 + dt * rate2 / 6.0)),
            c.rate + dt * (c.rate1 + 0.5 * dt * rate2), c.rate1 + dt * rate2};
}

}  // namespace

/// With the clock at rate r the velocities of the plan become r v, the accelerations r^2 a + r' v,
/// the jerks r^3 j + 3 r r' a + r'' v.
PathBrake::Room PathBrake::roomAt(const Clock& clock) const noexcept {
    Room room{{-unlimited, unlimited}, {-unlimited, unlimited}};
    const double r = clock.rate;
    forEachDirection(*motion_, {limits_.data(), axes_}, path_, clock.time,
                     [&](const Direction& d) {
                         narrow(room.rate1, r * r * d.a, d.v, -d.down, d.up);
                         narrow(room.rate2, r * r * r * d.j + 3.0 * r * clock.rate1 * d.a, d.v,
                                -d.jerk, d.jerk);
                     });
    return room;
}

/// What the second derivative of the clock may be in this cycle.
PathBrake::Range PathBrake::rangeNow() const noexcept {
    const double h = motion_->feed.cycle();
    Range range = roomAt(clock_).rate2;
    const Room next = roomAt(advanced(clock_, 0.0, h));
    range.low = std::max({range.low, next.rate2.low, (next.rate1.low - clock_.rate1) / h});
    range.high = std::min({range.high, next.rate2.high, (next.rate1.high - clock_.rate1) / h});
    if (range.low > range.high) range.low = range.high = 0.5 * (range.low + range.high);
    return range;
}

/// Whether the rate can be made constant from here within all limits and before it is zero. After
/// that it may stay constant for good: the plan, slower, keeps all limits.
bool PathBrake::recovers(Clock clock) const noexcept {
    const double h = motion_->feed.cycle();
    double dt = 0.0;
    for (int i = 0; i < kMostLookAhead; ++i) {
        if (clock.rate1 >= 0.0) return clock.rate >= 0.0;
        const Room room = roomAt(clock);
        const double slack = 1e-9 * std::fabs(clock.rate1);
        if (clock.rate1 < room.rate1.low - slack) return false;
        if (!(room.rate2.high > 0.0) || room.rate2.low > room.rate2.high) return false;
        if (i == 0) dt = std::max(h, -clock.rate1 / room.rate2.high / kLookAheadSteps);
        clock = advanced(clock, std::min(room.rate2.high, -clock.rate1 / dt), dt);
        if (clock.rate < 0.0) return false;
        if (clock.time >= restTime_) return true;
    }
    return false;
}

double PathBrake::choose(const Range& range) noexcept {
    const double h = motion_->feed.cycle();
    // The constant value with which rate and derivative become zero together.
    const double land = clock_.rate1 < 0.0 ? 0.5 * clock_.rate1 * clock_.rate1 / clock_.rate : 0.0;
    if (landing_ && land >= 0.5 * range.high) {
        const double up = std::min(land, range.high);
        return recovers(advanced(clock_, up, h)) ? up : range.high;
    }
    landing_ = false;
    if (range.low < 0.0) {
        for (const double part : {1.0, 0.5, 0.25, 0.1}) {
            if (recovers(advanced(clock_, part * range.low, h))) return part * range.low;
        }
    }
    if (range.low <= 0.0 && range.high >= 0.0 && recovers(advanced(clock_, 0.0, h))) return 0.0;
    landing_ = true;
    return std::clamp(land, range.low, range.high);
}

/// What is left of the motion is so little that it may end between two cycles.
bool PathBrake::mayStopHere() const noexcept {
    const double h = motion_->feed.cycle();
    bool may = true;
    forEachDirection(*motion_, {limits_.data(), axes_}, path_, clock_.time,
                     [&](const Direction& d) {
                         const double v = std::fabs(clock_.rate * d.v);
                         const double a =
                             std::fabs(clock_.rate * clock_.rate * d.a + clock_.rate1 * d.v);
                         may = may && v + a * h <= kLastShare * d.jerk * h * h;
                     });
    return may;
}

FeedState PathBrake::stateOf(const Clock& clock) const noexcept {
    const FeedState p = motion_->feed.atTime(clock.time);
    return {p.s, clock.rate * p.s1, clock.rate * clock.rate * p.s2 + clock.rate1 * p.s1, 0.0};
}

void PathBrake::rest(double time) noexcept {
    state_ = {motion_->feed.atTime(time).s, 0.0, 0.0, 0.0};
    atRest_ = true;
}

void PathBrake::start(const PathMotion& motion, std::uint64_t cycle,
                      std::span<const PathAxisLimits> limits, const PathFeed& path) noexcept {
    motion_ = &motion;
    setLimits(limits, path);
    clock_ = {static_cast<double>(cycle) * motion.feed.cycle(), 1.0, 0.0};
    restTime_ = motion.feed.restAfter(clock_.time);
    state_ = motion.feed.at(cycle);
    landing_ = false;
    atRest_ = state_.s1 == 0.0 && state_.s2 == 0.0;
}

void PathBrake::setLimits(std::span<const PathAxisLimits> limits, const PathFeed& path) noexcept {
    axes_ = limits.size();
    std::copy(limits.begin(), limits.end(), limits_.begin());
    path_ = path;
}

FeedState PathBrake::step() noexcept {
    if (atRest_) return state_;
    const double h = motion_->feed.cycle();
    if (mayStopHere()) {
        rest(clock_.time);
        return state_;
    }
    double rate2 = choose(rangeNow());
    const double turn = clock_.rate1 < 0.0 && rate2 > 0.0 ? -clock_.rate1 / rate2 : unlimited;
    const double lowest = clock_.rate + 0.5 * clock_.rate1 * turn;
    if (turn <= h && lowest <= 1e-9 * clock_.rate) {
        // On the parabola down to zero within this cycle: a third of rate times the time left.
        rest(std::min(restTime_, clock_.time + clock_.rate * turn / 3.0));
        return state_;
    }
    if (turn <= h) rate2 = -clock_.rate1 / h;
    clock_ = advanced(clock_, rate2, h);
    if (clock_.time >= restTime_ || !(clock_.rate > 0.0)) {
        rest(std::min(restTime_, clock_.time));
    } else {
        state_ = stateOf(clock_);
    }
    return state_;
}

}  // namespace takt::planner
