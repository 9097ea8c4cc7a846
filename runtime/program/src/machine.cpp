#include <algorithm>
#include <takt/program/machine.hpp>
#include <utility>

namespace takt::program {

Machine::Machine(std::vector<NamedAxis> axes, core::Duration cycleTime)
    : axes_{std::move(axes)}, cycleTime_{std::chrono::duration<double>{cycleTime}.count()} {}

axis::AxisRef Machine::axis(std::string_view name) {
    for (NamedAxis& axis : axes_) {
        if (axis.name != name) continue;
        axis.asked = true;
        return axis.ref;
    }
    unknown_.emplace_back(name);
    return {};
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
