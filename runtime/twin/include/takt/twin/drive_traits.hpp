#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <takt/core/time.hpp>

namespace takt::twin {

/// Unit of velocities and accelerations in a drive's objects.
enum class MotionUnit : std::uint8_t {
    Counts,    ///< position units per second (squared)
    TenthRpm,  ///< 0.1 rpm (per second)
};

/// Where the home position is once the last homing event was seen.
enum class HomeReference : std::uint8_t {
    LatchedEdge,  ///< where the switch or index changed
    Standstill,   ///< where the motor came to rest after it (index methods: the index)
};

/// Which homing methods a drive knows, beside 1 to 6, 17 to 22 and 33 to 35.
enum class HomingMethods : std::uint8_t {
    WithoutReversal,  ///< no others
    Cia402,           ///< 7 to 14, 23 to 30, 37
    WithHardStops,    ///< 7 to 14, 23 to 30, −17 and −18
};

/// How a drive homes. What its manual leaves open is a member here.
struct HomingTraits {
    HomingMethods methods{HomingMethods::Cia402};
    HomeReference reference{HomeReference::LatchedEdge};
    bool zeroAllowed{true};         ///< 6098h = 0 may be written
    bool movesToOffset{false};      ///< 6099h:05 = 0 moves by 607Ch and zeroes there
    bool offsetAtRestPoint{false};  ///< 6099h:05 = 1: the rest point instead of the index is home
    std::int8_t offsetSign{-1};     ///< the home point reads sign · 607Ch
    bool backsOff{true};          ///< 20 and 22 off the switch: leave it and enter it again slowly
    bool backsOffSlowly{true};    ///< 4, 6, 20, 22: the speed of leaving the switch
    bool startsAsPrinted{false};  ///< 4, 6, 20, 22 always begin as they do on the switch
    bool indexSearchFast{false};  ///< 33 and 34 search at the fast speed
    bool indexAtSlowSpeedOnly{false};  ///< an index met while slowing down does not count
};

/// How a drive differs from others within CiA 402. Every reading that the makers' documents leave
/// open is a named member, so that a machine builder who has measured his drive can switch it.
struct DriveTraits {
    std::string_view name;

    // Bus
    std::span<const core::Duration> allowedCycles{};  ///< empty: any multiple of cycleStep
    core::Duration cycleStep{0};                      ///< 0 = any cycle
    core::Duration longestCycle{0};                   ///< 0 = no limit
    std::uint8_t maxPdoEntries{16};
    std::uint16_t maxPdoBytes{256};
    std::uint8_t maxAssignedPdos{4};
    bool detailedRangeAborts{true};  ///< 0609 0031h/0032h instead of 0609 0030h
    bool emergencies{false};         ///< sends emergency messages
    std::uint32_t lostTargetLimit{
        0};  ///< cycles without new outputs before a fault; 0 = watchdog only
    bool lockFollowsSyncType{
        true};  ///< 1C32h:01 is rewritten to what 0x0981 says at PREOP → SAFEOP

    // Faults
    std::uint16_t followingErrorCode{0x8611};  ///< 603Fh
    std::uint16_t followingErrorPanel{0};      ///< number on the drive's own display
    std::uint16_t communicationCode{0x8700};
    std::uint16_t communicationPanel{0};
    std::uint16_t panelObject{0};            ///< object that shows it, 0 = none
    std::uint8_t errorRegisterMotion{0x01};  ///< 1001h for drive faults
    std::uint8_t errorRegisterBus{0x10};     ///< 1001h for bus faults

    // Stops. −1: the object does not exist and the number behind it applies.
    bool stopOptions{true};                ///< 605Ah, 605Bh, 605Ch exist
    std::int16_t quickStopDefault{2};      ///< 605Ah
    std::int16_t shutdownDefault{0};       ///< 605Bh
    std::int16_t disableDefault{1};        ///< 605Ch
    std::int16_t haltDefault{1};           ///< 605Dh
    std::int16_t faultReactionDefault{0};  ///< 605Eh
    bool haltInCyclicModes{false};         ///< controlword bit 8 stops the axis in CSP and CSV

