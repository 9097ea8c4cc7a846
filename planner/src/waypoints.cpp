#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <takt/planner/waypoints.hpp>

namespace takt::planner {

using core::Acceleration;
using core::Seconds;
using core::Velocity;

namespace {

/// Sweeps over all points, and how small a step of the search becomes, relative to the limits.
constexpr int kMostSweeps = 60;
constexpr double kFirstStep = 0.25;
constexpr double kLastStep = 1e-3;

/// What is gained must be more than rounding.
constexpr double kWorthwhile = 1e-9;

bool viable(const State& s, const Limits& l) noexcept {
    const double a = s.acceleration.count();
    const double v = s.velocity.count();
    const double swing = 0.5 * a * a / l.jerk.count();
    return a <= l.maxAcceleration.count() && a >= l.minAcceleration.count() &&
           v + swing <= l.maxVelocity.count() && v - swing >= l.minVelocity.count();
}

}  // namespace

WaypointTrajectory::WaypointTrajectory(std::size_t axes, std::size_t maxPoints)
    : axes_{axes}, maxPoints_{maxPoints}, passing_(maxPoints), probe_{axes} {
    assert(maxPoints >= 1);
    kept_.reserve(maxPoints);
    next_.reserve(maxPoints);
    for (std::size_t i = 0; i < maxPoints; ++i) {
        kept_.emplace_back(axes);
        next_.emplace_back(axes);
    }
    search_.states.resize((maxPoints + 1) * axes);
    search_.durations.resize(maxPoints);
    search_.requests.resize(axes);
    search_.trial.resize(axes);
}

void WaypointTrajectory::requestLeg(std::size_t leg, std::span<const Limits> limits) noexcept {
    for (std::size_t i = 0; i < axes_; ++i) {
        search_.requests[i] = {
            at(leg, i), {TargetKind::State, at(leg + 1, i)}, limits[i], true, {}};
    }
}

double WaypointTrajectory::legDuration(std::size_t leg, std::span<const Limits> limits) noexcept {
    requestLeg(leg, limits);
    const auto result = probe_.plan(search_.requests, {});
    return result.ok() ? result.value().count() : std::numeric_limits<double>::infinity();
}

/// The velocity between two slopes of one sign, none at a turn.
void WaypointTrajectory::guessPoint(std::size_t point, std::span<const Limits> limits) noexcept {
    double before = 0.0;
    double after = 0.0;
    for (std::size_t i = 0; i < axes_; ++i) {
        const double fastest =
            std::min(limits[i].maxVelocity.count(), -limits[i].minVelocity.count());
        const auto time = [&](std::size_t p) {
            return std::fabs((at(p + 1, i).position - at(p, i).position).count()) / fastest;
        };
        before = std::max(before, time(point - 1));
        after = std::max(after, time(point));
    }
    for (std::size_t i = 0; i < axes_; ++i) {
        const double in = (at(point, i).position - at(point - 1, i).position).count() / before;
        const double out = (at(point + 1, i).position - at(point, i).position).count() / after;
        const double mean = in * out > 0.0 ? 2.0 * in * out / (in + out) : 0.0;
        at(point, i).velocity = Velocity{std::isfinite(mean) ? 0.5 * mean : 0.0};
    }
}

void WaypointTrajectory::guess(std::span<const Limits> limits) noexcept {
    for (std::size_t p = 1; p < points_; ++p) guessPoint(p, limits);
    for (std::size_t leg = 0; leg < points_; ++leg)
        search_.durations[leg] = legDuration(leg, limits);
}

/// Takes the trial states of a point if the two legs at it become shorter together.
bool WaypointTrajectory::tryTrial(std::size_t point, std::span<const Limits> limits) noexcept {
    for (std::size_t i = 0; i < axes_; ++i) {
        if (!viable(search_.trial[i], limits[i])) return false;
    }
    const auto exchange = [&] {
        for (std::size_t i = 0; i < axes_; ++i) std::swap(at(point, i), search_.trial[i]);
    };
    const double old = search_.durations[point - 1] + search_.durations[point];
    exchange();
    const double in = legDuration(point - 1, limits);
    const double out = in < old ? legDuration(point, limits) : in;
    if (!(in + out < old * (1.0 - kWorthwhile))) {
        exchange();
        return false;
    }
    search_.durations[point - 1] = in;
    search_.durations[point] = out;
    return true;
}

/// All axes together: faster or slower, and more or less acceleration, along the direction of
/// motion.
bool WaypointTrajectory::stretch(std::size_t point, double step,
                                 std::span<const Limits> limits) noexcept {
    bool better = false;
    const auto reset = [&] {
        for (std::size_t i = 0; i < axes_; ++i) search_.trial[i] = at(point, i);
    };
    for (const double sign : {1.0, -1.0}) {
        reset();
        for (std::size_t i = 0; i < axes_; ++i) {
            search_.trial[i].velocity = search_.trial[i].velocity * (1.0 + sign * step);
        }
        better = tryTrial(point, limits) || better;
        reset();
        double share = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < axes_; ++i) {
            const double v = std::fabs(at(point, i).velocity.count());
            const double a =
                std::min(limits[i].maxAcceleration.count(), -limits[i].minAcceleration.count());
            if (v > 0.0) share = std::min(share, a / v);
        }
        if (!std::isfinite(share)) continue;
        for (std::size_t i = 0; i < axes_; ++i) {
            const double more = sign * step * share * at(point, i).velocity.count();
            search_.trial[i].acceleration += Acceleration{more};
        }
        better = tryTrial(point, limits) || better;
    }
    return better;
}

