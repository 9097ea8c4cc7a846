// What the drive shows: statusword and actual values.

#include "drive.hpp"

namespace takt::twin {

namespace cia = core::cia402;
using core::cia402::Mode;

namespace {

constexpr std::uint16_t QuickStopInactive = 0x0020;
constexpr std::uint16_t DcLocked = 0x0100;             // bit 8
constexpr std::uint16_t ZeroSpeed = 0x4000;            // bit 14
constexpr std::uint16_t Homed = 0x8000;                // bit 15
constexpr std::uint16_t SetPointAcknowledge = 0x1000;  // Profile position
constexpr std::uint16_t SpeedZero = 0x1000;            // Profile velocity

std::uint16_t stateBits(cia::DriveState state) noexcept {
    using State = cia::DriveState;
    switch (state) {
        case State::NotReadyToSwitchOn:
            return 0x0000;
        case State::SwitchOnDisabled:
            return 0x0040 | QuickStopInactive;
        case State::ReadyToSwitchOn:
            return 0x0021;
        case State::SwitchedOn:
            return 0x0023;
        case State::OperationEnabled:
            return 0x0027;
        case State::QuickStopActive:
            return 0x0007;
        case State::FaultReactionActive:
            return 0x000F | QuickStopInactive;
        case State::Fault:
            return 0x0008 | QuickStopInactive;
    }
    return 0;
}

}  // namespace

std::uint16_t Drive::homingBits() const noexcept {
    using Run = Homing::State;
    const std::uint16_t standing = motorStands() ? cia::TargetReached : std::uint16_t{0};
    switch (homing_.state()) {
        case Run::Idle:
            return cia::TargetReached;  // not started
        case Run::Searching:
        case Run::Settling:
            return 0;
        case Run::ToOffset:
            return cia::HomingAttained;
        case Run::Done:
            // Attained only when the new coordinates are in effect.
            return homed_ ? static_cast<std::uint16_t>(cia::HomingAttained | standing)
                          : std::uint16_t{0};
        case Run::Interrupted:
            return standing;
        case Run::Failed:
            return static_cast<std::uint16_t>(cia::HomingError | standing);
    }
    return 0;
}

std::uint16_t Drive::positionBits() const noexcept {
    std::uint16_t bits = followingFault_ ? cia::FollowingErrorBit : std::uint16_t{0};
    if (blocked_ || softLimited_) bits |= cia::InternalLimit;
    if (reached_) bits |= cia::TargetReached;
    return bits;
}

std::uint16_t Drive::profileBits() const noexcept {
    std::uint16_t bits = positionBits();
    // While halted bit 10 means standstill instead.
    if (halted_) bits &= static_cast<std::uint16_t>(~cia::TargetReached);
    if (halted_ && motorStands()) bits |= cia::TargetReached;
    if (setPoints_.acknowledged()) bits |= SetPointAcknowledge;
    return bits;
}

std::uint16_t Drive::velocityBits() const noexcept {
    std::uint16_t bits = blocked_ || softLimited_ ? cia::InternalLimit : std::uint16_t{0};
    if (halted_ ? motorStands() : reached_) bits |= cia::TargetReached;
    if (motorStands()) bits |= SpeedZero;
    return bits;
}

std::uint16_t Drive::modeBits() const noexcept {
    const bool follows =
        state_ == State::OperationEnabled && stop_ == Stop::None && !blocked_ && !halted_;
    const std::uint16_t following = follows ? cia::DriveFollowsCommand : std::uint16_t{0};
    switch (static_cast<Mode>(activeMode_)) {
        case Mode::ProfilePosition:
            return profileBits();
        case Mode::ProfileVelocity:
            return velocityBits();
        case Mode::Homing:
            return homingBits();
        case Mode::CyclicSynchronousPosition:
            return positionBits() | following;
        case Mode::CyclicSynchronousVelocity:
            return following | (blocked_ || softLimited_ ? cia::InternalLimit : std::uint16_t{0});
        case Mode::CyclicSynchronousTorque:
            return following;
        case Mode::ProfileTorque:
        case Mode::None:
            return 0;
    }
    return 0;
}

std::uint16_t Drive::statusWord(bool outputsValid, bool dcLocked) const noexcept {
    auto word = static_cast<std::uint16_t>(stateBits(state_) | modeBits());
    if (state_ != State::NotReadyToSwitchOn) word |= cia::VoltageEnabled;
    if (outputsValid) word |= cia::Remote;
    if (warning_ != 0) word |= cia::Warning;
    if (traits_.dcLockedInBit8 && dcLocked) word |= DcLocked;
    if (traits_.zeroSpeedInBit14 && motorStands()) word |= ZeroSpeed;
    if (traits_.homedInBit15 && homed_) word |= Homed;
    return word;
}

void Drive::report(bool outputsValid, bool dcLocked) noexcept {
    const auto perTurn = traits_.unit == MotionUnit::TenthRpm ? 600.0 : scale_.countsPerTurn();
    dictionary_.set(objects_.statusWord, statusWord(outputsValid, dcLocked));
    dictionary_.set(objects_.modeDisplay, activeMode_);
    dictionary_.set(objects_.positionActual, userPosition(motor_.position()));
    dictionary_.set(objects_.positionDemand, userPosition(demand_.position));
    dictionary_.set(objects_.velocityActual,
                    static_cast<std::int64_t>(motor_.velocity() * perTurn));
    dictionary_.set(objects_.velocityDemand,
                    powered_ ? static_cast<std::int64_t>(demand_.velocity * perTurn) : 0);
    const double demanded = source_ == Source::Torque ? torqueDemand_ : torque_;
    dictionary_.set(
        objects_.torqueDemand,
        powered_ ? static_cast<std::int64_t>(demanded / traits_.ratedTorque * 1000.0) : 0);
    dictionary_.set(objects_.torqueActual,
                    static_cast<std::int64_t>(torque_ / traits_.ratedTorque * 1000.0));
    dictionary_.set(objects_.followingError, followingError_);
    dictionary_.set(objects_.digitalInputs, digitalInputs());
    reportProbes();
}

}  // namespace takt::twin
