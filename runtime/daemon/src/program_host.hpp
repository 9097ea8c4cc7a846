#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <takt/config/machine_config.hpp>
#include <takt/program/machine.hpp>
#include <takt/program/program.hpp>
#include <takt/program/program_library.hpp>
#include <takt/program/program_params.hpp>
#include <vector>

#include "axes.hpp"
#include "program_caller.hpp"
#include "program_work.hpp"

namespace takt::daemon {

enum class ProgramPhase : std::uint8_t {
    Waiting,  ///< not called yet
    Running,
    Finished,
    Failed,     ///< said so itself
    Threw,      ///< an exception left it
    Abandoned,  ///< a call did not come back within its budget
};

/// Runs one program: its exchange area with axes and groups, its calls, and what becomes of it.
class ProgramHost {
public:
    /// \param number tells programs apart on their axes, from 1
    ProgramHost(program::ProgramParams params, program::ProgramPtr program, std::size_t axisCount,
                std::size_t groupCount, std::uint16_t number);
    /// Another instance of a program: it asks for ways at the same desks as `first`.
    ProgramHost(const ProgramHost& first, program::ProgramPtr program, std::size_t axisCount,
                std::uint16_t number);
    ProgramHost(ProgramHost&&) = default;
    ~ProgramHost();

    /// Calls the program's `start`. \return what is wrong, one sentence each
    std::vector<std::string> start(const config::MachineConfig& machine);
    /// Before the first cycle: who makes the calls.
    void useCaller(std::unique_ptr<ProgramCaller> caller) { caller_ = std::move(caller); }
    /// rt. One call of the program; its commands reach the axes when it came back. \pre useCaller()
    void cycle(core::CycleNumber cycle, const Movers& movers) noexcept;
    /// rt. The operator stops the program: it is not called any more and its axes stop on their
    /// ramp.
    void hold(const Movers& movers) noexcept;
    /// rt. It is called again from where it was stopped; its blocks show CommandAborted.
    void goOn() noexcept { held_ = false; }
    [[nodiscard]] bool held() const noexcept { return held_; }
    /// rt. Takes over a fresh instance of the same program, which has been started and has no
    /// caller, and leaves the old one in it. The program is then stopped before its first call;
    /// what the old one held its axes by is released. \pre atRest()
    void exchange(ProgramHost& fresh, const Movers& movers) noexcept;
    /// How many instances there were before this one.
    [[nodiscard]] std::uint32_t instance() const noexcept { return instance_; }
    void setInstance(std::uint32_t instance) noexcept { instance_ = instance; }
    /// rt. No call is out: the program's own values may be looked at, and it may be told something.
    [[nodiscard]] bool atRest() const noexcept {
        return phase_ != ProgramPhase::Abandoned && !(caller_ && caller_->underWay());
    }
    /// rt. The program has asked for this axis or a group of it; while it runs nobody else moves
    /// it.
    [[nodiscard]] bool uses(std::size_t axis) const noexcept { return work_->machine().uses(axis); }
    /// Where the program asks for ways of each group around its keep-outs. All its instances share
    /// them.
    [[nodiscard]] const RouteDesks& routes() const noexcept { return routes_; }
    /// rt. The machine as the program sees it: to tell it of a machine stop and to hear it ask for
    /// one. \pre atRest()
    [[nodiscard]] program::Machine& machine() noexcept { return work_->machine(); }
    [[nodiscard]] const program::Machine& machine() const noexcept { return work_->machine(); }
    [[nodiscard]] const std::vector<program::Watch>& watched() const noexcept {
        return inspector_.watches();
    }

    /// After the last cycle. Calls the program's `stop` once, unless a call never came back.
    void stop();

    [[nodiscard]] ProgramPhase phase() const noexcept { return phase_; }
    [[nodiscard]] bool ended() const noexcept { return phase_ > ProgramPhase::Running; }
    [[nodiscard]] const std::string& name() const noexcept { return params_.name; }
    [[nodiscard]] const std::string& origin() const noexcept { return params_.origin; }
    [[nodiscard]] const program::ProgramParams& params() const noexcept { return params_; }
    /// Why it failed or what it threw; empty otherwise.
    [[nodiscard]] std::string_view failure() const noexcept;
    [[nodiscard]] core::CycleNumber endCycle() const noexcept { return endCycle_; }
    /// The values the program wants seen, "step = 3, parts = 1". Not while it runs on another
    /// thread.
    [[nodiscard]] std::string watches() const;

private:
    [[nodiscard]] bool due(core::CycleNumber cycle) noexcept;
    void open(const Movers& movers) noexcept;
    void settle(const Movers& movers) noexcept;
    void stopMovers(const Movers& movers) noexcept;
    void end(ProgramPhase phase, core::CycleNumber cycle) noexcept;
    [[nodiscard]] std::string unknown(std::string_view kind, std::string_view asked,
                                      std::string_view known) const;

    program::ProgramParams params_;
    RouteDesks routes_;  ///< for each group
    std::unique_ptr<ProgramWork> work_;
    std::unique_ptr<ProgramCaller> caller_;
    std::vector<bool> commanded_;       ///< for each axis: the program has commanded it
    std::vector<bool> groupCommanded_;  ///< likewise
    program::Inspector inspector_;
    ProgramPhase phase_{ProgramPhase::Waiting};
    bool held_{false};
    core::CycleNumber endCycle_{0};
    core::CycleNumber lastCycle_{0};  ///< in which cycle() was called
    std::uint32_t instance_{0};
};

}  // namespace takt::daemon