bool WaypointTrajectory::improve(std::size_t point, double step,
                                 std::span<const Limits> limits) noexcept {
    bool better = stretch(point, step, limits);
    for (std::size_t i = 0; i < axes_; ++i) {
        const Velocity v = (limits[i].maxVelocity - limits[i].minVelocity) * (0.5 * step);
        const Acceleration a =
            (limits[i].maxAcceleration - limits[i].minAcceleration) * (0.5 * step);
        for (const double sign : {1.0, -1.0}) {
            for (std::size_t k = 0; k < axes_; ++k) search_.trial[k] = at(point, k);
            search_.trial[i].velocity += v * sign;
            better = tryTrial(point, limits) || better;
            for (std::size_t k = 0; k < axes_; ++k) search_.trial[k] = at(point, k);
            search_.trial[i].acceleration += a * sign;
            better = tryTrial(point, limits) || better;
        }
    }
    return better;
}

core::Result<Seconds, InputFault> WaypointTrajectory::plan(
    std::span<const State> from, std::span<const core::Position> points,
    std::span<const Limits> limits) noexcept {
    if (from.size() != axes_ || limits.size() != axes_ || points.empty() ||
        points.size() % axes_ != 0 || points.size() / axes_ > maxPoints_) {
        return InputFault{PlanError::InvalidLimits, InputField::Axes, 0};
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t axis = i % axes_;
        auto fault = findFault(from[axis], {TargetKind::State, {points[i], {}, {}}}, limits[axis]);
        if (!fault) continue;
        if (fault->field == InputField::TargetPosition) fault->field = InputField::Waypoint;
        fault->axis = static_cast<std::uint8_t>(axis);
        return *fault;
    }
    points_ = points.size() / axes_;
    for (std::size_t i = 0; i < axes_; ++i) at(0, i) = from[i];
    for (std::size_t i = 0; i < points.size(); ++i) search_.states[axes_ + i] = {points[i], {}, {}};
    guess(limits);
    double step = kFirstStep;
    for (int sweep = 0; sweep < kMostSweeps && step > kLastStep; ++sweep) {
        bool better = false;
        for (std::size_t p = 1; p < points_; ++p) better = improve(p, step, limits) || better;
        if (!better) step *= 0.5;
    }
    for (std::size_t leg = 0; leg < points_; ++leg) {
        requestLeg(leg, limits);
        const auto result = next_[leg].plan(search_.requests, {});
        if (!result.ok()) return result.error();
    }
    kept_.swap(next_);
    legs_ = points_;
    duration_ = Seconds{};
    for (std::size_t leg = 0; leg < legs_; ++leg) {
        duration_ += kept_[leg].duration();
        passing_[leg] = duration_;
    }
    return duration_;
}

void WaypointTrajectory::sample(Seconds time, std::span<State> states) const noexcept {
    if (legs_ == 0) return;
    std::size_t leg = 0;
    while (leg + 1 < legs_ && time >= passing_[leg]) ++leg;
    const Seconds begin = leg == 0 ? Seconds{} : passing_[leg - 1];
    kept_[leg].sample(time - begin, states);
}

}  // namespace takt::planner
