#pragma once

#include <span>
#include <takt/bridge/status_memory.hpp>
#include <takt/config/machine_config.hpp>
#include <takt/fieldbus/ethercat/master.hpp>
#include <vector>

#include "axes.hpp"
#include "bus_desk.hpp"
#include "command_desk.hpp"
#include "control_command.hpp"
#include "diagnosis_board.hpp"
#include "event_text.hpp"
#include "machine_stop.hpp"
#include "program_host.hpp"
#include "status_board.hpp"

namespace takt::daemon {

/// What the cycle is to do beside keeping the bus alive; set between cycles.
struct CycleOrders {
    bool runPrograms{false};
    bool operating{false};  ///< commands and stop inputs count
    bool allTold{true};     ///< what was noted of programs has been put into words
    bool stopAxes{false};   ///< the run ends: every axis ramps down and is switched off
    RunPhase phase{RunPhase::GoingOp};
};

/// The operator's side of the cycle: machine stop, commands from outside, status and events.
class MachineControl {
public:
    struct Parts {
        const config::MachineConfig& machine;
        fieldbus::ethercat::Master& master;
        Axes& axes;
        Groups& groups;
        std::span<ProgramHost> programs;
        ProgramStock& stock;
        bridge::StatusWriter* bridge;  ///< null: none
    };
    /// \param replay commands of a file, in the order of their cycles
    /// \param record what is taken goes into the ring for the command file
    MachineControl(const Parts& parts, std::vector<TakenCommand> replay, bool record);

    // The cycle, in this order (rt).
    void beforePrograms(core::CycleNumber cycle, const CycleOrders& orders) noexcept;
    void afterPrograms(core::CycleNumber cycle, const CycleOrders& orders) noexcept;
    void publish(core::CycleNumber cycle, const CycleOrders& orders) noexcept;

    [[nodiscard]] ControlRings& rings() noexcept { return rings_; }
    [[nodiscard]] const StatusBoard& board() const noexcept { return board_; }
    [[nodiscard]] DiagnosisBoard& diagnosis() noexcept { return diagnosis_; }
    [[nodiscard]] const ControlNames& names() const noexcept { return names_; }
    [[nodiscard]] const MachineStop& machineStop() const noexcept { return stop_; }

private:
    /// What was seen last, so that changes become events.
    struct Seen {
        fieldbus::ethercat::NetworkState network{};
        StopRecord stop{};
        std::vector<axis::AxisState> axes;
        std::vector<axis::GroupState> groups;
        struct ProgramSeen {
            ProgramPhase phase{};
            bool held{false};
        };
        std::vector<ProgramSeen> programs;
    };

    void takeWishes(core::CycleNumber cycle) noexcept;
    void watchFaults(core::CycleNumber cycle) noexcept;
    void publishStatus(core::CycleNumber cycle, const CycleOrders& orders) noexcept;
    void publishToBridge(const RunEntry& run) noexcept;
    void noteChanges(core::CycleNumber cycle) noexcept;
    void noteMovers(core::CycleNumber cycle) noexcept;

    Parts parts_;
    ControlNames names_;
    ControlRings rings_;
    StatusBoard board_;
    DiagnosisBoard diagnosis_;
    MachineStop stop_;
    BusDesk bus_;
    CommandDesk desk_;
    Seen seen_;
};

/// The names of a machine for events, tables and requests.
[[nodiscard]] ControlNames controlNames(const config::MachineConfig& machine,
                                        std::span<const ProgramHost> programs);

}  // namespace takt::daemon
