#include <takt/program/machine.hpp>

#include <algorithm>
#include <utility>

namespace takt::program {

Machine::Machine(std::vector<NamedAxis> axes, core::Duration cycleTime)
    : axes_{std::move(axes)}, cycleTime_{std::chrono::duration<double>{cycleTime}.count()} {}

axis::AxisRef Machine::axis(std::string_view name) {
    for (const NamedAxis& axis : axes_) {
        if (axis.name == name) return axis.ref;
    }
    unknown_.emplace_back(name);
    return {};
}

void Machine::fail(std::string_view reason) noexcept {
    failureSize_ = std::min(reason.size(), failure_.size());
    std::copy_n(reason.begin(), failureSize_, failure_.begin());
}

}  // namespace takt::program
