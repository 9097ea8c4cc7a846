#pragma once

#include <cstdint>
#include <takt/axis/path_data.hpp>
#include <takt/plcopen/mc_group_move.hpp>

namespace takt::plcopen {

/// A path as it is kept: where it begins, and its lines and arcs.
using MC_PATH_DATA_REF = axis::PathData;

/// Runs a stored path from its start to its end. One Done for all of it.
///
/// The group must be, or with mcBuffered come to rest, where the path begins. All segments have the
/// same limits: Velocity (above 0) in u/s along the path, accelerations and jerk likewise, where 0
/// means the group's limit. BufferMode mcAborting or mcBuffered: what a path was checked for holds
/// only where nothing is blended into it.
class MC_MovePath : public GroupMoveBlock {
public:
    bool Done{false};

    /// rt. One call per cycle. `path` (PathData of the standard) is taken over at the rising edge.
    void operator()(axis::GroupRef group, const MC_PATH_DATA_REF& path) noexcept;

private:
    [[nodiscard]] core::Result<axis::CommandId, axis::ErrorId> submit(
        axis::GroupPort& port, axis::CommandId previous, const MC_PATH_DATA_REF& path) noexcept;

    axis::GroupRef ref_{};
    axis::CommandId first_{axis::CommandId::None};
};

/// Plans a way of the group from where it stands (or where its last motion ends) to Goal, around
/// the keep-outs of the machine file, as a job that never holds the cycle up. The path is written
/// when Done comes; MC_MovePath runs it.
///
/// The same start, goal and seed give the same path, on any computer. ErrorID tells apart
/// RouteNotFound, StartInKeepOut, GoalInKeepOut (KeepOut says which, in the order of the file),
/// StartOutsideSWLimit and TargetOutsideSWLimit.
class TK_PlanPath {
public:
    TK_PlanPath() = default;
    TK_PlanPath(const TK_PlanPath&) = delete;
    TK_PlanPath& operator=(const TK_PlanPath&) = delete;

    bool Execute{false};   ///< a rising edge starts planning and samples all inputs
    GroupArray Goal{};     ///< u, all axes of the group
    double Rounding{0.0};  ///< u: how far corners are cut at most before and after them; 0 = stops
    std::uint32_t Seed{1};

    bool Done{false};
    bool Busy{false};
    bool Error{false};
    axis::ErrorId ErrorID{axis::ErrorId::None};
    std::uint32_t KeepOut{0};  ///< with StartInKeepOut, GoalInKeepOut: which, from 1
    double Duration{0.0};      ///< s: of the path at the limits of group and axes

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group, MC_PATH_DATA_REF& path) noexcept;

private:
    void begin() noexcept;
    void follow(MC_PATH_DATA_REF& path) noexcept;
    void fail(axis::ErrorId error) noexcept;

    axis::GroupRef ref_{};
    axis::RouteDesk::Order order_{};
    axis::RouteDesk::Ticket ticket_{axis::RouteDesk::Ticket::None};
    bool lastExecute_{false};
};

}  // namespace takt::plcopen
