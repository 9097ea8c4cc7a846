#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <takt/axis/error.hpp>
#include <takt/core/object_access.hpp>
#include <takt/core/time.hpp>

namespace takt::daemon {

/// What may be asked of a running machine. Each is one fixed record in a ring, taken by the cycle.
enum class Order : std::uint8_t {
    Heartbeat,  ///< the operator is still there
    Leave,      ///< the operator is gone: what moves for him stops
    PowerOn,    ///< target: axis
    PowerOff,
    Reset,
    Home,
    Inch,  ///< one MC_Inch; distance signed
    Halt,  ///< what moves for the operator stops
    MachineStop,
    ResetStop,
    ProgramStart,  ///< target: program
    ProgramStop,
    ProgramReset,
    Upload,  ///< target: device; reads an object
    Download,
};
inline constexpr std::uint8_t OrderCount = 15;

enum class OrderTarget : std::uint8_t { None, Axis, Program, Device };

/// "inch"; as it stands in requests and command files.
[[nodiscard]] std::string_view name(Order order) noexcept;
[[nodiscard]] std::optional<Order> orderOf(std::string_view name) noexcept;
/// rt. What `ControlCommand::target` counts.
[[nodiscard]] OrderTarget targetOf(Order order) noexcept;

struct ControlCommand {
    Order order{Order::Heartbeat};
    std::uint16_t target{0};  ///< index of the axis, program or device
    std::uint64_t ticket{0};  ///< whom to answer; 0 = nobody
    double distance{0.0};     ///< Inch: u, signed
    double velocity{0.0};     ///< Inch: u/s
    core::ObjectAddress object{};
    core::ObjectValue value{};  ///< Download
    bool force{false};          ///< Download: also while a program runs
};

/// A command and the cycle that took it.
struct TakenCommand {
    core::CycleNumber cycle{0};
    ControlCommand command{};
};

/// Why a command was refused; it has then changed nothing.
enum class Refusal : std::uint8_t {
    None,
    NotOperating,  ///< the network is not in OP, or the run is ending
    UnknownTarget,
    NotFinite,
    HeldByProgram,  ///< `detail` is the program
    Busy,           ///< the operator's last command for this axis still runs
    Block,          ///< the block's error is in `error`
    StopActive,     ///< what stopped the machine is still there; `detail` is the input
    NotStopped,
    ProgramEnded,
    ProgramRunning,
    OperatorMoves,  ///< an axis moves for the operator; `detail` is the axis
    ProgramsRun,    ///< writing might disturb them; `detail` is one of them
    AxisMoves,      ///< `detail` is the axis
    ProgramLost,    ///< it was abandoned
    OfTheCycle,     ///< the object travels with the process data
    Replaying,      ///< a command file is being replayed
};

enum class AnswerKind : std::uint8_t { Accepted, Refused, Done, Aborted, Failed };

struct ControlAnswer {
    std::uint64_t ticket{0};
    core::CycleNumber cycle{0};
    AnswerKind kind{AnswerKind::Accepted};
    Refusal refusal{Refusal::None};
    axis::ErrorId error{axis::ErrorId::None};
    std::uint16_t detail{0};
    core::ObjectValue value{};   ///< what an upload has read
    std::uint32_t abortCode{0};  ///< why a device refused; 0 = it did not
};

/// What a desk says to a command.
struct Verdict {
    Refusal refusal{Refusal::None};
    std::uint16_t detail{0};
    bool pending{false};  ///< the answer comes later
};

}  // namespace takt::daemon
