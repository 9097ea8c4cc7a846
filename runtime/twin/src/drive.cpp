#include "drive.hpp"

#include <algorithm>

namespace takt::twin {

namespace cia = core::cia402;
using core::cia402::Mode;
using wire::DataType;

namespace {

constexpr double NanosecondsPerSecond = 1e9;
constexpr double TenthRpmPerTurn = 600.0;  // 0.1 rpm in one turn per second
constexpr double SecondsPerMinute = 60.0;
constexpr double TenthsPerAmpere = 10.0;
constexpr double Standstill = 0.01;  // turns/s
constexpr double HardestStop = 1e4;  // turns/s², where a ramp is 0
constexpr std::int64_t TorquePerMille = 1000;
constexpr std::int64_t DefaultTorqueLimit = 3500;

std::uint32_t atLeastOne(std::uint32_t value) noexcept {
    return value == 0 ? 1 : value;
}

}  // namespace

DriveObjects::DriveObjects(ObjectDictionary& dictionary, const DriveTraits& traits) {
    const auto make = [&](std::uint16_t index, DataType type, std::int64_t value = 0,
                          std::uint8_t subindex = 0) {
        return dictionary.internal(index, subindex, type, value);
    };
    errorRegister = make(0x1001, DataType::Unsigned8);
    errorCode = make(cia::ErrorCode, DataType::Unsigned16);
    controlWord = make(cia::ControlWord, DataType::Unsigned16);
    statusWord = make(cia::StatusWord, DataType::Unsigned16);
    quickStopOption = make(cia::QuickStopOption, DataType::Integer16, traits.quickStopDefault);
    shutdownOption = make(0x605B, DataType::Integer16, traits.shutdownDefault);
    disableOption = make(0x605C, DataType::Integer16, traits.disableDefault);
    mode = make(cia::ModesOfOperation, DataType::Integer8, traits.powerUpMode);
    modeDisplay = make(cia::ModesOfOperationDisplay, DataType::Integer8);
    positionActual = make(cia::PositionActual, DataType::Integer32);
    positionDemand = make(0x6062, DataType::Integer32);
    velocityActual = make(cia::VelocityActual, DataType::Integer32);
    torqueActual = make(cia::TorqueActual, DataType::Integer16);
    followingError = make(cia::FollowingErrorActual, DataType::Integer32);
    followingWindow = make(cia::FollowingErrorWindow, DataType::Unsigned32, traits.followingWindow);
    followingTimeout =
        make(cia::FollowingErrorTimeout, DataType::Unsigned16, traits.followingTimeout);
    targetPosition = make(cia::TargetPosition, DataType::Integer32);
    profileDeceleration = make(cia::ProfileDeceleration, DataType::Unsigned32, 1000000);
    quickStopDeceleration = make(cia::QuickStopDeceleration, DataType::Unsigned32, 1000000);
    positiveTorque = make(0x60E0, DataType::Unsigned16, DefaultTorqueLimit);
    negativeTorque = make(0x60E1, DataType::Unsigned16, DefaultTorqueLimit);
    homeOffset = make(cia::HomeOffset, DataType::Integer32);
    homingMethod = make(cia::HomingMethod, DataType::Integer8);
    homingFast = make(cia::HomingSpeeds, DataType::Unsigned32, 35000, 1);
    homingSlow = make(cia::HomingSpeeds, DataType::Unsigned32, 15000, 2);
    homingAcceleration = make(cia::HomingAcceleration, DataType::Unsigned32, 1000000);
    homingCurrent = make(cia::HomingSpeeds, DataType::Unsigned16, 20, 4);
    homingOffsetMode = make(cia::HomingSpeeds, DataType::Unsigned8, 0, 5);
    homingOffsetSpeed = make(cia::HomingSpeeds, DataType::Unsigned16, 200, 7);
    digitalInputs = make(cia::DigitalInputs, DataType::Unsigned32);
    panelCode = make(traits.panelObject != 0 ? traits.panelObject : std::uint16_t{0x5FFF},
                     DataType::Unsigned16);
}

Drive::Drive(const TwinDeviceParams& params, const DriveTraits& traits,
             ObjectDictionary& dictionary, core::Duration cycle)
    : traits_{traits},
      dictionary_{dictionary},
      objects_{dictionary, traits},
      scale_{params.countsPerTurn, traits.truncatesPositions},
      motor_{params.mechanics},
      cycleTime_{cycle},
      subSteps_{atLeastOne(params.subSteps)},
      stepSeconds_{static_cast<double>(cycle.count()) / NanosecondsPerSecond / subSteps_},
      servo_{motor_, stepSeconds_, traits.ratedTorque * traits.torqueLimit} {
    hold(motor_.position());
    report(false, false);
}

void Drive::setCycle(core::Duration cycle) noexcept {
    cycleTime_ = cycle;
    stepSeconds_ = static_cast<double>(cycle.count()) / NanosecondsPerSecond / subSteps_;
    servo_ = Servo{motor_, stepSeconds_, traits_.ratedTorque * traits_.torqueLimit};
    servo_.reset(motor_);
}

void Drive::advance(std::uint32_t steps) noexcept {
    const double perMille = traits_.ratedTorque / static_cast<double>(TorquePerMille);
    for (std::uint32_t i = 0; i < steps; ++i) {
        if (!powered_) {
            torque_ = 0.0;
            motor_.step(0.0, motor_.hasBrake(), stepSeconds_);
            continue;
        }
        const auto positive = static_cast<double>(dictionary_.getUnsigned(objects_.positiveTorque));
        const auto negative = static_cast<double>(dictionary_.getUnsigned(objects_.negativeTorque));
        torque_ = servo_.torque(demand_, motor_, positive * perMille, negative * perMille);
        motor_.step(torque_, false, stepSeconds_);
        nextDemand();
    }
}

void Drive::nextDemand() noexcept {
    switch (source_) {
        case Source::Hold:
            return;
        case Source::Interpolator:
            if (stepsLeft_ == 0) {  // no new target: stand at the last one
                demand_.velocity = 0.0;
                demand_.acceleration = 0.0;
                return;
            }
            --stepsLeft_;
            demand_.position =
                stepsLeft_ == 0 ? interpolationEnd_ : demand_.position + interpolation_;
            return;
        case Source::Generator:
            if (activeMode_ == static_cast<std::int8_t>(Mode::Homing) && stop_ == Stop::None) {
                homing_.step(motor_, torque_, generator_);
            }
            demand_ = generator_.step(stepSeconds_);
            return;
    }
}

void Drive::cycle(bool outputsValid, bool dcLocked) noexcept {
    sinceStart_ += cycleTime_;
    const auto control =
        outputsValid ? static_cast<std::uint16_t>(dictionary_.getUnsigned(objects_.controlWord))
                     : cia::DisableVoltage;
    superviseFollowing();
    stepStates(control);
    selectMode();
    if (state_ == State::OperationEnabled && stop_ == Stop::None) stepMode(control);
    lastControl_ = control;
    report(outputsValid, dcLocked);
}

void Drive::selectMode() noexcept {
    const auto wanted = static_cast<std::int8_t>(dictionary_.getSigned(objects_.mode));
    // An unsupported mode is not taken; 6061h goes on showing the one that is active.
    if (wanted == activeMode_ || (wanted != 0 && !traits_.supportsMode(wanted))) return;
    activeMode_ = wanted;
    homing_.clear();
    halted_ = false;
    if (powered_ && stop_ == Stop::None) hold(demand_.position);
}

void Drive::stepMode(std::uint16_t controlWord) noexcept {
    switch (static_cast<Mode>(activeMode_)) {
        case Mode::CyclicSynchronousPosition:
            stepPosition(controlWord);
            break;
        case Mode::Homing:
            stepHoming(controlWord);
            break;
        case Mode::None:
        case Mode::ProfilePosition:
        case Mode::ProfileVelocity:
        case Mode::ProfileTorque:
        case Mode::CyclicSynchronousVelocity:
        case Mode::CyclicSynchronousTorque:
            break;
    }
}

void Drive::stepPosition(std::uint16_t controlWord) noexcept {
    const auto received =
        static_cast<std::uint32_t>(dictionary_.getUnsigned(objects_.targetPosition));
    // 607Ah is a 32-bit window on an unbounded position: the nearest one is meant.
    target_ += static_cast<std::int32_t>(received - static_cast<std::uint32_t>(target_));
    const bool halt = traits_.haltInCsp && (controlWord & cia::Halt) != 0;
    if (halt) {
        if (!halted_)
            rampDown(velocityTurns(
                static_cast<std::int64_t>(dictionary_.getUnsigned(objects_.profileDeceleration))));
        halted_ = true;
        return;
    }
    halted_ = false;
    const double target = PositionScale::turns(scale_.fromCounts(target_) + zero_);
    blocked_ = (target > demand_.position && motor_.positiveLimit()) ||
               (target < demand_.position && motor_.negativeLimit());
    interpolateTo(blocked_ ? demand_.position : target);
}

void Drive::interpolateTo(double target) noexcept {
    const double distance = target - demand_.position;
    const double velocity = distance / (stepSeconds_ * subSteps_);
    const double before = source_ == Source::Interpolator ? demand_.velocity : 0.0;
    demand_.acceleration = (velocity - before) / (stepSeconds_ * subSteps_);
    demand_.velocity = velocity;
    interpolation_ = distance / subSteps_;
    interpolationEnd_ = target;
    stepsLeft_ = subSteps_;
    source_ = Source::Interpolator;
}

void Drive::hold(double position) noexcept {
    source_ = Source::Hold;
    demand_ = {position, 0.0, 0.0};
    target_ = userPosition(position);
}

void Drive::rampDown(double deceleration) noexcept {
    generator_.begin(demand_);
    generator_.run(0.0, deceleration > 0.0 ? deceleration : HardestStop);
    source_ = Source::Generator;
}

void Drive::stepHoming(std::uint16_t controlWord) noexcept {
    const bool start = (controlWord & cia::HomingStart) != 0;
    const bool rising = start && (lastControl_ & cia::HomingStart) == 0;
    if (rising && (controlWord & cia::Halt) == 0) {
        startHoming();
    } else if (!start || (controlWord & cia::Halt) != 0) {
        homing_.interrupt(generator_);
    }
    if (homing_.state() == Homing::State::Done && !homed_) takeHome();
}

void Drive::startHoming() noexcept {
    const auto number = [&](ObjectRef object) {
        return static_cast<std::int64_t>(dictionary_.getUnsigned(object));
    };
    HomingSettings settings;
    settings.method = static_cast<std::int8_t>(dictionary_.getSigned(objects_.homingMethod));
    settings.fastSpeed = velocityTurns(number(objects_.homingFast));
    settings.slowSpeed = velocityTurns(number(objects_.homingSlow));
    settings.acceleration = velocityTurns(number(objects_.homingAcceleration));
    if (settings.acceleration <= 0.0) settings.acceleration = HardestStop;
    settings.movesToOffset = traits_.homing.movesToOffset && number(objects_.homingOffsetMode) == 0;
    settings.offset = static_cast<double>(dictionary_.getSigned(objects_.homeOffset)) /
                      static_cast<double>(scale_.countsPerTurn());
    settings.offsetSpeed =
        static_cast<double>(number(objects_.homingOffsetSpeed)) / SecondsPerMinute;
    settings.blockTorque = static_cast<double>(number(objects_.homingCurrent)) / TenthsPerAmpere *
                           traits_.torquePerAmpere;
    settings.traits = traits_.homing;
    homed_ = false;
    generator_.begin(demand_);
    source_ = Source::Generator;
    homing_.start(settings, motor_, generator_);
}

void Drive::takeHome() noexcept {
    const std::int64_t offset = dictionary_.getSigned(objects_.homeOffset);
    if (const std::optional<double> zero = homing_.zero()) {
        zero_ = PositionScale::increments(*zero);
    } else {
        zero_ = PositionScale::increments(homing_.home()) -
                scale_.fromCounts(traits_.homing.offsetSign * offset);
    }
    homed_ = true;
}

void Drive::superviseFollowing() noexcept {
    followingError_ =
        powered_ ? userPosition(demand_.position) - userPosition(motor_.position()) : 0;
    if (blocked_ && powered_) followingError_ = target_ - userPosition(motor_.position());
    const auto window =
        static_cast<std::int64_t>(dictionary_.getUnsigned(objects_.followingWindow));
    const bool outside = followingError_ > window || followingError_ < -window;
    if (!outside || !powered_) {
        followingTime_ = core::Duration{0};
        return;
    }
    followingTime_ += cycleTime_;
    const std::chrono::milliseconds timeout{dictionary_.getUnsigned(objects_.followingTimeout)};
    if (followingTime_ <= timeout) return;
    followingFault_ = true;
    fail(traits_.followingErrorCode, traits_.followingErrorPanel, traits_.errorRegisterMotion);
}

double Drive::velocityTurns(std::int64_t value) const noexcept {
    const double perTurn = traits_.unit == MotionUnit::TenthRpm
                               ? TenthRpmPerTurn
                               : static_cast<double>(scale_.countsPerTurn());
    return static_cast<double>(value) / perTurn;
}

std::int64_t Drive::userPosition(double turns) const noexcept {
    return scale_.counts(PositionScale::increments(turns) - zero_);
}

bool Drive::motorStands() const noexcept {
    return motor_.velocity() < Standstill && motor_.velocity() > -Standstill;
}

}  // namespace takt::twin
