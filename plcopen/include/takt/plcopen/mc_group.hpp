#pragma once

#include <cstdint>
#include <takt/plcopen/execute_block.hpp>

namespace takt::plcopen {

/// Gives the group an axis. Only in GroupDisabled; the axis must not be a modulo axis.
class MC_AddAxisToGroup : public GroupExecuteBlock {
public:
    std::uint8_t IdentInGroup{0};  ///< place of the axis, from 1; 0 = the first that is free

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group, axis::AxisRef axis) noexcept;
};

/// Takes the axis of a place out of the group. Only in GroupDisabled.
class MC_RemoveAxisFromGroup : public GroupExecuteBlock {
public:
    std::uint8_t IdentInGroup{0};  ///< place of the axis, from 1

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// Takes all axes out of the group, which is disabled then. Not while it moves.
class MC_UngroupAllAxes : public GroupExecuteBlock {
public:
    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// GroupDisabled becomes GroupStandby. The members need not have power yet; none of them may be in
/// another group that is enabled.
class MC_GroupEnable : public GroupExecuteBlock {
public:
    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// To GroupDisabled; a group that moves stops on its path first. The axes keep their power.
class MC_GroupDisable : public GroupExecuteBlock {
public:
    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// Clears the errors of the group and of its members: GroupErrorStop becomes GroupStandby. Not in
/// GroupErrorStop: Done, no effect.
class MC_GroupReset : public GroupExecuteBlock {
public:
    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

/// Stops the group on its path and holds it in GroupStopping while Execute is TRUE: every motion
/// block of the group answers GroupLocked.
class MC_GroupStop : public GroupExecuteBlock {
public:
    double Deceleration{0.0};  ///< u/s² along the path, 0 = what the stop limits of the axes allow
    double Jerk{0.0};          ///< u/s³ along the path, 0 = as above

    bool Done{false};
    bool CommandAborted{false};  ///< the group was disabled
    bool Active{false};          ///< holds the group, Done included

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;

private:
    void release(const axis::GroupRef& group) noexcept;

    bool release_{false};  ///< Execute fell: the group is to be let go
};

/// Stops the group on its path; any other motion command of the group may follow meanwhile.
class MC_GroupHalt : public GroupMotionBlock {
public:
    double Deceleration{0.0};                               ///< u/s², 0 = the group's
    double Jerk{0.0};                                       ///< u/s³, 0 = the group's
    MC_BUFFER_MODE BufferMode{MC_BUFFER_MODE::mcAborting};  ///< mcAborting or mcBuffered

    bool Done{false};

    /// rt. One call per cycle.
    void operator()(axis::GroupRef group) noexcept;
};

}  // namespace takt::plcopen
