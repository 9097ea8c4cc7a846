#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <takt/axis/axis_port.hpp>
#include <takt/axis/group_port.hpp>
#include <takt/program/program.hpp>
#include <takt/program/program_library.hpp>
#include <vector>

namespace takt::daemon {

/// Where a program asks for ways around keep-outs, one for each group of the machine.
using RouteDesks = std::vector<std::shared_ptr<axis::RouteDesk>>;

/// What became of one call of a program.
enum class CallAnswer : std::uint8_t { Running, Finished, Failed, Threw };

/// All that a program touches while it is called: nobody else may until the call has come back. Of
/// a program that never comes back it is given up as a whole.
class ProgramWork {
public:
    ProgramWork(program::ProgramPtr program, std::size_t axisCount, const RouteDesks& routes,
                std::uint16_t number);

    [[nodiscard]] program::Program& program() noexcept { return *program_; }
    [[nodiscard]] axis::AxisPort& area(std::size_t axis) noexcept { return *areas_[axis]; }
    [[nodiscard]] axis::GroupPort& groupArea(std::size_t group) noexcept {
        return *groupAreas_[group];
    }
    void setMachine(std::unique_ptr<program::Machine> machine) { machine_ = std::move(machine); }
    [[nodiscard]] program::Machine& machine() noexcept { return *machine_; }

    /// rt. One call of the program; what it throws is caught. \pre setMachine()
    void call() noexcept;
    [[nodiscard]] CallAnswer answer() const noexcept { return answer_; }
    /// Why it failed or what it threw; empty otherwise.
    [[nodiscard]] std::string_view failure() const noexcept {
        return {failure_.data(), failureSize_};
    }

private:
    void answer(CallAnswer answer, std::string_view why) noexcept;

    program::ProgramPtr program_;
    std::vector<std::unique_ptr<axis::AxisPort>> areas_;  ///< one for each axis, in axis order
    std::vector<std::unique_ptr<axis::GroupPort>> groupAreas_;  ///< likewise
    std::unique_ptr<program::Machine> machine_;
    core::CycleNumber calls_{0};
    CallAnswer answer_{CallAnswer::Running};
    std::array<char, 200> failure_{};
    std::size_t failureSize_{0};
};

}  // namespace takt::daemon
