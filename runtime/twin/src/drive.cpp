#include "drive.hpp"

#include <algorithm>

namespace takt::twin {

namespace cia = core::cia402;
using core::cia402::Mode;

namespace {

constexpr double NanosecondsPerSecond = 1e9;
constexpr double PerMille = 1000.0;

std::uint32_t atLeastOne(std::uint32_t value) noexcept {
    return value == 0 ? 1 : value;
}

}  // namespace

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
    dictionary_.set(objects_.encoderIncrements, PositionScale::IncrementsPerTurn);
    dictionary_.set(objects_.feed, params.countsPerTurn);
    if (traits_.gearObjects) takeGear();
    hold(motor_.position());
    report(false, false);
}

void Drive::setCycle(core::Duration cycle) noexcept {
    cycleTime_ = cycle;
    stepSeconds_ = static_cast<double>(cycle.count()) / NanosecondsPerSecond / subSteps_;
    servo_ = Servo{motor_, stepSeconds_, traits_.ratedTorque * traits_.torqueLimit};
    servo_.reset(motor_);
}

TorqueBounds Drive::torqueBounds() const noexcept {
    const double perMille = traits_.ratedTorque / PerMille;
    const auto torque = [&](ObjectRef object) {
        return static_cast<double>(dictionary_.getUnsigned(object)) * perMille;
    };
    TorqueBounds bounds{torque(objects_.positiveTorque), torque(objects_.negativeTorque), 0.0};
    if (source_ == Source::Torque) {
        if (traits_.limitsInTorqueModes && positiveLimit()) bounds.positive = 0.0;
        if (traits_.limitsInTorqueModes && negativeLimit()) bounds.negative = 0.0;
    } else if (source_ == Source::Interpolator || source_ == Source::Speed) {
        bounds.offset =
            static_cast<double>(dictionary_.getSigned(objects_.torqueOffset)) * perMille;
    }
    return bounds;
}

void Drive::advance(std::uint32_t steps) noexcept {
    if (!powered_) {
        torque_ = 0.0;
        for (std::uint32_t i = 0; i < steps; ++i) motor_.step(0.0, motor_.hasBrake(), stepSeconds_);
        return;
    }
    const TorqueBounds bounds = torqueBounds();
    for (std::uint32_t i = 0; i < steps; ++i) {
        const double before = motor_.position();
        stepControl(bounds);
        motor_.step(torque_, false, stepSeconds_);
        nextDemand();
        if (probe_.armed()) probe_.step(probeSignals(before), probeTime());
    }
}

void Drive::stepControl(const TorqueBounds& bounds) noexcept {
    if (source_ == Source::Torque) {
        torqueDemand_ = torqueStep_ == 0.0 ? torqueTarget_
                                           : std::clamp(torqueTarget_, torqueDemand_ - torqueStep_,
                                                        torqueDemand_ + torqueStep_);
        torque_ = servo_.limited(torqueDemand_, torqueSpeed_, motor_, bounds);
        return;
    }
    torque_ = servo_.torque(demand_, motor_, bounds);
}

void Drive::nextDemand() noexcept {
    switch (source_) {
        case Source::Hold:
            return;
        case Source::Interpolator:
            interpolate();
            return;
        case Source::Generator:
            if (inMode(Mode::Homing) && stop_ == Stop::None) {
                homing_.step(motor_, torque_, generator_);
            }
            demand_ = generator_.step(stepSeconds_);
            // A speed is demanded, not a position: what the motor loses it does not make up for.
            if (inMode(Mode::ProfileVelocity) && stop_ == Stop::None)
                demand_.position = motor_.position();
            return;
        case Source::Speed:
            if (stepsLeft_ > 0) {
                --stepsLeft_;
                demand_.velocity =
                    stepsLeft_ == 0 ? interpolationEnd_ : demand_.velocity + interpolation_;
            } else {
                demand_.acceleration = 0.0;
            }
            demand_.position = motor_.position();
            return;
        case Source::Torque:
            demand_ = {motor_.position(), motor_.velocity(), 0.0};
            return;
    }
}

void Drive::interpolate() noexcept {
    if (stepsLeft_ == 0) {  // no new target: stand at the last one
        demand_.velocity = 0.0;
        demand_.acceleration = 0.0;
        return;
    }
    --stepsLeft_;
    demand_.position = stepsLeft_ == 0 ? interpolationEnd_ : demand_.position + interpolation_;
}

void Drive::cycle(bool outputsValid, bool dcLocked) noexcept {
    sinceStart_ += cycleTime_;
    const auto control =
        outputsValid ? static_cast<std::uint16_t>(dictionary_.getUnsigned(objects_.controlWord))
                     : cia::DisableVoltage;
    readInputs();
    superviseFollowing();
    superviseLoad();
    stepStates(control);
    selectMode(control);
    if (state_ == State::OperationEnabled && stop_ == Stop::None) stepMode(control);
    superviseTarget();
    lastControl_ = control;
    report(outputsValid, dcLocked);
}

