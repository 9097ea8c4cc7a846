#include <algorithm>
#include <cmath>
#include <optional>
#include <takt/planner/path_brake.hpp>

namespace takt::planner {

namespace {

/// Steps of the look ahead, and their number for a recovery at the present pace.
constexpr int kMostLookAhead = 48;
constexpr double kLookAheadSteps = 24.0;

/// With a little less than may be had then, because its steps are coarse.
constexpr double kLookAheadShare = 0.96;
/// The direction turns by this angle in a step at most (radians).
constexpr double kLookAheadTurn = 0.03;

/// Of a jerk limit, what may be spent on stopping at once.
constexpr double kLastShare = 0.2;

/// One of the axes, or the path itself: its derivatives and its limits.
struct Direction {
    double d1;
    double d2;
    double d3;
    double down;  ///< accelerations, as magnitudes
    double up;
    double jerk;
};

/// Calls `f` for every axis and for the path, where the plan is `p`. Where the plan itself uses
/// more than a limit, the limit gives way.
template <typename F>
void forEachDirection(const PathGeometry& geometry, std::span<const PathAxisLimits> limits,
                      const PathFeed& path, const FeedState& p, F&& f) noexcept {
    PathDerivatives at;
    geometry.evaluate(p.s, at);
    const double v2 = p.s1 * p.s1;
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const double a = at.d1[i] * p.s2 + at.d2[i] * v2;
        const double j = at.d1[i] * p.s3 + 3.0 * at.d2[i] * p.s1 * p.s2 + at.d3[i] * v2 * p.s1;
        const double limit = limits[i].acceleration.count();
        f(Direction{at.d1[i], at.d2[i], at.d3[i], std::max(limit, -a), std::max(limit, a),
                    std::max(limits[i].jerk.count(), std::fabs(j))});
    }
    f(Direction{1.0, 0.0, 0.0, std::max(path.deceleration.count(), -p.s2), unlimited,
                std::max(path.jerk.count(), std::fabs(p.s3))});
}

/// Narrows a range to that of x with -low <= offset + slope x <= high.
template <typename Range>
void narrow(Range& range, double offset, double slope, double low, double high) noexcept {
    // What hardly depends on x cannot be helped by it.
    if (!(std::fabs(slope) > 1e-9)) return;
    const double a = (-low - offset) / slope;
    const double b = (high - offset) / slope;
    range.low = std::max(range.low, std::min(a, b));
    range.high = std::min(range.high, std::max(a, b));
}

}  // namespace

PathBrake::Place PathBrake::advanced(const Place& place, double jerk, double time) const noexcept {
    const FeedState& f = place.feed;
    Place out{{f.s + time * (f.s1 + time * (0.5 * f.s2 + time * jerk / 6.0)),
               f.s1 + time * (f.s2 + 0.5 * time * jerk), f.s2 + time * jerk, jerk},
              place.planTime};
    // The plan is here a little later than it was there; it is faster than the brake.
    const FeedState before = motion_->feed.atTime(place.planTime);
    if (before.s1 > 0.0) out.planTime += time * std::clamp(f.s1 / before.s1, 0.0, 1.0);
    for (int i = 0; i < 3; ++i) {
        out.planTime = std::min(out.planTime, restTime_);
        const FeedState p = motion_->feed.atTime(out.planTime);
        if (!(p.s1 > 0.0)) break;
        out.planTime += (out.feed.s - p.s) / p.s1;
    }
    out.planTime = std::clamp(out.planTime, place.planTime, restTime_);
    return out;
}

