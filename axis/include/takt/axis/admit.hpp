#pragma once

#include <takt/axis/axis_view.hpp>
#include <takt/axis/command.hpp>
#include <takt/core/result.hpp>

/// The one set of rules by which commands are accepted. Pure: a program's port and the axis itself
/// ask the same functions, so what a block answers in its call is what the axis does.
namespace takt::axis {

/// rt. The command with its defaults filled in, or why the axis would refuse it now.
/// Nothing is changed. \pre view.traits != nullptr
[[nodiscard]] core::Result<Command, ErrorId> admit(const AxisView& view,
                                                   const Command& request) noexcept;

/// rt. What an admitted command changes at once: state, command in control, length of the queue.
void noteAccepted(AxisView& view, const Command& command) noexcept;

/// rt. An admitted command that has nothing to do: stopping or halting an axis at rest, resetting
/// an axis without an error.
[[nodiscard]] bool doneAtOnce(const AxisView& view, const Command& command) noexcept;

/// rt. An admitted command waits behind others instead of taking control now.
[[nodiscard]] bool mustQueue(const AxisView& view, const Command& command) noexcept;

/// rt. None, or the error of a target beyond a software limit or beyond what counts can express.
[[nodiscard]] ErrorId checkTarget(const AxisTraits& traits, core::Position target) noexcept;

}  // namespace takt::axis
