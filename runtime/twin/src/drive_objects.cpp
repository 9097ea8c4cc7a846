#include "drive_objects.hpp"

#include <takt/core/cia402.hpp>

namespace takt::twin {

namespace cia = core::cia402;
using wire::DataType;

namespace {

constexpr std::int64_t PerMilleTorqueLimit = 3500;
constexpr std::uint16_t NoObject = 0x5FFF;  // a place for values that this drive does not show

class Maker {
public:
    explicit Maker(ObjectDictionary& dictionary) : dictionary_{dictionary} {}
    ObjectRef operator()(std::uint16_t index, DataType type, std::int64_t value = 0,
                         std::uint8_t subindex = 0) const {
        return dictionary_.internal(index, subindex, type, value);
    }

private:
    ObjectDictionary& dictionary_;
};

}  // namespace

DriveObjects::DriveObjects(ObjectDictionary& dictionary, const DriveTraits& traits) {
    const Maker make{dictionary};
    errorRegister = make(0x1001, DataType::Unsigned8);
    errorCode = make(cia::ErrorCode, DataType::Unsigned16);
    panelCode = make(traits.panelObject != 0 ? traits.panelObject : NoObject, DataType::Unsigned16);
    controlWord = make(cia::ControlWord, DataType::Unsigned16);
    statusWord = make(cia::StatusWord, DataType::Unsigned16);
    quickStopOption = make(cia::QuickStopOption, DataType::Integer16, traits.quickStopDefault);
    shutdownOption = make(0x605B, DataType::Integer16, traits.shutdownDefault);
    disableOption = make(0x605C, DataType::Integer16, traits.disableDefault);
    haltOption = make(0x605D, DataType::Integer16, traits.haltDefault);
    faultOption = make(0x605E, DataType::Integer16, traits.faultReactionDefault);
    mode = make(cia::ModesOfOperation, DataType::Integer8, traits.powerUpMode);
    modeDisplay = make(cia::ModesOfOperationDisplay, DataType::Integer8);
    digitalInputs = make(cia::DigitalInputs, DataType::Unsigned32);
    addMotion(dictionary, traits);
    addLimits(dictionary, traits);
    addHoming(dictionary);
    addGear(dictionary);
    addInputs(dictionary, traits);
}

void DriveObjects::addInputs(ObjectDictionary& dictionary, const DriveTraits& traits) {
    const Maker make{dictionary};
    virtualInputs = make(cia::DigitalOutputs, DataType::Unsigned32, 0, 1);
    virtualMask = make(cia::DigitalOutputs, DataType::Unsigned32, 0, 2);
    for (std::uint8_t i = 0; i < inputFunction.size(); ++i) {
        inputFunction[i] =
            traits.virtualInputs
                ? make(static_cast<std::uint16_t>(0x2500 + i), DataType::Unsigned16)
                : make(0x2402, DataType::Unsigned8, 0, static_cast<std::uint8_t>(i + 1));
    }
    probeFunction = make(cia::TouchProbeFunction, DataType::Unsigned16);
    probeStatus = make(0x60B9, DataType::Unsigned16);
    for (std::uint16_t i = 0; i < probePosition.size(); ++i) {
        const auto at = [i](std::uint16_t first) { return static_cast<std::uint16_t>(first + i); };
        probePosition[i] = make(at(0x60BA), DataType::Integer32);
        probeTime[i] = make(at(0x60D1), DataType::Unsigned32);
        probeCount[i] = make(at(0x60D5), DataType::Unsigned16);
    }
}

void DriveObjects::addGear(ObjectDictionary& dictionary) {
    const Maker make{dictionary};
    encoderIncrements = make(0x608F, DataType::Unsigned32, 0, 1);
    gearMotor = make(0x6091, DataType::Unsigned32, 1, 1);
    gearShaft = make(0x6091, DataType::Unsigned32, 1, 2);
    feed = make(0x6092, DataType::Unsigned32, 0, 1);
    feedShaft = make(0x6092, DataType::Unsigned32, 1, 2);
}

void DriveObjects::addMotion(ObjectDictionary& dictionary, const DriveTraits& traits) {
    const Maker make{dictionary};
    positionActual = make(cia::PositionActual, DataType::Integer32);
    positionDemand = make(0x6062, DataType::Integer32);
    velocityActual = make(cia::VelocityActual, DataType::Integer32);
    velocityDemand = make(0x606B, DataType::Integer32);
    torqueActual = make(cia::TorqueActual, DataType::Integer16);
    torqueDemand = make(0x6074, DataType::Integer16);
    followingError = make(cia::FollowingErrorActual, DataType::Integer32);
    targetPosition = make(cia::TargetPosition, DataType::Integer32);
    targetVelocity = make(cia::TargetVelocity, DataType::Integer32);
    targetTorque = make(cia::TargetTorque, DataType::Integer16);
    positionOffset = make(0x60B0, DataType::Integer32);
    velocityOffset = make(0x60B1, DataType::Integer32);
    torqueOffset = make(0x60B2, DataType::Integer16);
    profileVelocity = make(0x6081, DataType::Unsigned32);
    profileAcceleration = make(0x6083, DataType::Unsigned32, 1000000);
    profileDeceleration = make(cia::ProfileDeceleration, DataType::Unsigned32, 1000000);
    quickStopDeceleration = make(cia::QuickStopDeceleration, DataType::Unsigned32, 1000000);
    torqueSlope = make(0x6087, DataType::Unsigned32);
    followingWindow = make(cia::FollowingErrorWindow, DataType::Unsigned32, traits.followingWindow);
    followingTimeout =
        make(cia::FollowingErrorTimeout, DataType::Unsigned16, traits.followingTimeout);
    positionWindow = make(0x6067, DataType::Unsigned32, 10);
    positionTime = make(0x6068, DataType::Unsigned16);
    velocityWindow = make(0x606D, DataType::Unsigned16);
    velocityTime = make(0x606E, DataType::Unsigned16);
}

void DriveObjects::addLimits(ObjectDictionary& dictionary, const DriveTraits& traits) {
    const Maker make{dictionary};
    maxTorque = make(0x6072, DataType::Unsigned16, PerMilleTorqueLimit);
    positiveTorque = make(0x60E0, DataType::Unsigned16, PerMilleTorqueLimit);
    negativeTorque = make(0x60E1, DataType::Unsigned16, PerMilleTorqueLimit);
    maxProfileVelocity = make(0x607F, DataType::Unsigned32);
    maxMotorSpeed = make(0x6080, DataType::Unsigned32);
    const bool own = traits.torqueModeSpeedObject != 0;
    torqueModeSpeed = make(own ? traits.torqueModeSpeedObject : NoObject, DataType::Unsigned32, 0,
                           own ? traits.torqueModeSpeedSubindex : std::uint8_t{1});
    softLimitMinimum = make(cia::SoftwarePositionLimit, DataType::Integer32, 0, 1);
    softLimitMaximum = make(cia::SoftwarePositionLimit, DataType::Integer32, 0, 2);
    const bool switched = traits.softLimitSwitchObject != 0;
    softLimitsOn =
        make(switched ? traits.softLimitSwitchObject : NoObject, DataType::Unsigned16,
             switched ? 0 : 1, switched ? traits.softLimitSwitchSubindex : std::uint8_t{2});
}

void DriveObjects::addHoming(ObjectDictionary& dictionary) {
    const Maker make{dictionary};
    homeOffset = make(cia::HomeOffset, DataType::Integer32);
    homingMethod = make(cia::HomingMethod, DataType::Integer8);
    homingFast = make(cia::HomingSpeeds, DataType::Unsigned32, 35000, 1);
    homingSlow = make(cia::HomingSpeeds, DataType::Unsigned32, 15000, 2);
    homingCurrent = make(cia::HomingSpeeds, DataType::Unsigned16, 20, 4);
    homingOffsetMode = make(cia::HomingSpeeds, DataType::Unsigned8, 0, 5);
    homingOffsetSpeed = make(cia::HomingSpeeds, DataType::Unsigned16, 200, 7);
    homingAcceleration = make(cia::HomingAcceleration, DataType::Unsigned32, 1000000);
}

}  // namespace takt::twin
