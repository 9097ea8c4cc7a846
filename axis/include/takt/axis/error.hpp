#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <takt/core/time.hpp>

/// Error numbers of blocks and axes. The numbers are stable: they never change and are never used
/// again.
namespace takt::axis {

enum class ErrorId : std::uint16_t {
    None = 0,
    // Parameter
    InvalidParameter = 0x0101,
    LimitExceeded = 0x0102,
    TargetOutsideSWLimit = 0x0103,
    DirectionForbidden = 0x0104,
    DirectionInvalid = 0x0105,
    RatioInvalid = 0x0106,
    ParameterUnknown = 0x0107,
    ParameterReadOnly = 0x0108,
    ParameterType = 0x0109,
    NullReference = 0x010A,
    NotFinite = 0x010B,
    StartOutsideSWLimit = 0x010C,
    // State
    InvalidState = 0x0201,
    NotPowered = 0x0202,
    AxisLocked = 0x0203,
    AxisInErrorStop = 0x0204,
    NotHomed = 0x0205,
    AxisInGroup = 0x0206,
    MemberBusy = 0x0207,
    GroupNotEnabled = 0x0208,
    NotSynchronized = 0x0209,
    MachineStopped = 0x020A,
    GroupIncomplete = 0x020B,
    GroupLocked = 0x020C,
    GroupInErrorStop = 0x020D,
    AxisInOtherGroup = 0x020E,
    // Queue
    BufferFull = 0x0301,
    InstanceBusy = 0x0302,
    BlendingNotPossible = 0x0303,
    ContinuousUpdateNotPossible = 0x0304,
    OutcomeUnknown = 0x0305,
    TransitionNotSupported = 0x0306,
    // Planning
    ProfileNotFeasible = 0x0401,
    SyncNotReachable = 0x0402,
    ArcInvalid = 0x0403,
    KinematicUnreachable = 0x0404,
    Singularity = 0x0405,
    TableInvalid = 0x0406,
    MasterCycle = 0x0407,
    CoordSystemNotSupported = 0x0408,
    PlanningLate = 0x0409,
    RouteNotFound = 0x040A,
    StartInKeepOut = 0x040B,
    GoalInKeepOut = 0x040C,
    NotAtPathStart = 0x040D,
    ObstaclesMissing = 0x040E,
    // Homing
    HomingTimeout = 0x0501,
    HomingDistance = 0x0502,
    HomingSignalMissing = 0x0503,
    HomingDriveError = 0x0504,
    // Axis
    LagExceeded = 0x0601,
    SWLimitReached = 0x0602,
    HWLimitReached = 0x0603,
    EncoderError = 0x0604,
    PowerLost = 0x0605,
    SetpointJump = 0x0606,
    GroupFault = 0x0607,
    // Bus
    CommunicationLost = 0x0701,
    WorkingCounter = 0x0702,
    SyncLost = 0x0703,
    SlaveNotOperational = 0x0704,
    // Drive
    DriveFault = 0x0801,
    ModeChangeFailed = 0x0802,
    EnableTimeout = 0x0803,
    ResetFailed = 0x0804,
};

/// What one error number means, for people.
struct ErrorInfo {
    ErrorId id;
    const char* name;    ///< as the enumerator
    const char* text;    ///< one sentence
    const char* remedy;  ///< what to look at or do
    std::array<const char*, 3>
        numbers;  ///< what the numbers of an axis' error record are; "" = unused
};

/// All of them, in ascending order.
[[nodiscard]] std::span<const ErrorInfo> allErrors() noexcept;

/// The entry of `id`; an entry named "Unknown" for a number that is not in the table.
[[nodiscard]] const ErrorInfo& errorInfo(ErrorId id) noexcept;

/// Why an axis is in ErrorStop. The first cause is kept until the reset.
struct ErrorRecord {
    ErrorId id{ErrorId::None};
    std::uint16_t driveError{0};  ///< the drive's 603Fh, 0 = none
    core::CycleNumber cycle{0};
    std::array<double, 3> numbers{};  ///< meaning: `errorInfo(id).numbers`
};

/// A sentence for logs and tables, with the numbers. Allocates: never in the cycle.
[[nodiscard]] std::string explain(const ErrorRecord& record);

}  // namespace takt::axis
