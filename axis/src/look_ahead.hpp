#pragma once

#include <span>
#include <takt/axis/axis_view.hpp>
#include <takt/axis/command.hpp>

/// The velocities at which a chain of blended moves passes from one into the next.
namespace takt::axis {

/// How the command in control comes to its end.
struct Arrival {
    core::Position at;
    bool forward;
    core::Velocity speed;  ///< commanded, positive
};

/// rt. Where a move that takes control at `from` goes. \param backward direction of the motion so
/// far, for Direction::Current on a modulo axis
[[nodiscard]] core::Position goalFrom(const AxisTraits& traits, const Command& move,
                                      core::Position from, bool backward) noexcept;

/// rt. The speed at which the command in control should pass its end: what the buffer mode of the
/// first queued command asks for, and no more than all known commands behind can brake from; 0
/// where the next one is not blended, turns round or goes nowhere.
[[nodiscard]] core::Velocity jointSpeed(const AxisTraits& traits, const Arrival& arrival,
                                        std::span<const Command> queue) noexcept;

}  // namespace takt::axis
