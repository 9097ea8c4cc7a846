#include "machine_stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace takt::daemon {

MachineStop::MachineStop(const axis::MachineStopParams& params, core::Duration cycle,
                         std::vector<Input> inputs, std::size_t axisCount)
    : inputs_{std::move(inputs)},
      limit_{static_cast<core::CycleNumber>((params.time + cycle - core::Duration{1}) / cycle)},
      onFault_{params.onFault},
      overdue_(axisCount, false) {}

bool MachineStop::request(StopCause cause, std::uint16_t source, core::CycleNumber cycle) noexcept {
    if (active()) return false;
    record_ = {cause, source, cycle};
    driveStopped_ = false;
    return true;
}

std::size_t MachineStop::activeInput() const noexcept {
    const auto active = [](const Input& input) {
        const core::DeviceHealth& health = *input.image.health;
        if (!health.operational || health.lostInRow > input.lostLimit) return true;
        const std::uint32_t value = core::readUnsigned(input.image.inputs, input.slot);
        return (((value >> input.bit) & 1U) != 0) == input.activeHigh;
    };
    const auto found = std::find_if(inputs_.begin(), inputs_.end(), active);
    return static_cast<std::size_t>(found - inputs_.begin());
}

void MachineStop::watchInputs(core::CycleNumber cycle) noexcept {
    const std::size_t input = activeInput();
    if (input < inputs_.size()) request(StopCause::Input, static_cast<std::uint16_t>(input), cycle);
}

bool MachineStop::reset(Axes& axes) noexcept {
    if (activeInput() < inputs_.size()) return false;
    record_ = {};
    std::fill(overdue_.begin(), overdue_.end(), false);
    for (axis::Axis& axis : axes) axis.releaseMachineStop();
    return true;
}

void MachineStop::act(core::CycleNumber cycle, Axes& axes) noexcept {
    if (!active()) return;
    for (axis::Axis& axis : axes) axis.machineStop();
    if (driveStopped_ || cycle - record_.cycle < limit_) return;
    driveStopped_ = true;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        overdue_[i] = !axes[i].isDisabled();
        if (overdue_[i]) axes[i].quickStop();
    }
}

std::string describe(const StopRecord& record, std::span<const std::string> inputs,
                     std::span<const std::string> programs, std::span<const std::string> axes) {
    const auto named = [&record](std::span<const std::string> names) -> std::string {
        return record.source < names.size() ? names[record.source] : std::to_string(record.source);
    };
    switch (record.cause) {
        case StopCause::None:
            return "none";
        case StopCause::Input:
            return fmt::format("input '{}'", named(inputs));
        case StopCause::Command:
            return "operator";
        case StopCause::Program:
            return fmt::format("program '{}'", named(programs));
        case StopCause::AxisFault:
            return fmt::format("fault of axis {}", named(axes));
        case StopCause::ProgramFault:
            return fmt::format("failure of program '{}'", named(programs));
    }
    return "?";
}

}  // namespace takt::daemon
