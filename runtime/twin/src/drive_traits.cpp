#include <algorithm>
#include <array>
#include <takt/twin/drive_traits.hpp>

#include "homing_sequence.hpp"

namespace takt::twin {

namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr std::array<core::Duration, 7> Cd300eCycles{
    microseconds{125}, microseconds{250}, microseconds{500}, milliseconds{1},
    milliseconds{2},   milliseconds{4},   milliseconds{8},
};

constexpr DriveTraits makeCd300e() {
    DriveTraits traits;
    traits.name = "cd300e";
    traits.allowedCycles = Cd300eCycles;
    traits.maxPdoEntries = 8;
    traits.lockFollowsSyncType = false;
    // The manual names coasting as default of all three stop options, and 6084h as the ramp of
    // option 1.
    traits.quickStopDefault = 0;
    traits.shutdownDefault = 0;
    traits.disableDefault = 0;
    traits.homedInBit15 = true;
    traits.storesByCommand = true;
    traits.overloadAlarm = 0xFF01;
    traits.overloadWarning = 0x0003;
    traits.gearObjects = true;
    traits.modes = 0x3AD;
    traits.startsOnModeChange = true;
    traits.changeOnSetPoint = true;
    traits.limitsInTorqueModes = false;
    traits.torqueModeSpeedObject = 0x4010;
    traits.torqueModeSpeedSubindex = 0x6A;
    traits.softLimitSwitchObject = 0x4010;
    traits.softLimitSwitchSubindex = 0x4A;
    traits.softLimitsYieldToSwitches = true;
    traits.softLimitsLessHomeOffset = false;
    traits.truncatesPositions = true;
    traits.homing.methods = HomingMethods::WithHardStops;
    traits.homing.reference = HomeReference::Standstill;
    traits.homing.movesToOffset = true;
    traits.followingWindow = 50000;
    traits.followingTimeout = 10;
    traits.powerUpMode = 1;
    return traits;
}

constexpr DriveTraits makeRa() {
    DriveTraits traits;
    traits.name = "ra";
    traits.cycleStep = microseconds{125};
    traits.longestCycle = milliseconds{16};  // 125 µs · n, n = 1 … 128
    traits.maxPdoEntries = 16;
    traits.maxPdoBytes = 32;
    traits.maxAssignedPdos = 1;
    traits.detailedRangeAborts = false;
    traits.emergencies = true;
    traits.lostTargetLimit = 4;  // E.815
    traits.followingErrorPanel = 0x600;
    traits.communicationPanel = 0x815;
    traits.panelObject = 0x3EE1;
    traits.errorRegisterMotion = 0x80;
    traits.stopOptions = false;
    // Transition 16 is listed, so Quick stop active is a resting state after a ramp by 6085h.
    traits.quickStopDefault = 6;
    traits.disableDefault = 0;
    traits.haltInCyclicModes = true;
    // 6502h reads 3A0h, without PP, which two chapters describe.
    traits.modes = 0x3A1;
    traits.volatilePairs = true;
    traits.virtualInputs = true;
    traits.probeCountsInStatus = true;
    traits.overloadAlarm = 0x130;
    traits.overloadWarning = 0x910;
    traits.torqueSlopeIsTime = true;
    traits.profileSpeedInTorque = true;
    traits.dcLockedInBit8 = true;
    traits.zeroSpeedInBit14 = true;
    traits.unit = MotionUnit::TenthRpm;
    traits.homing.methods = HomingMethods::WithoutReversal;
    traits.homing.zeroAllowed = false;
    traits.homing.backsOffSlowly = false;
    traits.followingWindow = 3840000;
    return traits;
}

constexpr DriveTraits makeGeneric() {
    DriveTraits traits;
    traits.name = "generic";
    traits.modes = 0x3AD;
    traits.faultReactionDefault = 2;
    traits.changeOnSetPoint = true;
    return traits;
}

constexpr DriveTraits Cd300e = makeCd300e();
constexpr DriveTraits Ra = makeRa();
constexpr DriveTraits Generic = makeGeneric();

}  // namespace

bool DriveTraits::allowsCycle(core::Duration cycle) const noexcept {
    if (cycle <= core::Duration{0}) return false;
    if (longestCycle != core::Duration{0} && cycle > longestCycle) return false;
    if (!allowedCycles.empty()) {
        return std::find(allowedCycles.begin(), allowedCycles.end(), cycle) != allowedCycles.end();
    }
    return cycleStep == core::Duration{0} || cycle.count() % cycleStep.count() == 0;
}

bool DriveTraits::supportsMode(std::int8_t mode) const noexcept {
    return mode >= 1 && mode <= 32 && (modes >> (mode - 1) & 1U) != 0;
}

bool DriveTraits::supportsHoming(std::int8_t method) const noexcept {
    return (method == 0 && homing.zeroAllowed) || homingSupported(homing.methods, method);
}

const DriveTraits& driveTraits(std::string_view profile) noexcept {
    if (profile == Cd300e.name) return Cd300e;
    if (profile == Ra.name) return Ra;
    return Generic;
}

}  // namespace takt::twin
