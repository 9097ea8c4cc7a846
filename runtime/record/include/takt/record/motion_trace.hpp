#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <takt/core/time.hpp>
#include <takt/record/svg_plot.hpp>
#include <takt/record/trace.hpp>
#include <vector>

namespace takt::record {

/// An axis as the trace names it.
struct MotionAxis {
    std::string name;
    std::string unit;  ///< "mm" or "deg", for the plot
};

/// What the trace shows of one axis in one cycle; positions and lag in user units.
struct MotionSample {
    std::uint32_t state{0};  ///< index into the state names
    double set{0.0};
    double setVelocity{0.0};
    double setAcceleration{0.0};
    std::int64_t target{0};  ///< drive counts
    double actual{0.0};
    double actualVelocity{0.0};
    double lag{0.0};
    std::uint16_t controlword{0};
    std::uint16_t statusword{0};
    std::int8_t mode{0};
    std::uint32_t error{0};
};

/// The columns of a machine's trace: cycle, t_ns, then for each axis X.state, X.set, X.setVel,
/// X.setAcc, X.target, X.actual, X.actualVel, X.lag, X.controlword, X.statusword, X.mode, X.error.
/// \param stateNames of X.state
[[nodiscard]] std::vector<TraceColumn> motionColumns(std::span<const MotionAxis> axes,
                                                     std::span<const std::string> stateNames);

/// A group as the trace names it; `unit` is that of path length.
struct MotionGroup {
    std::string name;
    std::string unit;
};

/// What the trace shows of one group in one cycle, along its path.
struct GroupSample {
    std::uint32_t state{0};  ///< index into the state names
    double path{0.0};        ///< length travelled on paths so far
    double velocity{0.0};
    double acceleration{0.0};
    double jerk{0.0};
    std::int64_t command{0};  ///< motion commands that have taken control so far
    std::int64_t queued{0};
    std::uint32_t error{0};
};

/// The columns of the groups, behind those of the axes: G.state, G.s, G.sVel, G.sAcc, G.sJerk,
/// G.command, G.queued, G.error.
[[nodiscard]] std::vector<TraceColumn> groupColumns(std::span<const MotionGroup> groups,
                                                    std::span<const std::string> stateNames);

/// rt. The first two columns.
void putCycle(TraceRow& row, core::CycleNumber cycle, core::HostTime time) noexcept;
/// rt. The columns of the next axis.
void putAxis(TraceRow& row, const MotionSample& sample) noexcept;

/// rt. The columns of the next group.
void putGroup(TraceRow& row, const GroupSample& sample) noexcept;

/// The plot of such a trace: states, position, velocity, acceleration and following error, axes of
/// one unit in one panel; then velocity, acceleration and jerk along the path of each group.
[[nodiscard]] PlotSpec motionPlot(std::string_view title, std::string_view subtitle,
                                  std::span<const MotionAxis> axes,
                                  std::span<const MotionGroup> groups = {});

}  // namespace takt::record
