#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

/// What daemon and bridge process say to each other, as it lies in the memory they share: plain
/// records of a fixed layout. Whoever changes one of them raises ProtocolVersion: a bridge of
/// another version ends with a message instead of misreading.
namespace takt::bridge {

inline constexpr std::uint64_t ProtocolMagic = 0x4547'4449'5242'5454;  // "TTBRIDGE"
inline constexpr std::uint32_t ProtocolVersion = 1;

/// Descriptors of the bridge process, inherited from the daemon.
inline constexpr int StatusDescriptor = 3;
inline constexpr int CommandDescriptor = 4;

inline constexpr std::size_t EventDepth = 256;      ///< events kept for late subscribers
inline constexpr std::size_t ReplyDepth = 256;      ///< answers that may wait for the bridge
inline constexpr std::size_t CommandDepth = 256;    ///< commands that may wait for the daemon
inline constexpr std::uint32_t MostMembers = 4096;  ///< axes or groups of a machine

/// Text of at most N - 1 characters, ended by 0.
template <std::size_t N>
using Text = std::array<char, N>;
using Name = Text<33>;

/// Cuts what is too long.
template <std::size_t N>
void put(Text<N>& to, std::string_view text) noexcept {
    to = {};
    text.copy(to.data(), N - 1);
}
/// Stops at the end of the array, whatever it holds.
template <std::size_t N>
[[nodiscard]] std::string_view view(const Text<N>& text) noexcept {
    const std::string_view all{text.data(), N};
    return all.substr(0, all.find('\0'));
}

enum class MachinePhase : std::uint8_t {
    BringUp,
    GoingOp,
    Operating,
    Stopping,
    LeavingOp,
    Over,
};
enum class NetworkState : std::uint8_t {
    Off,
    PreOp,
    GoingSafeOp,
    SafeOp,
    GoingOp,
    Op,
    GoingDown,
    Init,
    Failed,
};
enum class StopCause : std::uint8_t { None, Input, Command, Program, AxisFault, ProgramFault };
enum class AxisState : std::uint8_t {
    Disabled,
    Standstill,
    Homing,
    DiscreteMotion,
    ContinuousMotion,
    SynchronizedMotion,
    Stopping,
    ErrorStop,
};
enum class GroupState : std::uint8_t { Disabled, Standby, Homing, Moving, Stopping, ErrorStop };

struct MachineSample {
    std::uint64_t cycle{0};
    std::uint64_t framesSent{0};
    std::uint64_t framesLost{0};
    std::uint64_t framesLate{0};
    std::uint64_t workingCounterErrors{0};
    MachinePhase phase{MachinePhase::BringUp};
    NetworkState network{NetworkState::Off};
    StopCause stop{StopCause::None};
};

/// One axis in one cycle, in its user unit; positions are unfolded.
struct AxisSample {
    std::uint64_t cycle{0};
    double set{0.0};
    double setVelocity{0.0};
    double setAcceleration{0.0};
    double actual{0.0};
    double actualVelocity{0.0};
    double lag{0.0};
    std::uint16_t controlword{0};
    std::uint16_t statusword{0};
    std::uint16_t error{0};  ///< stable error number, 0 = none
    std::uint16_t driveError{0};
    AxisState state{AxisState::Disabled};
    std::int8_t mode{0};
    bool powered{false};
    bool homed{false};
};

struct GroupSample {
    std::uint64_t cycle{0};
    double pathVelocity{0.0};  ///< u/s
    std::uint16_t error{0};
    GroupState state{GroupState::Disabled};
};

/// Something that happened, in words.
struct EventRecord {
    std::uint64_t number{0};  ///< from 1, in the order of events
    std::uint64_t cycle{0};
    Text<232> text{};
};

enum class CommandOrder : std::uint8_t {
    Heartbeat,
    Leave,
    PowerOn,
    PowerOff,
    Reset,
    Home,
    Inch,
    Halt,
    MachineStop,
    ResetStop,
};
inline constexpr std::uint8_t CommandOrders = 10;

/// A command as the bridge received it. The daemon believes nothing of it.
struct CommandRecord {
    std::uint64_t writer{0};   ///< who: one DDS writer; never 0
    std::uint64_t client{0};   ///< how he calls himself, for his replies
    std::uint64_t request{0};  ///< his number for it
    double distance{0.0};
    double velocity{0.0};
    Name axis{};
    Name who{};
    CommandOrder order{CommandOrder::Heartbeat};
};

enum class ReplyKind : std::uint8_t { Accepted, Refused, Done, Aborted, Failed };

struct ReplyRecord {
    std::uint64_t client{0};
    std::uint64_t request{0};
    std::uint64_t cycle{0};
    Text<208> why{};
    ReplyKind kind{ReplyKind::Accepted};
};

/// A name that never changes while the machine runs.
struct MemberInfo {
    Name name{};
    Text<9> unit{};
};

/// At the front of the status memory; never changes once the bridge can see it.
struct StatusHeader {
    std::uint64_t magic{ProtocolMagic};
    std::uint32_t version{ProtocolVersion};
    std::uint32_t axes{0};
    std::uint32_t groups{0};
    std::uint32_t samples{0};  ///< depth of each status ring
    std::uint32_t everyCycles{1};
    std::uint32_t domain{0};
    std::int64_t cycleNs{0};
    std::int32_t daemon{0};  ///< its process id
    bool commands{false};
    Name machine{};
    Text<17> interface {};
};

}  // namespace takt::bridge