PathBrake::Room PathBrake::roomAt(const Place& place) const noexcept {
    const FeedState p = motion_->feed.atTime(place.planTime);
    const double v = place.feed.s1;
    const double a = place.feed.s2;
    Room room{};
    room.steady = unlimited;
    double bend = 0.0;
    double steep = 0.0;
    forEachDirection(motion_->geometry, {limits_.data(), axes_}, path_, p, [&](const Direction& d) {
        bend = std::max(bend, std::fabs(d.d2));
        steep = std::max(steep, std::fabs(d.d1));
        if (d.d1 != 0.0) room.steady = std::min(room.steady, d.jerk / std::fabs(d.d1));
        narrow(room.acceleration, d.d2 * v * v, d.d1, d.down, d.up);
        narrow(room.jerk, 3.0 * d.d2 * v * a + d.d3 * v * v * v, d.d1, d.jerk, d.jerk);
    });
    const double rate = p.s1 > 0.0 ? std::min(1.0, v / p.s1) : 1.0;
    room.followed = rate * rate * p.s2;
    room.turning = bend / steep * v;
    room.safe = bend > 0.0 ? room.followed : std::min(0.0, room.followed);
    return room;
}

/// What the jerk along the path may be in this cycle.
PathBrake::Range PathBrake::rangeNow() const noexcept {
    const double h = motion_->feed.cycle();
    Range range = roomAt(place_).jerk;
    const Room next = roomAt(advanced(place_, 0.0, h));
    range.low = std::max({range.low, next.jerk.low, (next.acceleration.low - place_.feed.s2) / h});
    range.high =
        std::min({range.high, next.jerk.high, (next.acceleration.high - place_.feed.s2) / h});
    if (range.low > range.high) range.low = range.high = 0.5 * (range.low + range.high);
    return range;
}

/// Whether the deceleration can be taken back to that of the plan, made evenly slower, or to none
/// on a straight line, within all limits and before the feed turns round.
bool PathBrake::recovers(Place place) const noexcept {
    double dt = 0.0;
    for (int i = 0; i < kMostLookAhead; ++i) {
        if (place.feed.s1 < 0.0) return false;
        if (place.planTime >= restTime_) return false;
        const Room room = roomAt(place);
        const double missing = room.safe - place.feed.s2;
        if (missing <= 1e-9) return true;
        if (place.feed.s2 < room.acceleration.low - 1e-9) return false;
        if (!(room.jerk.high > 0.0) || room.jerk.low > room.jerk.high) return false;
        if (i == 0) {
            // It has to be done before the velocity is used up: v/|a| at least, 2 v/|a| at most.
            const double left = 2.0 * place.feed.s1 / std::fabs(place.feed.s2);
            dt = std::min(missing / room.jerk.high, left) / kLookAheadSteps;
            dt = std::max(dt, motion_->feed.cycle());
        }
        const double high = kLookAheadShare * room.jerk.high;
        const double needed = missing / high;
        const double fine = std::max(motion_->feed.cycle(), kLookAheadTurn / room.turning);
        place = advanced(place, high, std::min({dt, needed, fine}));
    }
    return false;
}

/// Whether a jerk keeps the limits to the end of this cycle, and leaves a way on.
bool PathBrake::mayTake(double jerk) const noexcept {
    const Place next = advanced(place_, jerk, motion_->feed.cycle());
    const Room room = roomAt(next);
    const double slack = 1e-6 * std::fabs(jerk);
    return jerk >= room.jerk.low - slack && jerk <= room.jerk.high + slack && recovers(next);
}

std::optional<double> PathBrake::choose(const Range& range) noexcept {
    const double v = place_.feed.s1;
    const double a = place_.feed.s2;
    // The constant jerk with which velocity and acceleration become zero together.
    const double land = a < 0.0 && v > 0.0 ? 0.5 * a * a / v : 0.0;
    const double landing = std::min(land, range.high);
    landing_ = landing_ && land >= 0.5 * range.high && mayTake(landing);
    if (landing_) return landing;
    if (range.low < 0.0) {
        for (const double part : {1.0, 0.5, 0.25, 0.1, 0.03}) {
            if (mayTake(part * range.low)) return part * range.low;
        }
    }
    if (range.low <= 0.0 && range.high >= 0.0 && mayTake(0.0)) return 0.0;
    landing_ = land >= 0.5 * range.high && mayTake(landing);
    if (landing_) return landing;
    return std::nullopt;
}

