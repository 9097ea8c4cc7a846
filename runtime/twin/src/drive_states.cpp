// The power drive state machine of IEC 61800-7-201 clause 6, with the stop options of clause 7.

#include "drive.hpp"
#include "drive_alarms.hpp"

namespace takt::twin {

namespace cia = core::cia402;

namespace {

constexpr std::uint16_t BitSwitchOn = 0x0001;
constexpr std::uint16_t BitVoltage = 0x0002;
constexpr std::uint16_t BitNoQuickStop = 0x0004;
constexpr std::uint16_t BitEnable = 0x0008;

// 605Ah; 5 and 6 remain in Quick stop active.
constexpr std::int64_t QuickStopCoast = 0;
constexpr std::int64_t QuickStopByProfile = 1;
constexpr std::int64_t QuickStopByRamp = 2;
constexpr std::int64_t QuickStopByProfileStay = 5;
constexpr std::int64_t QuickStopByRampStay = 6;

constexpr std::uint16_t GearFault = 0xFF09;  // CD300E: gear ratio outside its range

// 605Eh; more than 2 stops at the limit of the current or voltage.
constexpr std::int64_t FaultReactionCoast = 0;
constexpr std::int64_t FaultReactionByProfile = 1;
constexpr std::int64_t FaultReactionByRamp = 2;

}  // namespace

Drive::Command Drive::decode(std::uint16_t controlWord) noexcept {
    if ((controlWord & cia::FaultReset) != 0) return Command::None;
    if ((controlWord & BitVoltage) == 0) return Command::DisableVoltage;
    if ((controlWord & BitNoQuickStop) == 0) return Command::QuickStop;
    if ((controlWord & BitSwitchOn) == 0) return Command::Shutdown;
    return (controlWord & BitEnable) == 0 ? Command::SwitchOn : Command::Enable;
}

std::int64_t Drive::option(ObjectRef object, std::int16_t fixed) const noexcept {
    return traits_.stopOptions ? dictionary_.getSigned(object) : fixed;
}

void Drive::stepStates(std::uint16_t controlWord) noexcept {
    const Command command = decode(controlWord);
    const bool reset =
        (controlWord & cia::FaultReset) != 0 && (lastControl_ & cia::FaultReset) == 0;
    const bool off = command == Command::DisableVoltage || command == Command::QuickStop;
    if (reset) clearWarning();
    finishStop();
    if (command != Command::Enable || state_ != State::SwitchedOn) enabling_ = core::Duration{-1};
    switch (state_) {
        case State::NotReadyToSwitchOn:
            if (sinceStart_ >= traits_.bootTime) state_ = State::SwitchOnDisabled;
            break;
        case State::SwitchOnDisabled:
            if (command == Command::Shutdown) state_ = State::ReadyToSwitchOn;
            break;
        case State::ReadyToSwitchOn:
            if (off) state_ = State::SwitchOnDisabled;
            if (command == Command::SwitchOn || command == Command::Enable)
                state_ = State::SwitchedOn;
            break;
        case State::SwitchedOn:
            if (off) state_ = State::SwitchOnDisabled;
            if (command == Command::Shutdown) state_ = State::ReadyToSwitchOn;
            if (command == Command::Enable) {
                enabling_ =
                    enabling_ < core::Duration{0} ? core::Duration{0} : enabling_ + cycleTime_;
                if (!gearValid_) {
                    fail(GearFault, GearFault, traits_.errorRegisterMotion);
                } else if (enabling_ >= traits_.enableTime) {
                    powerOn();
                }
            }
            break;
        case State::OperationEnabled:
            stepEnabled(command);
            break;
        case State::QuickStopActive:
            stepQuickStop(command);
            break;
        case State::FaultReactionActive:
            // Without a stop the power stage is off already; the state shows for one cycle.
            if (stop_ == Stop::None) state_ = State::Fault;
            break;
        case State::Fault:
            if (reset && resettable_) resetFault();
            break;
    }
}

void Drive::stepEnabled(Command command) noexcept {
    switch (command) {
        case Command::None:
        case Command::Enable:
            return;
        case Command::DisableVoltage:
            powerOff(State::SwitchOnDisabled);
            return;
        case Command::QuickStop:
            if (stop_ != Stop::QuickStop) beginQuickStop();
            return;
        case Command::Shutdown:
            if (stop_ == Stop::None) beginStop(Stop::Shutdown);
            return;
        case Command::SwitchOn:
            if (stop_ == Stop::None) beginStop(Stop::Disable);
            return;
    }
}

void Drive::stepQuickStop(Command command) noexcept {
    if (command == Command::DisableVoltage) {
        powerOff(State::SwitchOnDisabled);
    } else if (command == Command::Enable && quickStopStays_) {
        stop_ = Stop::None;
        hold(demand_.position);
        enterMode(true);
        state_ = State::OperationEnabled;
    }
}

void Drive::beginStop(Stop stop) noexcept {
    const bool shutdown = stop == Stop::Shutdown;
    const std::int64_t code = shutdown ? option(objects_.shutdownOption, traits_.shutdownDefault)
                                       : option(objects_.disableOption, traits_.disableDefault);
    if (code == 0) {  // coast
        powerOff(shutdown ? State::ReadyToSwitchOn : State::SwitchedOn);
        return;
    }
    stop_ = stop;
    homing_.clear();
    rampDown(rate(objects_.profileDeceleration));
}

void Drive::beginQuickStop() noexcept {
    const std::int64_t code = option(objects_.quickStopOption, traits_.quickStopDefault);
    if (code == QuickStopCoast) {
        powerOff(State::SwitchOnDisabled);
        return;
    }
    stop_ = Stop::QuickStop;
    state_ = State::QuickStopActive;
    quickStopStays_ = code >= QuickStopByProfileStay;
    homing_.clear();
    if (code == QuickStopByProfile || code == QuickStopByProfileStay) {
        rampDown(rate(objects_.profileDeceleration));
    } else if (code == QuickStopByRamp || code == QuickStopByRampStay) {
        rampDown(rate(objects_.quickStopDeceleration));
    } else {
        hold(motor_.position());  // at once, with all the torque there is
    }
}

void Drive::finishStop() noexcept {
    if (stop_ == Stop::None || !powered_) return;
    const bool rampDone = source_ != Source::Generator || generator_.finished();
    if (!rampDone || !motorStands()) return;
    switch (stop_) {
        case Stop::None:
            return;
        case Stop::QuickStop:
            if (!quickStopStays_) powerOff(State::SwitchOnDisabled);
            return;
        case Stop::Shutdown:
            powerOff(State::ReadyToSwitchOn);
            return;
        case Stop::Disable:
            powerOff(State::SwitchedOn);
            return;
        case Stop::Fault:
            powerOff(State::Fault);
            return;
    }
}

void Drive::powerOn() noexcept {
    state_ = State::OperationEnabled;
    powered_ = true;
    stop_ = Stop::None;
    servo_.reset(motor_);
    torque_ = 0.0;
    hold(motor_.position());
    enterMode((lastControl_ & cia::HomingStart) != 0);
}

void Drive::powerOff(State next) noexcept {
    state_ = next;
    powered_ = false;
    stop_ = Stop::None;
    blocked_ = false;
    softLimited_ = false;
    enabling_ = core::Duration{-1};
    if (homing_.state() != Homing::State::Done) homing_.clear();
}

void Drive::fail(std::uint16_t code, std::uint16_t panel, std::uint8_t errorRegister) noexcept {
    if (state_ == State::Fault || state_ == State::FaultReactionActive) return;
    resettable_ = true;
    const std::int64_t reaction = dictionary_.getSigned(objects_.faultOption);
    if (powered_ && reaction != FaultReactionCoast) {
        beginFaultStop(reaction);
    } else {
        powerOff(powered_ ? State::FaultReactionActive : State::Fault);
    }
    dictionary_.set(objects_.errorCode, code);
    dictionary_.set(objects_.errorRegister, errorRegister);
    dictionary_.set(objects_.panelCode, panel);
    if (!traits_.emergencies) return;
    Emergency emergency;
    emergency.code = code;
    emergency.errorRegister = errorRegister;
    emergency.data[0] = static_cast<std::uint8_t>(panel);
    emergency.data[1] = static_cast<std::uint8_t>(panel >> 8);
    emergency_ = emergency;
}

void Drive::beginFaultStop(std::int64_t reaction) noexcept {
    state_ = State::FaultReactionActive;
    stop_ = Stop::Fault;
    homing_.clear();
    // The demand may be far ahead of a motor that could not follow.
    hold(motor_.position());
    demand_.velocity = motor_.velocity();
    if (reaction == FaultReactionByProfile) rampDown(rate(objects_.profileDeceleration));
    if (reaction == FaultReactionByRamp) rampDown(rate(objects_.quickStopDeceleration));
    if (reaction > FaultReactionByRamp) demand_.velocity = 0.0;  // with all the torque there is
}

bool Drive::raiseAlarm(std::uint16_t number) noexcept {
    const DriveAlarm* alarm = findAlarm(traits_.name, number);
    if (alarm == nullptr) return false;
    const bool failed = state_ == State::Fault || state_ == State::FaultReactionActive;
    if (alarm->kind == AlarmKind::Warning) {
        warning_ = number;
        if (!failed) dictionary_.set(objects_.errorCode, alarm->errorCode);
        if (!failed) dictionary_.set(objects_.panelCode, number);
        return true;
    }
    if (failed) return true;  // the first one stays
    fail(alarm->errorCode, number,
         alarm->kind == AlarmKind::Bus ? traits_.errorRegisterBus : traits_.errorRegisterMotion);
    resettable_ = alarm->resettable;
    return true;
}

void Drive::clearWarning() noexcept {
    const bool failed = state_ == State::Fault || state_ == State::FaultReactionActive;
    if (warning_ == 0) return;
    warning_ = 0;
    if (failed) return;
    dictionary_.set(objects_.errorCode, 0);
    dictionary_.set(objects_.panelCode, 0);
}

void Drive::resetFault() noexcept {
    state_ = State::SwitchOnDisabled;
    followingFault_ = false;
    followingTime_ = core::Duration{0};
    dictionary_.set(objects_.errorCode, 0);
    dictionary_.set(objects_.errorRegister, 0);
    dictionary_.set(objects_.panelCode, 0);
}

void Drive::restart() noexcept {
    powerOff(State::NotReadyToSwitchOn);
    resetFault();
    warning_ = 0;
    load_ = 0.0;
    state_ = State::NotReadyToSwitchOn;
    sinceStart_ = core::Duration{0};
    dictionary_.set(objects_.mode, traits_.powerUpMode);
    homing_.clear();
    homed_ = false;
    zero_ = 0;  // the absolute encoder knows where it is, not where home was
    hold(motor_.position());
}

void Drive::communicationLost() noexcept {
    fail(traits_.communicationCode, traits_.communicationPanel, traits_.errorRegisterBus);
}

std::optional<Emergency> Drive::takeEmergency() noexcept {
    const std::optional<Emergency> taken = emergency_;
    emergency_.reset();
    return taken;
}

}  // namespace takt::twin