    // Statusword
    bool dcLockedInBit8{false};
    bool zeroSpeedInBit14{false};
    bool homedInBit15{false};

    // Modes
    std::uint32_t modes{0};          ///< as 6502h: bit n is mode n + 1
    bool startsOnModeChange{false};  ///< controlword bit 4 counts when PP or HM is entered
    bool changeOnSetPoint{false};    ///< PP: controlword bit 9 passes the target at speed
    bool relativeToActual{
        false};  ///< PP: bit 6 adds to the actual position, not to the last target
    bool torqueSlopeIsTime{false};           ///< 6087h: ms from 0 to rated torque instead of ‰/s
    bool profileSpeedInTorque{false};        ///< 607Fh limits the speed in the torque modes
    bool limitsInTorqueModes{true};          ///< limit switches act there
    std::uint16_t torqueModeSpeedObject{0};  ///< rpm; 0 = none
    std::uint8_t torqueModeSpeedSubindex{0};
    std::uint16_t softLimitSwitchObject{0};  ///< 1 turns the software limits on; 0 = always on
    std::uint8_t softLimitSwitchSubindex{0};
    bool softLimitsYieldToSwitches{false};  ///< void when limit switches are wired
    bool softLimitsLessHomeOffset{true};    ///< once homed, 607Dh − 607Ch

    // Parameters
    bool storesByCommand{false};  ///< 1010h:01 and :04 as the CD300E has them
    bool volatilePairs{false};    ///< 2xxxh is stored, 3xxxh the same in memory
    bool gearObjects{false};      ///< 6091h and 6092h set the gear, within 1/1000 to 8000

    // Inputs and touch probes
    bool virtualInputs{false};  ///< 60FEh bits 16 to 19 are DI1 to DI4, functions in 2500h to 2503h
    bool probeCountsInStatus{false};  ///< 60B9h bits 6, 7, 14, 15 count modulo 4

    // Overload: the square of the torque over its rated one, averaged over a time, reaches 1.
    std::uint16_t overloadAlarm{0};    ///< number on the drive's display; 0 = no such supervision
    std::uint16_t overloadWarning{0};  ///< from 95 %
    core::Duration overloadTime{std::chrono::seconds{30}};  ///< no manual gives one

    // Position and homing
    MotionUnit unit{MotionUnit::Counts};
    bool truncatesPositions{false};  ///< electronic gear cuts towards zero instead of rounding
    HomingTraits homing;

    // Timing and power stage
    core::Duration bootTime{std::chrono::milliseconds{50}};
    core::Duration enableTime{std::chrono::milliseconds{5}};  ///< Switched on → Operation enabled
    double ratedTorque{1.27};                                 ///< Nm, a 400 W motor
    double torqueLimit{3.0};                                  ///< times rated
    double torquePerAmpere{0.49};                             ///< Nm/A
    std::uint32_t followingWindow{0xFFFFFFFF};  ///< 6065h where the description has no default
    std::uint16_t followingTimeout{0};          ///< 6066h, ms
    std::int8_t powerUpMode{0};                 ///< 6060h

    /// rt. Whether the drive accepts this SYNC0 cycle.
    [[nodiscard]] bool allowsCycle(core::Duration cycle) const noexcept;
    /// rt. Modes of operation that the simulated drive implements.
    [[nodiscard]] bool supportsMode(std::int8_t mode) const noexcept;
    /// rt. Values that 6098h takes.
    [[nodiscard]] bool supportsHoming(std::int8_t method) const noexcept;
};

/// "cd300e", "ra"; anything else is a generic CiA 402 drive.
[[nodiscard]] const DriveTraits& driveTraits(std::string_view profile) noexcept;

}  // namespace takt::twin
