#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <takt/axis/axis_view.hpp>
#include <takt/axis/group_view.hpp>
#include <takt/core/seq_lock.hpp>
#include <takt/fieldbus/ethercat/cycle_counters.hpp>
#include <takt/fieldbus/ethercat/network_state.hpp>

#include "machine_stop.hpp"
#include "program_host.hpp"

namespace takt::daemon {

/// The life of one run, from the first frame to INIT.
enum class RunPhase : std::uint8_t { BringUp, GoingOp, Operating, PoweringOff, LeavingOp, Over };

[[nodiscard]] const char* name(RunPhase phase) noexcept;

struct RunEntry {
    core::CycleNumber cycle{0};
    RunPhase phase{RunPhase::BringUp};
    fieldbus::ethercat::NetworkState network{};
    StopRecord stop{};
    fieldbus::ethercat::CycleCounters counters{};
};

struct AxisEntry {
    axis::AxisStatus status{};
    axis::ErrorRecord error{};
    std::uint16_t holder{0};  ///< program that holds it; number of programs = none
    bool needsEnableEdge{false};
};

struct GroupEntry {
    axis::GroupStatus status{};
    axis::ErrorRecord error{};
};

struct ProgramEntry {
    static constexpr std::size_t MostWatches = 64;

    ProgramPhase phase{};
    bool held{false};
    std::uint32_t instance{0};
    core::CycleNumber endCycle{0};
    std::array<double, MostWatches> watches{};
};

/// The status of the machine: written by the cycle, read by anybody. Each entry is whole; two
/// entries may be of neighbouring cycles.
struct StatusBoard {
    StatusBoard(std::size_t axisCount, std::size_t groupCount, std::size_t programCount)
        : axes(axisCount), groups(groupCount), programs(programCount) {}

    core::SeqLock<RunEntry> run;
    std::deque<core::SeqLock<AxisEntry>> axes;
    std::deque<core::SeqLock<GroupEntry>> groups;
    std::deque<core::SeqLock<ProgramEntry>> programs;
};

}  // namespace takt::daemon
