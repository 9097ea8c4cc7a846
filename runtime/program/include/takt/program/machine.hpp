#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <takt/axis/axis_port.hpp>
#include <takt/axis/group_port.hpp>
#include <takt/core/time.hpp>
#include <takt/core/units.hpp>
#include <vector>

namespace takt::program {

/// The machine as one program sees it.
class Machine {
public:
    struct NamedAxis {
        std::string name;
        axis::AxisRef ref;
        bool asked{false};  ///< the program has asked for it by name
    };

    struct NamedGroup {
        std::string name;
        axis::GroupRef ref;
        std::vector<std::size_t> axes;  ///< its members, by their place in the machine
        bool asked{false};              ///< the program has asked for it by name
    };

    Machine(std::vector<NamedAxis> axes, std::vector<NamedGroup> groups, core::Duration cycleTime);

    /// The axis of that name in the machine file. An unknown name gives an invalid handle, and the
    /// machine is refused after `start` with the names that exist. For `start`; costs a search.
    [[nodiscard]] axis::AxisRef axis(std::string_view name);

    /// The group of that name, likewise.
    [[nodiscard]] axis::GroupRef group(std::string_view name);

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

    /// rt. Stops the whole machine: every axis ramps down and is switched off, and stays off until
    /// the stop is reset and Enable of MC_Power has fallen and risen. The first reason is kept, 100
    /// characters of it.
    void stop(std::string_view reason) noexcept;
    /// rt. The machine stop is latched, whoever asked for it.
    [[nodiscard]] bool stopped() const noexcept { return stopped_; }
    /// rt. Acknowledges the machine stop; without effect while its input is active.
    void resetStop() noexcept { resetWanted_ = true; }

    // For the side that runs the program.

    /// rt.
    void setCycle(core::CycleNumber cycle) noexcept { cycle_ = cycle; }
    /// Names that `axis` did not know.
    [[nodiscard]] const std::vector<std::string>& unknownAxes() const noexcept { return unknown_; }
    /// Names that `group` did not know.
    [[nodiscard]] const std::vector<std::string>& unknownGroups() const noexcept {
        return unknownGroups_;
    }
    /// rt. The program has asked for this axis, or for a group that has it.
    [[nodiscard]] bool uses(std::size_t axis) const noexcept;
    /// rt. Takes over what the program asked for in this call: stop, reset.
    struct StopWishes {
        bool stop{false};
        bool reset{false};
    };
    [[nodiscard]] StopWishes takeStopWishes() noexcept;
    void setStopped(bool stopped) noexcept { stopped_ = stopped; }
    [[nodiscard]] std::string_view stopReason() const noexcept {
        return {stopReason_.data(), stopReasonSize_};
    }
    [[nodiscard]] std::string_view failure() const noexcept {
        return {failure_.data(), failureSize_};
    }

private:
    std::vector<NamedAxis> axes_;
    std::vector<NamedGroup> groups_;
    std::vector<std::string> unknown_;
    std::vector<std::string> unknownGroups_;
    core::Seconds cycleTime_;
    core::CycleNumber cycle_{0};
    std::array<char, 200> failure_{};
    std::size_t failureSize_{0};
    std::array<char, 100> stopReason_{};
    std::size_t stopReasonSize_{0};
    bool stopWanted_{false};
    bool resetWanted_{false};
    bool stopped_{false};
};

}  // namespace takt::program
