#include <algorithm>
#include <takt/program/machine.hpp>
#include <utility>

namespace takt::program {

Machine::Machine(std::vector<NamedAxis> axes, std::vector<NamedGroup> groups,
                 core::Duration cycleTime)
    : axes_{std::move(axes)},
      groups_{std::move(groups)},
      cycleTime_{std::chrono::duration<double>{cycleTime}.count()} {}

axis::AxisRef Machine::axis(std::string_view name) {
    for (NamedAxis& axis : axes_) {
        if (axis.name != name) continue;
        axis.asked = true;
        return axis.ref;
    }
    unknown_.emplace_back(name);
    return {};
}

axis::GroupRef Machine::group(std::string_view name) {
    for (NamedGroup& group : groups_) {
        if (group.name != name) continue;
        group.asked = true;
        return group.ref;
    }
    unknownGroups_.emplace_back(name);
    return {};
}

bool Machine::uses(std::size_t axis) const noexcept {
    const auto has = [axis](const NamedGroup& group) {
        return group.asked &&
               std::find(group.axes.begin(), group.axes.end(), axis) != group.axes.end();
    };
    return axes_[axis].asked || std::any_of(groups_.begin(), groups_.end(), has);
}

void Machine::fail(std::string_view reason) noexcept {
    failureSize_ = std::min(reason.size(), failure_.size());
    std::copy_n(reason.begin(), failureSize_, failure_.begin());
}

void Machine::stop(std::string_view reason) noexcept {
    if (stopped_ || stopWanted_) return;
    stopWanted_ = true;
    stopReasonSize_ = std::min(reason.size(), stopReason_.size());
    std::copy_n(reason.begin(), stopReasonSize_, stopReason_.begin());
}

Machine::StopWishes Machine::takeStopWishes() noexcept {
    const StopWishes wishes{stopWanted_, resetWanted_};
    stopWanted_ = resetWanted_ = false;
    return wishes;
}

}  // namespace takt::program
