#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <takt/axis/axis_port.hpp>
#include <takt/core/time.hpp>
#include <takt/core/units.hpp>

namespace takt::program {

/// The machine as one program sees it.
class Machine {
public:
    struct NamedAxis {
        std::string name;
        axis::AxisRef ref;
    };

    Machine(std::vector<NamedAxis> axes, core::Duration cycleTime);

    /// The axis of that name in the machine file. An unknown name gives an invalid handle, and the machine
    /// is refused after `start` with the names that exist. For `start`; costs a search.
    [[nodiscard]] axis::AxisRef axis(std::string_view name);

    /// rt. Number of this call of `cycle`, from 0. Bus cycles when the program runs in every one.
    [[nodiscard]] core::CycleNumber cycle() const noexcept { return cycle_; }
    /// rt. Time between two bus cycles.
    [[nodiscard]] core::Seconds cycleTime() const noexcept { return cycleTime_; }
    /// rt. Time since the first cycle, counted in cycles.
    [[nodiscard]] core::Seconds time() const noexcept {
        return cycleTime_ * static_cast<double>(cycle_);
    }
    /// rt. Says why the program is about to return Failed; up to 200 characters are kept.
    void fail(std::string_view reason) noexcept;

    // For the side that runs the program.

    /// rt.
    void setCycle(core::CycleNumber cycle) noexcept { cycle_ = cycle; }
    /// Names that `axis` did not know.
    [[nodiscard]] const std::vector<std::string>& unknownAxes() const noexcept { return unknown_; }
    [[nodiscard]] const std::vector<NamedAxis>& axes() const noexcept { return axes_; }
    [[nodiscard]] std::string_view failure() const noexcept { return {failure_.data(), failureSize_}; }

private:
    std::vector<NamedAxis> axes_;
    std::vector<std::string> unknown_;
    core::Seconds cycleTime_;
    core::CycleNumber cycle_{0};
    std::array<char, 200> failure_{};
    std::size_t failureSize_{0};
};

}  // namespace takt::program
