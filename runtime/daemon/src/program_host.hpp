#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <takt/axis/axis_port.hpp>
#include <takt/program/machine.hpp>
#include <takt/program/program.hpp>
#include <takt/program/program_library.hpp>
#include <takt/program/program_params.hpp>

#include "axes.hpp"

namespace takt::daemon {

enum class ProgramPhase : std::uint8_t {
    Waiting,   ///< not called yet
    Running,
    Finished,
    Failed,    ///< said so itself
    Threw,     ///< an exception left it
};

/// Runs one program: its exchange area with the axes, its calls, and what becomes of it.
class ProgramHost {
public:
    /// \param number tells programs apart on their axes, from 1
    ProgramHost(program::ProgramParams params, program::ProgramPtr program, std::size_t axisCount,
                std::uint16_t number);
    ProgramHost(ProgramHost&&) = default;

    /// Calls the program's `start`. \return what is wrong, one sentence each
    std::vector<std::string> start(const Axes& axes, core::Duration cycle);
    /// rt. One call of the program, inline; its commands reach the axes when it came back.
    void cycle(core::CycleNumber cycle, Axes& axes) noexcept;
    /// Calls the program's `stop` once.
    void stop();

    /// rt. The operator stops the program: it is not called any more and its axes stop on their ramp.
    void hold(Axes& axes) noexcept;
    /// rt. It is called again from where it was stopped; its blocks show CommandAborted.
    void goOn() noexcept { held_ = false; }
    [[nodiscard]] bool held() const noexcept { return held_; }
    /// rt. The program has asked for this axis; while it runs nobody else moves it.
    [[nodiscard]] bool uses(std::size_t axis) const noexcept { return machine_->axes()[axis].asked; }
    /// rt. The machine as the program sees it: to tell it of a machine stop and to hear it ask for one.
    [[nodiscard]] program::Machine& machine() noexcept { return *machine_; }
    [[nodiscard]] const program::Machine& machine() const noexcept { return *machine_; }
    [[nodiscard]] const std::vector<program::Watch>& watched() const noexcept { return inspector_.watches(); }

    [[nodiscard]] ProgramPhase phase() const noexcept { return phase_; }
    [[nodiscard]] bool ended() const noexcept { return phase_ > ProgramPhase::Running; }
    [[nodiscard]] const std::string& name() const noexcept { return params_.name; }
    [[nodiscard]] const std::string& origin() const noexcept { return params_.origin; }
    /// Why it failed or what it threw; empty otherwise.
    [[nodiscard]] std::string_view failure() const noexcept { return {failure_.data(), failureSize_}; }
    [[nodiscard]] core::CycleNumber endCycle() const noexcept { return endCycle_; }
    /// The values the program wants seen, "step = 3, parts = 1".
    [[nodiscard]] std::string watches() const;

private:
    void call(core::CycleNumber cycle) noexcept;
    void end(ProgramPhase phase, std::string_view why, core::CycleNumber cycle) noexcept;

    program::ProgramParams params_;
    program::ProgramPtr program_;
    /// The exchange area with one axis.
    struct Port {
        std::unique_ptr<axis::AxisPort> area;
        bool used{false};  ///< the program has commanded this axis
    };
    std::vector<Port> ports_;  ///< one for each axis, in axis order
    std::unique_ptr<program::Machine> machine_;
    program::Inspector inspector_;
    ProgramPhase phase_{ProgramPhase::Waiting};
    bool held_{false};
    core::CycleNumber calls_{0};
    core::CycleNumber endCycle_{0};
    std::array<char, 200> failure_{};
    std::size_t failureSize_{0};
};

}  // namespace takt::daemon
