#include "look_ahead.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <takt/axis/admit.hpp>
#include <takt/axis/axis.hpp>
#include <takt/planner/speed_change.hpp>

namespace takt::axis {

using core::Distance;
using core::Position;
using core::Velocity;

namespace {

/// One command of the chain: the speed wanted at its beginning, the way it has to brake in, and the
/// speed it ends with when nothing comes behind.
struct Link {
    double wanted;
    double room;
    double endSpeed;
    planner::RampLimits braking;
};

double wantedSpeed(BufferMode mode, double previous, double next) noexcept {
    switch (mode) {
        case BufferMode::BlendingLow:
            return std::min(previous, next);
        case BufferMode::BlendingPrevious:
            return previous;
        case BufferMode::BlendingNext:
            return next;
        case BufferMode::BlendingHigh:
            return std::max(previous, next);
        case BufferMode::Aborting:
        case BufferMode::Buffered:
            break;
    }
    return 0.0;
}

/// The room between two positions that may be relied upon: less than it is, by its rounding.
double roomBetween(Position from, Position to) noexcept {
    const double largest = std::max(std::abs(from.count()), std::abs(to.count()));
    const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * largest;
    return std::max(0.0, std::abs((to - from).count()) * (1.0 - 1e-9) - rounding);
}

/// A velocity move has no end; a software limit ahead is one.
Link endlessLink(const AxisTraits& traits, const Command& move, const Arrival& before) noexcept {
    const double velocity = move.dynamics.velocity.count();
    const auto& limit = before.forward ? traits.limits.softPositive : traits.limits.softNegative;
    const bool turns = velocity == 0.0 || (velocity > 0.0) != before.forward;
    double room = std::numeric_limits<double>::infinity();
    if (limit) room = roomBetween(before.at, *limit);
    // A velocity has no speed of its own to blend with: the one before goes on.
    const bool blended = move.bufferMode > BufferMode::Buffered;
    return {blended && !turns ? before.speed.count() : 0.0, room, 0.0, {}};
}

/// \param[in,out] arrival of the command before; becomes that of this move
Link moveLink(const AxisTraits& traits, const Command& move, Arrival& arrival) noexcept {
    const Position goal = goalFrom(traits, move, arrival.at, !arrival.forward);
    const bool forward = goal > arrival.at;
    const bool goesOn = goal != arrival.at && forward == arrival.forward;
    const double speed = move.dynamics.velocity.count();
    Link link{0.0, roomBetween(arrival.at, goal), 0.0, {}};
    if (goesOn && checkTarget(traits, goal) == ErrorId::None) {
        link.wanted = wantedSpeed(move.bufferMode, arrival.speed.count(), speed);
    }
    const double end = move.endVelocity.count();
    link.endSpeed = std::max(0.0, forward ? end : -end);
    arrival = {goal, forward, Velocity{speed}};
    return link;
}

double moduloTravel(const AxisTraits& traits, const Command& move, double from,
                    bool backward) noexcept {
    const double period = traits.period.count();
    // Way forward in [0, period); less than half a count either way is "there already".
    double up = Scaling::foldInto(
        Scaling::foldInto(move.position.count(), period) - Scaling::foldInto(from, period), period);
    const double tolerance = traits.resolution.count() / 2.0;
    if (up < tolerance) return up;
    if (period - up < tolerance) return up - period;
    switch (move.direction) {
        case Direction::Positive:
            return up;
        case Direction::Negative:
            return up - period;
        case Direction::ShortestWay:
            return up <= period / 2.0 ? up : up - period;
        case Direction::Current:
            break;
    }
    return backward ? up - period : up;
}

}  // namespace

Position goalFrom(const AxisTraits& traits, const Command& move, Position from,
                  bool backward) noexcept {
    if (isRelative(move.kind)) return from + move.distance;
    if (traits.period <= Distance{}) return move.position;
    return from + Distance{moduloTravel(traits, move, from.count(), backward)};
}

Velocity jointSpeed(const AxisTraits& traits, const Arrival& arrival,
                    std::span<const Command> queue) noexcept {
    std::array<Link, Axis::MaxQueue> chain{};
    std::size_t links = 0;
    Arrival at = arrival;
    for (const Command& next : queue.first(std::min(queue.size(), chain.size()))) {
        const bool endless = next.kind == CommandKind::MoveVelocity;
        if (!endless && !isPositioning(next.kind)) break;  // begins at rest
        Link link = endless ? endlessLink(traits, next, at) : moveLink(traits, next, at);
        if (link.wanted <= 0.0) break;  // what comes behind a standstill does not matter
        link.braking = {next.dynamics.deceleration.count(), next.dynamics.jerk.count()};
        chain[links++] = link;
        if (isEndless(next.kind)) break;
    }
    if (links == 0) return Velocity{};
    double speed = chain[links - 1].endSpeed;
    for (std::size_t i = links; i-- > 0;) {
        speed = planner::fastestWithin(chain[i].room, speed, chain[i].wanted, chain[i].braking);
    }
    return Velocity{speed};
}

}  // namespace takt::axis
