#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <takt/core/spsc_ring.hpp>
#include <takt/record/event_log.hpp>
#include <vector>

#include "axes.hpp"
#include "axis_station.hpp"
#include "bus_desk.hpp"
#include "control_command.hpp"
#include "machine_stop.hpp"
#include "program_host.hpp"
#include "program_stock.hpp"

namespace takt::daemon {

/// The rings between the socket's thread and the cycle.
struct ControlRings {
    core::SpscRing<ControlCommand> commands{256};
    core::SpscRing<ControlAnswer> answers{1024};
    core::SpscRing<TakenCommand> taken{4096};  ///< what the cycle took, for the command file
    std::atomic<std::uint64_t> takenLost{0};   ///< for which there was no room
    record::EventLog events{4096};
};

/// Takes the operator's commands into the cycle, at most a few in each, and stamps them with it.
/// Judges them first: a refused one changes nothing. What moves for the operator stops when he
/// gives no sign of life for HeartbeatTime.
class CommandDesk {
public:
    static constexpr core::Duration HeartbeatTime = std::chrono::milliseconds{100};
    static constexpr std::size_t MostPerCycle = 16;

    struct Parts {
        Axes& axes;
        Groups& groups;
        std::span<ProgramHost> programs;
        MachineStop& machineStop;
        BusDesk& bus;
        ProgramStock& stock;
        ControlRings& rings;
    };
    /// \param replay commands in the order of their cycles; when there are any, those from the ring
    /// are
    ///        refused but for stopping
    /// \param record what was taken goes to the ring `taken`
    CommandDesk(const Parts& parts, core::Duration cycle, std::vector<TakenCommand> replay,
                bool record);

    /// rt. One cycle, after the programs. \param operating motion may be asked for
    /// \param allTold nobody outside looks at a program any more that has ended
    void cycle(core::CycleNumber cycle, bool operating, bool allTold) noexcept;

    /// The program that holds the axis; the number of programs when none does.
    [[nodiscard]] std::size_t holderOf(std::size_t axis) const noexcept;

private:
    void takeAll(core::CycleNumber cycle, bool operating) noexcept;
    void take(const ControlCommand& command, core::CycleNumber cycle, bool operating) noexcept;
    [[nodiscard]] Verdict execute(const ControlCommand& command, core::CycleNumber cycle,
                                  bool operating) noexcept;
    [[nodiscard]] Verdict commandAxis(const ControlCommand& command) noexcept;
    [[nodiscard]] Verdict startProgram(const ControlCommand& command) noexcept;
    [[nodiscard]] Verdict stopProgram(const ControlCommand& command) noexcept;
    [[nodiscard]] Verdict resetProgram(const ControlCommand& command, bool operating) noexcept;
    [[nodiscard]] Refusal whyNoReset(const ProgramHost& program, bool operating,
                                     std::uint16_t& detail) const noexcept;
    [[nodiscard]] Verdict resetStop() noexcept;
    void answer(const ControlCommand& command, const Verdict& verdict,
                core::CycleNumber cycle) noexcept;
    void letGoAll() noexcept;
    void runStations(core::CycleNumber cycle) noexcept;
    void runBus(core::CycleNumber cycle) noexcept;

    Parts parts_;
    std::deque<AxisStation> stations_;
    std::vector<TakenCommand> replay_;
    std::size_t replayed_{0};
    bool replaying_;
    bool record_;
    core::CycleNumber heartbeatLimit_;
    core::CycleNumber lastHeartbeat_{0};
    std::optional<ControlCommand> parked_;  ///< a reset that waits until all has been told
};

}  // namespace takt::daemon
