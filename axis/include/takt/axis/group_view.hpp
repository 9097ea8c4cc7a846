#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/axis/axis_view.hpp>
#include <takt/axis/error.hpp>
#include <takt/axis/group_command.hpp>
#include <takt/axis/group_params.hpp>
#include <takt/core/time.hpp>

namespace takt::axis {

/// The states of the PLCopen group diagram.
enum class GroupState : std::uint8_t {
    Disabled,
    Standby,
    Homing,
    Moving,
    Stopping,
    ErrorStop,
};

/// "GroupDisabled", "GroupStandby", … as in the standard.
[[nodiscard]] const char* name(GroupState state) noexcept;

/// What never changes while a group lives.
struct GroupTraits {
    PathLimitParams limits;
    std::uint32_t queueDepth{32};
};

/// What a program may see of a group, and what a new command is judged by.
struct GroupView {
    core::CycleNumber cycle{0};
    const GroupTraits* traits{nullptr};
    CommandId active{CommandId::None};  ///< the command in control
    GroupState state{GroupState::Disabled};
    bool stopDone{false};           ///< GroupStopping at rest
    bool stopReleased{true};        ///< GroupStopping ends at rest
    bool endKnown{true};            ///< `end` is what the next buffered command starts from
    bool pathLast{false};           ///< the last accepted motion is one that can be blended
    std::uint8_t queued{0};         ///< accepted, and not in control yet
    ErrorId hurdle{ErrorId::None};  ///< why no motion can begin from GroupStandby
    ErrorId claim{ErrorId::None};   ///< why the group cannot be enabled
    /// The axes by place; null = empty. Their limits are those of the axes.
    std::array<const AxisTraits*, MaxGroupAxes> members{};
    GroupPoint set{};
    GroupPoint actual{};
    GroupPoint end{};  ///< where the last accepted motion ends
    bool actualValid{false};
    ErrorRecord error{};

    /// rt. Places up to the last axis.
    [[nodiscard]] std::size_t size() const noexcept {
        std::size_t count = MaxGroupAxes;
        while (count > 0 && members[count - 1] == nullptr) --count;
        return count;
    }
    /// rt. The axes by place. \pre no place before the last axis is empty
    [[nodiscard]] std::span<const AxisTraits* const> axes() const noexcept {
        return {members.data(), size()};
    }
    /// A command is in control or braking is under way: a buffered command has to wait.
    [[nodiscard]] bool inMotion() const noexcept {
        return state == GroupState::Moving || state == GroupState::Homing;
    }
};

/// One group in one cycle, for traces, tables and the status snapshot.
struct GroupStatus {
    GroupState state{GroupState::Disabled};
    std::uint8_t queued{0};
    std::uint32_t command{0};  ///< motion commands that have taken control so far
    core::Distance path{};     ///< length travelled on paths so far
    core::Velocity velocity{};
    core::Acceleration acceleration{};
    core::Jerk jerk{};
    ErrorId error{ErrorId::None};
    std::uint32_t latePlans{0};
};

}  // namespace takt::axis
