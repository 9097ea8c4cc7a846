// The modes in which the drive makes its own profile: Profile position, Profile velocity, homing.

#include <algorithm>

#include "drive.hpp"

namespace takt::twin {

namespace cia = core::cia402;

namespace {

constexpr double SecondsPerMinute = 60.0;
constexpr double TenthsPerAmpere = 10.0;

// Controlword in Profile position.
constexpr std::uint16_t NewSetPoint = 0x0010;
constexpr std::uint16_t ChangeImmediately = 0x0020;
constexpr std::uint16_t Relative = 0x0040;
constexpr std::uint16_t ChangeOnSetPoint = 0x0200;

}  // namespace

void Drive::takeSetPoint(std::uint16_t controlWord) noexcept {
    const auto received =
        static_cast<std::uint32_t>(dictionary_.getUnsigned(objects_.targetPosition));
    SetPoint next;
    if ((controlWord & Relative) != 0) {
        next.target =
            (traits_.relativeToActual ? userPosition(motor_.position()) : setPoints_.lastTarget()) +
            static_cast<std::int32_t>(received);
    } else {
        const std::int64_t present = userPosition(demand_.position);
        next.target =
            present + static_cast<std::int32_t>(received - static_cast<std::uint32_t>(present));
    }
    const SoftLimits limits = softLimits();
    softLimited_ = limits.active && (next.target < limits.minimum || next.target > limits.maximum);
    if (softLimited_) next.target = std::clamp(next.target, limits.minimum, limits.maximum);
    const double profile =
        velocityTurns(static_cast<std::int64_t>(dictionary_.getUnsigned(objects_.profileVelocity)));
    next.limits = {std::min(profile, speedLimit(true)), rate(objects_.profileAcceleration),
                   rate(objects_.profileDeceleration)};
    next.goOn = traits_.changeOnSetPoint && (controlWord & ChangeOnSetPoint) != 0;
    if (setPoints_.take(next, (controlWord & ChangeImmediately) != 0) && !halted_) startSetPoint();
}

void Drive::startSetPoint() noexcept {
    if (source_ != Source::Generator) generator_.begin(demand_);
    source_ = Source::Generator;
    const SetPoint& active = *setPoints_.active();
    const bool through = setPoints_.waiting() && setPoints_.waiting()->goOn;
    generator_.moveTo(turnsOf(active.target), active.limits, through ? active.limits.speed : 0.0);
    reached_ = false;
    reachedTime_ = core::Duration{0};
}

void Drive::stepProfilePosition(std::uint16_t controlWord) noexcept {
    if (setPoints_.request((controlWord & NewSetPoint) != 0)) takeSetPoint(controlWord);
    const bool halt = (controlWord & cia::Halt) != 0;
    if (halt && !halted_) rampDown(haltDeceleration());
    const bool resumed = halted_ && !halt;
    halted_ = halt;
    if (!setPoints_.active()) return;
    if (resumed) startSetPoint();
    if (halt) return;
    blocked_ = limitAhead(turnsOf(setPoints_.active()->target) - demand_.position);
    if (blocked_) {
        rampDown(rate(objects_.quickStopDeceleration));
        setPoints_.clear(userPosition(demand_.position), (controlWord & NewSetPoint) != 0);
        return;
    }
    if (!generator_.finished() && !generator_.passed()) return;
    if (setPoints_.finish()) startSetPoint();
}

void Drive::stepProfileVelocity(std::uint16_t controlWord) noexcept {
    halted_ = (controlWord & cia::Halt) != 0;
    const double limit = speedLimit(true);
    const double slower = halted_ ? haltDeceleration() : rate(objects_.profileDeceleration);
    const double wanted =
        halted_ ? 0.0 : velocityTurns(dictionary_.getSigned(objects_.targetVelocity));
    if (source_ != Source::Generator) generator_.begin(demand_);
    source_ = Source::Generator;
    const double velocity = speedWithinLimits(std::clamp(wanted, -limit, limit), slower);
    const double stop = blocked_ ? rate(objects_.quickStopDeceleration) : slower;
    generator_.run(velocity, rate(objects_.profileAcceleration), stop);
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
    settings.acceleration = rate(objects_.homingAcceleration);
    settings.movesToOffset = traits_.homing.movesToOffset && number(objects_.homingOffsetMode) == 0;
    settings.offset =
        static_cast<double>(dictionary_.getSigned(objects_.homeOffset)) / scale_.countsPerTurn();
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

}  // namespace takt::twin
