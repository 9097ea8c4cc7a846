#pragma once

#include <cstdint>
#include <takt/axis/error.hpp>
#include <takt/core/units.hpp>

namespace takt::axis {

/// Names one command for its whole life; unique per axis. The upper bits are the number of the port
/// it came from.
enum class CommandId : std::uint64_t { None = 0 };

enum class CommandKind : std::uint8_t {
    PowerOn,
    PowerOff,
    Reset,
    ReleaseStop,  ///< Execute of the MC_Stop named by `replaces` fell
    Stop,
    Halt,
    Home,
    MoveAbsolute,
    MoveRelative,
    MoveVelocity,
    MoveAdditive,
    MoveContinuousAbsolute,
    MoveContinuousRelative,
};

/// MC_BUFFER_MODE, numbers as in the standard.
enum class BufferMode : std::uint8_t {
    Aborting = 0,
    Buffered = 1,
    BlendingLow = 2,
    BlendingPrevious = 3,
    BlendingNext = 4,
    BlendingHigh = 5,
};

/// MC_DIRECTION, numbers as in the standard.
enum class Direction : std::uint8_t { Positive = 1, ShortestWay = 2, Negative = 3, Current = 4 };

/// Dynamics of a command. In a request 0 means "the axis' default"; an admitted command has no 0
/// left.
struct Dynamics {
    core::Velocity velocity;
    core::Acceleration acceleration;
    core::Acceleration deceleration;
    core::Jerk jerk;
};

struct Command {
    CommandId id{CommandId::None};
    CommandId replaces{CommandId::None};  ///< previous command of the same block instance
    CommandKind kind{CommandKind::Halt};
    BufferMode bufferMode{BufferMode::Aborting};
    Direction direction{Direction::ShortestWay};
    core::Position position{};     ///< of an absolute move: target; Home: value at the reference
    core::Distance distance{};     ///< of a relative move
    core::Velocity endVelocity{};  ///< of a continuous move, signed
    Dynamics dynamics{};           ///< MoveVelocity: `velocity` is signed
};

/// Where a command stands.
enum class CommandPhase : std::uint8_t { Unknown, Queued, Active, Done, Aborted, Error };

struct CommandStatus {
    CommandPhase phase{CommandPhase::Unknown};
    ErrorId error{ErrorId::None};
};

/// A change of a command's phase, on its way from the axis to the port the command came from.
struct CommandEvent {
    CommandId id{CommandId::None};
    CommandStatus status{};
};

/// Takes the axis' motion: Halt, Home and the moves. Stop is a kind of its own.
[[nodiscard]] constexpr bool isMotion(CommandKind kind) noexcept {
    return kind >= CommandKind::Halt;
}

/// Goes to a position, whatever it does there.
[[nodiscard]] constexpr bool isPositioning(CommandKind kind) noexcept {
    return kind >= CommandKind::MoveAbsolute && kind != CommandKind::MoveVelocity;
}

/// Counts its way from where it takes control.
[[nodiscard]] constexpr bool isRelative(CommandKind kind) noexcept {
    return kind == CommandKind::MoveRelative || kind == CommandKind::MoveAdditive ||
           kind == CommandKind::MoveContinuousRelative;
}

/// Goes on until another command takes the axis: ContinuousMotion.
[[nodiscard]] constexpr bool isEndless(CommandKind kind) noexcept {
    return kind == CommandKind::MoveVelocity || kind == CommandKind::MoveContinuousAbsolute ||
           kind == CommandKind::MoveContinuousRelative;
}

}  // namespace takt::axis
