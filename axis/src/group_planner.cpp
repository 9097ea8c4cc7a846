#include <algorithm>
#include <takt/axis/group_admit.hpp>
#include <takt/axis/group_planner.hpp>

#include "group_way.hpp"

namespace takt::axis {

using planner::PathElement;

namespace {

core::Velocity jointVelocity(BufferMode mode, core::Velocity before,
                             core::Velocity after) noexcept {
    switch (mode) {
        case BufferMode::BlendingLow:
            return std::min(before, after);
        case BufferMode::BlendingPrevious:
            return before;
        case BufferMode::BlendingNext:
            return after;
        case BufferMode::BlendingHigh:
            return std::max(before, after);
        case BufferMode::Aborting:
        case BufferMode::Buffered:
            break;
    }
    return core::Velocity{};
}

/// How the path goes on from the motion before `command`.
planner::Transition jointTo(const GroupCommand& command, core::Velocity before) noexcept {
    planner::Transition joint;
    if (command.bufferMode <= BufferMode::Buffered) return joint;
    const Transition& asked = command.transition;
    joint.mode = planner::TransitionMode::Exact;
    joint.size = core::Distance{asked.parameter};
    if (asked.mode == TransitionMode::CornerDistance)
        joint.mode = planner::TransitionMode::CornerDistance;
    if (asked.mode == TransitionMode::MaxCornerDeviation)
        joint.mode = planner::TransitionMode::CornerDeviation;
    joint.velocity = jointVelocity(command.bufferMode, before, command.dynamics.velocity);
    if (asked.velocity > core::Velocity{})
        joint.velocity = std::min(joint.velocity, asked.velocity);
    return joint;
}

}  // namespace

GroupPlanner::GroupPlanner(core::Duration cycle) : cycle_{cycle} {
    elements_.reserve(MaxElements);
}

void GroupPlanner::take() noexcept {
    if (plan_.motion != nullptr) spare_ = 1 - spare_;
    slot_.release();
}

void GroupPlanner::makePlanner() {
    if (planner_ && axes_ == order_.axes && members_ == order_.members) return;
    axes_ = order_.axes;
    members_ = order_.members;
    std::vector<planner::PathAxisLimits> limits;
    for (std::size_t i = 0; i < axes_; ++i) {
        const LimitParams& l = members_[i]->limits;
        limits.push_back({l.velocity, std::min(l.acceleration, l.deceleration), l.jerk});
    }
    const core::Seconds cycle{std::chrono::duration<double>(cycle_).count()};
    planner_.emplace(pathSpace(axes_), limits, cycle, MaxElements);
    // The other one may still be looked at; it is made anew when its turn comes.
    motions_[spare_].reset();
}

void GroupPlanner::work() {
    makePlanner();
    if (!motions_[spare_] || motions_[spare_]->geometry.space().axes != axes_)
        motions_[spare_].emplace(planner_->motion());
    plan_ = {};
    elements_.clear();
    joint_ = {};
    if (order_.running != nullptr) {
        const planner::PathGeometry& path = order_.running->geometry;
        velocity_ = path.element(path.elementCount() - 1).feed.velocity;
    }
    GroupPoint from = order_.start;
    for (Item& item : order_.items) {
        if (!addElement(item, from)) break;
        ++plan_.items;
    }
    makePlan(from);
    slot_.finish();
}

bool GroupPlanner::addElement(Item& item, GroupPoint& from) {
    GroupCommand& command = item.command;
    resolve(command, from, axes_);
    plan_.error = checkWay({members_.data(), axes_}, command, from);
    if (plan_.error != ErrorId::None) return false;
    const bool first = elements_.empty();
    planner::Transition joint = jointTo(command, velocity_);
    planner::Transition& before = first ? joint_ : elements_.back().transition;
    const auto made = elementOf(command, from, axes_);
    if (!made.ok()) {
        plan_.error = errorOf(made.error());
        return plan_.error == ErrorId::None;  // nothing to move: the next one goes on from here
    }
    before = joint;
    PathElement element = made.value();
    const Dynamics& d = command.dynamics;
    element.feed = {d.velocity, d.acceleration, d.deceleration, d.jerk};
    element.tag = item.serial;
    elements_.push_back(element);
    velocity_ = d.velocity;
    from = command.point;
    return true;
}

void GroupPlanner::makePlan(const GroupPoint& end) {
    plan_.end = end;
    if (elements_.empty()) return;
    const auto planned = planElements();
    if (planned.ok()) {
        plan_.motion = &*motions_[spare_];
        return;
    }
    plan_.items = 0;
    plan_.end = order_.start;
    plan_.error = errorOf(planned.error());
    if (plan_.error == ErrorId::None) plan_.error = ErrorId::ProfileNotFeasible;
}

core::Result<std::uint64_t, planner::PathError> GroupPlanner::planElements() {
    planner::PathMotion& out = *motions_[spare_];
    if (order_.running == nullptr) return planner_->plan(elements_, out);
    return planner_->extend(*order_.running, order_.from, elements_, out, joint_);
}

}  // namespace takt::axis
