#pragma once

#include <span>
#include <takt/axis/group_command.hpp>
#include <takt/axis/group_view.hpp>
#include <takt/core/result.hpp>

/// The one set of rules by which commands of a group are accepted, as admit.hpp has them for an
/// axis.
namespace takt::axis {

/// rt. The command with its defaults filled in, relative points made absolute where it is known
/// what they count from, or why the group would refuse it now. Nothing is changed.
/// \pre view.traits != nullptr
[[nodiscard]] core::Result<GroupCommand, ErrorId> admit(const GroupView& view,
                                                        const GroupCommand& request) noexcept;

/// rt. What an admitted command changes at once.
void noteAccepted(GroupView& view, const GroupCommand& command) noexcept;

/// rt. An admitted command that has nothing to do.
[[nodiscard]] bool doneAtOnce(const GroupView& view, const GroupCommand& command) noexcept;

/// rt. An admitted command waits behind others instead of taking control now.
[[nodiscard]] bool mustQueue(const GroupView& view, const GroupCommand& command) noexcept;

/// rt. Makes the points of a relative motion absolute.
void resolve(GroupCommand& command, const GroupPoint& from, std::size_t axes) noexcept;

/// rt. None, or why the axes cannot go this way from `from`: a target outside the software limits,
/// points that give no arc. \pre the command is resolved
[[nodiscard]] ErrorId checkWay(std::span<const AxisTraits* const> members,
                               const GroupCommand& command, const GroupPoint& from) noexcept;

}  // namespace takt::axis