void Drive::selectMode(std::uint16_t controlWord) noexcept {
    const auto wanted = static_cast<std::int8_t>(dictionary_.getSigned(objects_.mode));
    // An unsupported mode is not taken; 6061h goes on showing the one that is active.
    if (wanted == activeMode_ || (wanted != 0 && !traits_.supportsMode(wanted))) return;
    activeMode_ = wanted;
    homing_.clear();
    if (traits_.startsOnModeChange) lastControl_ &= static_cast<std::uint16_t>(~cia::HomingStart);
    if (powered_ && stop_ == Stop::None)
        enterMode(!traits_.startsOnModeChange && (controlWord & cia::HomingStart) != 0);
}

void Drive::enterMode(bool bit4) noexcept {
    halted_ = false;
    blocked_ = false;
    softLimited_ = false;
    reached_ = false;
    reachedTime_ = core::Duration{0};
    target_ = userPosition(demand_.position);
    setPoints_.clear(target_, bit4);
    torqueDemand_ = torque_;
    // What moves goes on from its present demand; without a set-point of the new mode it stops.
    if (demand_.velocity != 0.0) rampDown(rate(objects_.profileDeceleration));
}

void Drive::stepMode(std::uint16_t controlWord) noexcept {
    switch (static_cast<Mode>(activeMode_)) {
        case Mode::ProfilePosition:
            stepProfilePosition(controlWord);
            break;
        case Mode::ProfileVelocity:
            stepProfileVelocity(controlWord);
            break;
        case Mode::ProfileTorque:
        case Mode::CyclicSynchronousTorque:
            stepTorque(controlWord);
            break;
        case Mode::Homing:
            stepHoming(controlWord);
            break;
        case Mode::CyclicSynchronousPosition:
            stepPosition(controlWord);
            break;
        case Mode::CyclicSynchronousVelocity:
            stepVelocity(controlWord);
            break;
        case Mode::None:
            break;
    }
}

void Drive::hold(double position) noexcept {
    source_ = Source::Hold;
    demand_ = {position, 0.0, 0.0};
    target_ = userPosition(position);
}

void Drive::rampDown(double deceleration) noexcept {
    generator_.begin(demand_);
    generator_.run(0.0, deceleration);
    source_ = Source::Generator;
}

void Drive::superviseFollowing() noexcept {
    followingError_ =
        powered_ ? userPosition(demand_.position) - userPosition(motor_.position()) : 0;
    if (blocked_ && powered_ && inMode(Mode::CyclicSynchronousPosition))
        followingError_ = target_ - userPosition(motor_.position());
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

void Drive::superviseLoad() noexcept {
    if (traits_.overloadAlarm == 0) return;
    const double ratio = torque_ / traits_.ratedTorque;
    load_ += (ratio * ratio - load_) * static_cast<double>(cycleTime_.count()) /
             static_cast<double>(traits_.overloadTime.count());
    constexpr double WarningShare = 0.95;
    if (powered_ && load_ > 1.0) raiseAlarm(traits_.overloadAlarm);
    if (load_ > WarningShare) {
        if (!overloaded_) raiseAlarm(traits_.overloadWarning);
        overloaded_ = true;
    } else if (overloaded_) {
        overloaded_ = false;
        clearWarning();  // by itself
    }
}

void Drive::superviseTarget() noexcept {
    const std::int64_t actual = userPosition(motor_.position());
    bool within = false;
    core::Duration time{0};
    const auto milliseconds = [&](ObjectRef object) {
        return core::Duration{std::chrono::milliseconds{dictionary_.getUnsigned(object)}};
    };
    if (inMode(Mode::ProfilePosition) || inMode(Mode::CyclicSynchronousPosition)) {
        const bool profile = inMode(Mode::ProfilePosition);
        const bool ended = profile ? !setPoints_.active() : demand_.velocity == 0.0;
        const std::int64_t left = (profile ? setPoints_.lastTarget() - actual : followingError_);
        const auto window =
            static_cast<std::int64_t>(dictionary_.getUnsigned(objects_.positionWindow));
        within = ended && left <= window && left >= -window;
        time = milliseconds(objects_.positionTime);
    } else if (inMode(Mode::ProfileVelocity)) {
        const double window = velocityTurns(
            static_cast<std::int64_t>(dictionary_.getUnsigned(objects_.velocityWindow)));
        const double left =
            velocityTurns(dictionary_.getSigned(objects_.targetVelocity)) - motor_.velocity();
        within = left <= window && left >= -window;
        time = milliseconds(objects_.velocityTime);
    }
    if (!within || !powered_) {
        reached_ = false;
        reachedTime_ = core::Duration{0};
        return;
    }
    reached_ = reachedTime_ >= time;
    if (!reached_) reachedTime_ += cycleTime_;
}

}  // namespace takt::twin
