#pragma once

#include <array>
#include <takt/twin/drive_traits.hpp>

#include "object_dictionary.hpp"

namespace takt::twin {

/// The objects of the drive profile that the simulated drive reads and writes. Those that the
/// device's description lacks exist too, with the drive's own value, but the bus does not see them.
struct DriveObjects {
    DriveObjects(ObjectDictionary& dictionary, const DriveTraits& traits);

    ObjectRef errorRegister, errorCode, panelCode;
    ObjectRef controlWord, statusWord, mode, modeDisplay;
    ObjectRef quickStopOption, shutdownOption, disableOption, haltOption, faultOption;
    ObjectRef positionActual, positionDemand, velocityActual, velocityDemand;
    ObjectRef torqueActual, torqueDemand, followingError;
    ObjectRef followingWindow, followingTimeout, positionWindow, positionTime;
    ObjectRef velocityWindow, velocityTime;
    ObjectRef targetPosition, targetVelocity, targetTorque;
    ObjectRef positionOffset, velocityOffset, torqueOffset;
    ObjectRef profileVelocity, profileAcceleration, profileDeceleration, quickStopDeceleration;
    ObjectRef torqueSlope, maxTorque, positiveTorque, negativeTorque;
    ObjectRef maxProfileVelocity, maxMotorSpeed, torqueModeSpeed;
    ObjectRef softLimitsOn, softLimitMinimum, softLimitMaximum;
    ObjectRef homeOffset, homingMethod, homingFast, homingSlow, homingAcceleration;
    ObjectRef homingCurrent, homingOffsetMode, homingOffsetSpeed;
    ObjectRef encoderIncrements, gearMotor, gearShaft, feed, feedShaft;
    ObjectRef digitalInputs;
    ObjectRef virtualInputs, virtualMask;  ///< 60FEh of a drive that takes its inputs from there
    std::array<ObjectRef, 5> inputFunction;
    ObjectRef probeFunction, probeStatus;
    /// First probe rising, falling, second probe rising, falling.
    std::array<ObjectRef, 4> probePosition, probeTime, probeCount;

private:
    void addMotion(ObjectDictionary& dictionary, const DriveTraits& traits);
    void addLimits(ObjectDictionary& dictionary, const DriveTraits& traits);
    void addHoming(ObjectDictionary& dictionary);
    void addGear(ObjectDictionary& dictionary);
    void addInputs(ObjectDictionary& dictionary, const DriveTraits& traits);
};

}  // namespace takt::twin
