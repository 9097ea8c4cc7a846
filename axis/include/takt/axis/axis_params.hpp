#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <takt/core/process_image.hpp>
#include <takt/core/time.hpp>
#include <takt/core/units.hpp>

namespace takt::axis {

/// Drive counts for user units as an exact ratio:
/// counts = units · (countsPerTurn · gearMotor) / (gearLoad · unitsPerTurn).
/// All four numbers are positive; `reversed` turns the counting direction round.
struct ScalingParams {
    std::int64_t countsPerTurn{1};            ///< drive position units per motor turn
    std::int64_t gearMotor{1};                ///< motor turns …
    std::int64_t gearLoad{1};                 ///< … for this many load turns
    std::int64_t unitsPerTurnNumerator{1};    ///< user units (mm, deg) per load turn …
    std::int64_t unitsPerTurnDenominator{1};  ///< … as a fraction
    bool reversed{false};
    std::optional<core::Distance> modulo;  ///< period of a rotary axis, empty = linear
};

struct LimitParams {
    core::Velocity velocity{};
    core::Acceleration acceleration{};
    core::Acceleration deceleration{};
    core::Jerk jerk{};
    core::Acceleration stopDeceleration{};  ///< axis stop and MC_Power off ramp
    core::Jerk stopJerk{};
    std::optional<core::Position> softNegative;
    std::optional<core::Position> softPositive;
};

struct SupervisionParams {
    core::Distance followingError{};       ///< 0 = off
    core::Duration followingErrorTime{0};  ///< filter; 0 = one cycle is enough
    core::Distance inPositionWindow{};     ///< 0 = profile end only
    core::Duration inPositionTime{0};
    std::uint32_t driveDelayCycles{
        1};  ///< cycles between target used and actual reported, beyond the bus
    core::Duration enableTimeout{std::chrono::seconds{3}};
    core::Duration resetTimeout{std::chrono::seconds{2}};
    std::uint32_t lostCycles{3};  ///< bad cycles in a row that are tolerated, 1 to 10
};

/// How the axis finds its reference, by the drive's own procedure (mode 6).
struct HomingParams {
    std::int8_t method{35};
    core::Velocity switchSpeed{};       ///< 6099h:01
    core::Velocity zeroSpeed{};         ///< 6099h:02
    core::Acceleration acceleration{};  ///< 609Ah
    core::Duration timeout{std::chrono::seconds{60}};
};

/// In which units a drive takes speeds and accelerations of its profile objects.
enum class DriveVelocityUnit : std::uint8_t {
    CountsPerSecond,  ///< position units/s and /s² (CiA 402 default, CD300E)
    TenthRpm,         ///< 0.1 rpm and 0.1 rpm/s (RA as delivered)
};

enum class PowerOffMode : std::uint8_t { Ramp, Immediate };

/// Where the drive's objects lie in the device's process data. Resolved once at start; a slot that
/// is not present is not mapped.
struct DriveBindings {
    core::PdoSlot controlword;  // outputs
    core::PdoSlot modeOfOperation;
    core::PdoSlot targetPosition;
    core::PdoSlot statusword;  // inputs
    core::PdoSlot modeDisplay;
    core::PdoSlot actualPosition;
    core::PdoSlot errorCode;
    core::PdoSlot digitalInputs;
    core::PdoSlot followingError;
    core::PdoSlot actualTorque;
};

/// What is known of the drive model beside its description file.
struct DriveParams {
    std::string slave;    ///< name of the device on the network
    std::string profile;  ///< "cd300e", "ra" or "generic"
    DriveVelocityUnit velocityUnit{DriveVelocityUnit::CountsPerSecond};
    core::Quantity<0, -1> maxMotorSpeed{};  ///< turns per second; 0 = not told
    DriveBindings bound;  ///< slots that are told; the others are found by their objects
};

struct AxisParams {
    std::string name;
    std::string unit;  ///< "mm" or "deg"
    DriveParams drive;
    ScalingParams scaling;
    LimitParams limits;
    SupervisionParams supervision;
    HomingParams homing;
    PowerOffMode powerOff{PowerOffMode::Ramp};
    bool vertical{false};
    std::uint32_t queueDepth{8};
    std::string origin;  ///< "machine.xml:40"
};

}  // namespace takt::axis