/// What is left of the motion is so little that it may end between two cycles.
bool PathBrake::mayStopHere() const noexcept {
    const double h = motion_->feed.cycle();
    const double v = place_.feed.s1;
    const FeedState p = motion_->feed.atTime(place_.planTime);
    bool may = true;
    forEachDirection(motion_->geometry, {limits_.data(), axes_}, path_, p, [&](const Direction& d) {
        const double a = std::fabs(d.d1 * place_.feed.s2 + d.d2 * v * v);
        may = may && std::fabs(d.d1) * v + a * h <= kLastShare * d.jerk * h * h;
    });
    return may;
}

/// One cycle of the plan, evenly slower: the limits are kept whatever comes.
void PathBrake::follow() noexcept {
    const FeedState p = motion_->feed.atTime(place_.planTime);
    const double rate = p.s1 > 0.0 ? std::min(1.0, place_.feed.s1 / p.s1) : 1.0;
    place_.planTime += rate * motion_->feed.cycle();
    if (place_.planTime >= restTime_) {
        rest(restPlace_);
        return;
    }
    const FeedState next = motion_->feed.atTime(place_.planTime);
    place_.feed = {next.s, rate * next.s1, rate * rate * next.s2, rate * rate * rate * next.s3};
}

void PathBrake::rest(double s) noexcept {
    place_.feed = {s, 0.0, 0.0, 0.0};
    atRest_ = true;
}

void PathBrake::start(const PathMotion& motion, std::uint64_t cycle,
                      std::span<const PathAxisLimits> limits, const PathFeed& path) noexcept {
    motion_ = &motion;
    setLimits(limits, path);
    place_ = {motion.feed.at(cycle), static_cast<double>(cycle) * motion.feed.cycle()};
    restTime_ = motion.feed.restAfter(place_.planTime);
    restPlace_ = motion.feed.atTime(restTime_).s;
    landing_ = false;
    atRest_ = place_.feed.s1 == 0.0 && place_.feed.s2 == 0.0;
}

void PathBrake::setLimits(std::span<const PathAxisLimits> limits, const PathFeed& path) noexcept {
    axes_ = limits.size();
    std::copy(limits.begin(), limits.end(), limits_.begin());
    path_ = path;
}

FeedState PathBrake::step() noexcept {
    if (atRest_) return place_.feed;
    const double h = motion_->feed.cycle();
    if (mayStopHere()) {
        rest(place_.feed.s);
        return place_.feed;
    }
    const Range range = rangeNow();
    const std::optional<double> braking = choose(range);
    const Room room = roomAt(place_);
    const double v = place_.feed.s1;
    const double a = place_.feed.s2;
    const bool follows = a >= room.followed - 1e-6 * (1.0 + std::fabs(room.followed));
    if (!braking && follows) {
        follow();
        return place_.feed;
    }
    // Where no way on was left by what lies ahead, back towards the plan at the pace of the axes.
    const double back = room.jerk.high > 0.0 ? room.jerk.high : 0.5 * room.steady;
    double jerk = braking.value_or(back);
    const double turn = a < 0.0 && jerk > 0.0 ? -a / jerk : unlimited;
    if (turn <= h && v + 0.5 * a * turn <= 1e-9 * v) {
        // On the parabola down to zero within this cycle.
        rest(std::min(restPlace_, place_.feed.s + v * std::min(turn, -2.0 * v / a) / 3.0));
        return place_.feed;
    }
    Place next = advanced(place_, jerk, h);
    const double followed = roomAt(next).followed;
    if (next.feed.s2 > followed && follows) {
        follow();
        return place_.feed;
    }
    if (next.feed.s2 > followed) {
        jerk = std::min(jerk, (followed - a) / h);
        next = advanced(place_, jerk, h);
    }
    if (next.feed.s >= restPlace_ || !(next.feed.s1 > 0.0)) {
        rest(std::min(restPlace_, std::max(next.feed.s, place_.feed.s)));
    } else {
        place_ = next;
    }
    return place_.feed;
}

}  // namespace takt::planner
