#include "route_office.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <takt/planner/roadmap/route_trial.hpp>

namespace takt::daemon {

namespace roadmap = planner::roadmap;
using axis::ErrorId;
using axis::RouteDesk;

namespace {

ErrorId errorOf(roadmap::RouteFault fault) noexcept {
    switch (fault) {
        case roadmap::RouteFault::None:
            return ErrorId::None;
        case roadmap::RouteFault::BadRequest:
            return ErrorId::InvalidParameter;
        case roadmap::RouteFault::StartOutsideLimits:
            return ErrorId::StartOutsideSWLimit;
        case roadmap::RouteFault::GoalOutsideLimits:
            return ErrorId::TargetOutsideSWLimit;
        case roadmap::RouteFault::StartInKeepOut:
            return ErrorId::StartInKeepOut;
        case roadmap::RouteFault::GoalInKeepOut:
            return ErrorId::GoalInKeepOut;
        case roadmap::RouteFault::NoRoute:
            break;
    }
    return ErrorId::RouteNotFound;
}

bool namesKeepOut(roadmap::RouteFault fault) noexcept {
    return fault == roadmap::RouteFault::StartInKeepOut ||
           fault == roadmap::RouteFault::GoalInKeepOut;
}

axis::PathData pathOf(const roadmap::RouteAnswer& route) {
    axis::PathData path;
    const auto copy = [](const roadmap::RoutePoint& point, axis::GroupPoint& out) {
        std::copy(point.position.begin(), point.position.end(), out.begin());
    };
    copy(route.points.front(), path.start);
    for (std::size_t i = 1; i < route.points.size(); ++i) {
        axis::GroupPoint point{};
        copy(route.points[i], point);
        path.lineTo(point, route.points[i].corner.count());
    }
    return path;
}

RouteDesk::Answer refusal(ErrorId error) {
    RouteDesk::Answer answer;
    answer.error = error;
    return answer;
}

}  // namespace

RouteOffice::RouteOffice(const config::MachineConfig& machine, const Axes& axes,
                         std::vector<ProgramHost>& programs)
    : cycle_{std::chrono::duration<double>(machine.network.cycle).count()} {
    for (const roadmap::ObstacleParams& params : machine.obstacles) {
        for (ProgramHost& program : programs) {
            RouteDesk& desk = *program.routes()[params.group];
            desk.serve(params.latencyCycles);
            posts_.push_back({&desk, grounds_.size()});
        }
        grounds_.push_back(groundOf(params, machine.groups[params.group], axes));
    }
}

RouteOffice::Ground RouteOffice::groundOf(const roadmap::ObstacleParams& params,
                                          const axis::GroupParams& group, const Axes& axes) {
    Ground ground;
    ground.obstacles = roadmap::Obstacles{params.keepOuts};
    for (const std::size_t index : group.axes) {
        const axis::AxisTraits* const traits = axes[index].view().traits;
        const axis::LimitParams& limits = traits->limits;
        ground.members.push_back(traits);
        // The machine file has both limits of every axis of a group with obstacles.
        ground.axes.push_back({limits.softNegative.value_or(core::Position{}),
                               limits.softPositive.value_or(core::Position{}), limits.velocity});
        ground.limits.push_back(
            {limits.velocity, std::min(limits.acceleration, limits.deceleration), limits.jerk});
    }
    const axis::PathLimitParams& path = group.limits;
    ground.feed = {path.velocity, path.acceleration, path.deceleration, path.jerk};
    return ground;
}

bool RouteOffice::takeCalls() noexcept {
    bool called = false;
    for (const Post& post : posts_) called = post.desk->takeCall() || called;
    return called;
}

void RouteOffice::work() {
    for (const Post& post : posts_) {
        if (post.desk->wanted())
            post.desk->finish(answer(grounds_[post.ground], post.desk->order()));
    }
}

RouteDesk::Answer RouteOffice::answer(const Ground& ground, const RouteDesk::Order& order) const {
    const std::size_t axes = ground.axes.size();
    // The keep-outs are those of the axes in the machine file, place by place.
    const bool same =
        std::equal(ground.members.begin(), ground.members.end(), order.members.begin()) &&
        (axes == order.members.size() || order.members[axes] == nullptr);
    if (!same) return refusal(ErrorId::InvalidState);
    try {
        return plan(ground, order);
    } catch (const std::exception&) {
        return refusal(ErrorId::ProfileNotFeasible);  // no memory, or the search library gave up
    }
}

RouteDesk::Answer RouteOffice::plan(const Ground& ground, const RouteDesk::Order& order) const {
    const std::size_t axes = ground.axes.size();
    roadmap::RouteRequest request;
    request.start = roadmap::Point{order.start}.first(axes);
    request.goal = roadmap::Point{order.goal}.first(axes);
    request.axes = ground.axes;
    request.pathAxes = axis::CartesianAxes;
    request.rounding = core::Distance{order.rounding};
    request.seed = order.seed;
    const roadmap::RouteAnswer route = roadmap::planRoute(request, ground.obstacles);
    if (!route.ok()) {
        RouteDesk::Answer refused = refusal(errorOf(route.fault));
        if (namesKeepOut(route.fault))
            refused.keepOut = static_cast<std::uint32_t>(route.which) + 1;
        return refused;
    }
    if (route.points.size() > axis::PathData::MaxSegments + 1) return refusal(ErrorId::BufferFull);
    const planner::PathSpace space{axes, std::min(axes, axis::CartesianAxes)};
    const roadmap::TrialResult trial =
        roadmap::tryRoute(route, {space, ground.limits, ground.feed, cycle_}, ground.obstacles);
    if (trial.fault == roadmap::TrialFault::Collision) return refusal(ErrorId::RouteNotFound);
    if (trial.fault != roadmap::TrialFault::None) return refusal(ErrorId::ProfileNotFeasible);
    RouteDesk::Answer found;
    found.duration = trial.duration.count();
    found.path = pathOf(route);
    return found;
}

}  // namespace takt::daemon
