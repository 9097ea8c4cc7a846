#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <takt/axis/machine_stop_params.hpp>
#include <takt/core/process_image.hpp>
#include <takt/core/time.hpp>
#include <vector>

#include "axes.hpp"

namespace takt::daemon {

enum class StopCause : std::uint8_t {
    None,
    Input,         ///< `source`: which of the configured inputs
    Command,       ///< an operator
    Program,       ///< `source`: which program asked for it
    AxisFault,     ///< `source`: the axis in ErrorStop
    ProgramFault,  ///< `source`: the program that failed
};

/// Why the machine stands. The first cause is kept until the reset.
struct StopRecord {
    StopCause cause{StopCause::None};
    std::uint16_t source{0};
    core::CycleNumber cycle{0};
};

/// One latched request that stops the whole machine: every axis ramps down and is switched off;
/// what is still on after the configured time is stopped by its drive. It stays until it is reset,
/// and an axis comes back only with a new edge of Enable. Not a safety function: emergency stop and
/// STO are wired.
class MachineStop {
public:
    struct Input {
        core::DeviceImage image;
        core::PdoSlot slot;
        std::uint8_t bit{0};
        bool activeHigh{false};
        std::uint32_t lostLimit{0};  ///< bad cycles in a row until the input counts as lost
    };

    MachineStop(const axis::MachineStopParams& params, core::Duration cycle,
                std::vector<Input> inputs, std::size_t axisCount);

    /// rt. Latches; a second request changes nothing. \return true when the machine was not stopped
    /// yet
    bool request(StopCause cause, std::uint16_t source, core::CycleNumber cycle) noexcept;
    /// rt. Looks at the inputs; active ones latch.
    void watchInputs(core::CycleNumber cycle) noexcept;
    /// rt. The first input that is active or lost now; inputs().size() when none is.
    [[nodiscard]] std::size_t activeInput() const noexcept;
    [[nodiscard]] std::size_t inputCount() const noexcept { return inputs_.size(); }
    /// rt. \return false, and nothing changes, while an input is active
    bool reset(Axes& axes) noexcept;
    /// rt. Once in every cycle, after the programs: holds the axes while the stop is latched.
    void act(core::CycleNumber cycle, Axes& axes) noexcept;

    [[nodiscard]] bool active() const noexcept { return record_.cause != StopCause::None; }
    [[nodiscard]] const StopRecord& record() const noexcept { return record_; }
    /// rt. Its time was over before this axis was off: its drive was told to stop. Until the reset.
    [[nodiscard]] bool overdue(std::size_t axis) const noexcept { return overdue_[axis]; }
    [[nodiscard]] bool onFault() const noexcept { return onFault_; }

private:
    std::vector<Input> inputs_;
    core::CycleNumber limit_;  ///< cycles until the drives stop by themselves
    bool onFault_;
    bool driveStopped_{false};
    std::vector<bool> overdue_;  ///< for each axis
    StopRecord record_{};
};

/// "input 'X bit 4'", for lines and tables. `names` of inputs, programs and axes by `source`.
[[nodiscard]] std::string describe(const StopRecord& record, std::span<const std::string> inputs,
                                   std::span<const std::string> programs,
                                   std::span<const std::string> axes);

}  // namespace takt::daemon
