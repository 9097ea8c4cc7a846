// The part of a group that moves it: directly, or along paths that are planned ahead.
#include <algorithm>
#include <takt/axis/group.hpp>
#include <takt/axis/group_admit.hpp>

namespace takt::axis {

void Group::joinMembers() noexcept {
    GroupPoint positions{};
    for (std::size_t i = 0; i < size_; ++i) {
        members_[i]->joinGroup();
        positions[i] = members_[i]->view().set.count();
    }
    motion_.begin(view_.axes(), positions);
    joined_ = true;
}

void Group::leaveMembers() noexcept {
    if (!joined_) return;
    joined_ = false;
    for (Axis* member : members()) member->leaveGroup();
}

/// At rest, the first motion of the queue begins: a direct one now, a path when it is planned.
void Group::startFront() noexcept {
    while (view_.state == GroupState::Moving && motion_.resting() && !frontActive_ &&
           !queue_.empty() && !isPath(queue_.front().command.kind)) {
        activateFront();
        if (queue_.front().command.kind == GroupCommandKind::Halt) {
            endFront({CommandPhase::Done, ErrorId::None});
        } else {
            startDirect();
        }
    }
    if (view_.state == GroupState::Moving && motion_.resting() && queue_.empty())
        enter(GroupState::Standby);
}

void Group::startDirect() noexcept {
    GroupCommand& command = queue_.front().command;
    const GroupPoint from = motion_.positions();
    resolve(command, from, size_);
    ErrorId bad = checkWay(view_.axes(), command, from);
    if (bad == ErrorId::None) bad = motion_.runDirect(command.point, command.dynamics);
    if (bad != ErrorId::None) endFront({CommandPhase::Error, bad});
}

/// Motions at the end of the queue's path that no plan knows yet.
std::size_t Group::unplanned() const noexcept {
    std::size_t count = 0;
    for (std::size_t i = 0; i < queue_.size() && isPath(queue_[i].command.kind); ++i) {
        if (!queue_[i].planned) ++count;
    }
    return count;
}

void Group::askForPlan() noexcept {
    if (view_.state != GroupState::Moving || !planner_.free()) return;
    const planner::PathMotion* const running = motion_.path();
    if (running == nullptr && !motion_.resting()) return;
    const std::size_t wanted = unplanned();
    if (wanted == 0) return;

    GroupPlanner::Order& order = planner_.order();
    order = {};
    from_ = motion_.index() + lead_ - 1;
    // A path that has come to its end by then is not gone on with: the next one begins at rest.
    extends_ = running != nullptr && from_ < running->feed.cycles() ? running : nullptr;
    std::size_t room = GroupPlanner::MaxElements;
    order.start = motion_.positions();
    if (running != nullptr) {
        const planner::PathGeometry& path = running->geometry;
        const planner::PathElement& last = path.element(path.elementCount() - 1);
        for (std::size_t i = 0; i < size_; ++i) order.start[i] = last.to[i].count();
    }
    if (extends_ != nullptr) {
        const planner::PathGeometry& path = running->geometry;
        room -= path.elementCount() - path.elementAt(running->feed.at(from_).s);
    }
    order.members = view_.members;
    order.axes = size_;
    order.running = extends_;
    order.from = from_;
    for (std::size_t i = 0; i < queue_.size() && isPath(queue_[i].command.kind); ++i) {
        GroupQueue::Entry& entry = queue_[i];
        if (entry.planned) continue;
        if (order.items.size() == std::min(room, wanted)) break;
        order.items.push({entry.command, entry.serial});
        entry.planned = true;
    }
    if (order.items.empty()) return;
    due_ = view_.cycle + lead_;
    asked_ = true;
    planLate_ = false;
    planner_.ask();
}

void Group::waitForPlan() noexcept {
    if (!asked_ || view_.cycle < due_ || planner_.finished()) return;
    if (!planLate_) {
        planLate_ = true;
        ++latePlans_;
    }
    // A host that only halts for a moment is waited for; one that does not come back is not.
    constexpr auto Patience = std::chrono::seconds{1};
    const auto limit = static_cast<std::uint64_t>(Patience / cycle_);
    if (!motion_.resting() || view_.cycle - due_ < limit) return;
    fail(ErrorId::PlanningLate, {static_cast<double>(latePlans_), 0.0, 0.0});
}

void Group::takePlan() noexcept {
    if (!planner_.finished()) return;
    if (!asked_) {
        planner_.discard();  // what it was for has been aborted
        return;
    }
    if (view_.cycle < due_) return;
    // On a computer that is too slow for the latency the next plan is given as long twice over.
    if (planLate_) lead_ = std::min(MostLead, 2 * (view_.cycle - due_ + lead_));
    const bool inTime = extends_ != nullptr ? motion_.path() == extends_ && motion_.index() == from_
                                            : motion_.resting();
    asked_ = false;
    if (!inTime) {
        // Too late to go on from there: asked for again, further on.
        planner_.discard();
        for (std::size_t i = 0; i < planner_.order().items.size(); ++i) {
            for (std::size_t k = 0; k < queue_.size(); ++k) {
                if (queue_[k].serial == planner_.order().items[i].serial) queue_[k].planned = false;
            }
        }
        return;
    }
    const GroupPlanner::Plan plan = planner_.plan();
    if (plan.motion != nullptr) {
        // The last motion of a path that ended in this very cycle is done before the next begins.
        updateProgress();
        motion_.runPath(*plan.motion);
        pathEnd_ = planner_.order().items[plan.items - 1].serial;
    }
    const bool whole = plan.items == planner_.order().items.size();
    planner_.take();
    if (!view_.endKnown && whole && unplanned() == 0) {
        view_.end = plan.end;
        view_.endKnown = view_.pathLast;
    }
    if (!whole) refusePlanned(plan.error);
    if (plan.motion == nullptr && whole) {
        // Nothing had any length.
        while (!queue_.empty() && queue_.front().planned && motion_.resting())
            endFront({CommandPhase::Done, ErrorId::None});
    }
}

/// The motion behind the planned ones cannot be: what would come after it is not run either.
void Group::refusePlanned(ErrorId error) noexcept {
    const GroupPlanner::Plan& plan = planner_.plan();
    const std::uint32_t first = planner_.order().items[plan.items].serial;
    while (!queue_.empty()) {
        GroupQueue::Entry& last = queue_[queue_.size() - 1];
        if (last.serial < first) break;
        report(last.command.id, {CommandPhase::Error, error});
        queue_.dropLast();
    }
    if (queue_.empty()) frontActive_ = false;
    view_.queued = static_cast<std::uint8_t>(queue_.size() - (frontActive_ ? 1U : 0U));
    view_.endKnown = true;
    view_.end = plan.end;
    view_.pathLast = true;
}

}  // namespace takt::axis
