#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <takt/axis/axis.hpp>
#include <takt/axis/group_motion.hpp>
#include <takt/axis/group_params.hpp>
#include <takt/axis/group_planner.hpp>
#include <takt/axis/group_port.hpp>
#include <takt/axis/group_queue.hpp>
#include <takt/axis/group_view.hpp>
#include <takt/core/time.hpp>
#include <vector>

namespace takt::axis {

/// Axes that move together: PLCopen group state, commands, and the motion along planned paths, on
/// top of the axes, which keep their supervision and output gates.
///
///     Group g{params, axes, cycle};
///     every cycle:
///         for (axis) axis.readInputs(k);
///         g.readMembers(k);         // members, plans that are due, ends of motions
///         g.openPort(port);         // … the program runs against its port …
///         g.takeCommands(port);     // before those of the axes
///         g.step();                 // set states of the members
///         for (axis) axis.step();
///     between cycles: if (g.planner().wanted()) g.planner().work();
///
/// A path is planned as a job: its first set-point comes a fixed number of cycles after the
/// command. Stops, halts and faults are planned in the cycle itself, on the path.
class Group {
public:
    /// \param machineAxes all axes of the machine; they outlive the group
    Group(const GroupParams& params, std::vector<Axis*> machineAxes, core::Duration cycle);
    Group(const Group&) = delete;
    Group& operator=(const Group&) = delete;

    [[nodiscard]] const std::string& name() const noexcept { return name_; }

    // The cycle, in this order (rt).
    void readMembers(core::CycleNumber cycle) noexcept;
    void openPort(GroupPort& port) const noexcept;
    void takeCommands(GroupPort& port) noexcept;
    void step() noexcept;
    /// rt. Before readMembers() and the axes' missCycle(), for each cycle the controller missed:
    /// the motion goes on.
    void missCycle() noexcept;

    /// rt. The program that moves the group threw, failed or was abandoned: its commands go, the
    /// group stops on its path and ends in GroupStandby. Between readMembers() and step().
    void stopByProgramLoss() noexcept;

    /// The job: see GroupPlanner.
    [[nodiscard]] GroupPlanner& planner() noexcept { return planner_; }

    // What is to be seen (rt).
    [[nodiscard]] GroupState state() const noexcept { return view_.state; }
    [[nodiscard]] const GroupView& view() const noexcept { return view_; }
    [[nodiscard]] GroupStatus status() const noexcept;

private:
    static constexpr std::uint64_t MostLead = 1000;

    // group.cpp: the cycle
    void updateMembers() noexcept;
    [[nodiscard]] ErrorId hurdle() const noexcept;
    void superviseMembers() noexcept;
    void updateProgress() noexcept;
    void updateRest() noexcept;
    void updateReset() noexcept;
    void enter(GroupState state) noexcept;

    // group_commands.cpp: commands
    void execute(const GroupCommand& request) noexcept;
    void executeMember(const GroupCommand& command) noexcept;
    void executeEnable(const GroupCommand& command) noexcept;
    void executeDisable(const GroupCommand& command) noexcept;
    void executeReset(const GroupCommand& command) noexcept;
    void executeStop(const GroupCommand& command) noexcept;
    void executeMotion(const GroupCommand& command) noexcept;
    void endAll(CommandStatus outcome) noexcept;
    void endFront(CommandStatus outcome) noexcept;
    void activateFront() noexcept;
    void stopOnPath(CommandStatus outcome) noexcept;
    void fail(ErrorId id, std::array<double, 3> numbers) noexcept;
    void report(CommandId id, CommandStatus status) noexcept { events_.report(id, status); }

    // group_path.cpp: motion
    void joinMembers() noexcept;
    void leaveMembers() noexcept;
    void leadMembers() noexcept;
    void startFront() noexcept;
    void startDirect() noexcept;
    void askForPlan() noexcept;
    void takePlan() noexcept;
    void refusePlanned(ErrorId error) noexcept;
    void waitForPlan() noexcept;
    [[nodiscard]] std::size_t unplanned() const noexcept;
    [[nodiscard]] std::span<Axis* const> members() const noexcept {
        return {members_.data(), size_};
    }

    std::string name_;
    GroupTraits traits_;
    std::vector<Axis*> machineAxes_;
    std::array<Axis*, MaxGroupAxes> members_{};
    std::size_t size_{0};  ///< places up to the last axis
    std::uint64_t latency_;
    std::uint64_t lead_;  ///< cycles to the next plan: the latency, or more after late ones
    core::Duration cycle_;

    GroupView view_{};
    GroupMotion motion_;
    GroupPlanner planner_;
    GroupQueue queue_;
    CommandEvents events_;
    std::uint32_t serial_{0};
    std::uint32_t commands_{0};  ///< motion commands that have taken control
    bool frontActive_{false};    ///< the first of the queue has control
    bool joined_{false};         ///< the members follow
    bool disabling_{false};      ///< GroupStopping ends in GroupDisabled
    CommandId disable_{CommandId::None};
    core::FixedVector<CommandId, 8> resets_{};
    core::Jerk jerk_{};
    // The plan asked for.
    bool asked_{false};  ///< … and still wanted
    bool planLate_{false};
    std::uint64_t due_{0};
    const planner::PathMotion* extends_{nullptr};
    std::uint64_t from_{0};
    std::uint32_t pathEnd_{0};  ///< serial of the last motion on the path that runs
    std::uint32_t latePlans_{0};
};

}  // namespace takt::axis
