// What the drive's objects mean in turns of the motor shaft.

#include <algorithm>
#include <numeric>

#include "drive.hpp"

namespace takt::twin {

namespace {

constexpr double TenthRpmPerTurn = 600.0;  // 0.1 rpm in one turn per second
constexpr double SecondsPerMinute = 60.0;
constexpr double Standstill = 0.01;   // turns/s
constexpr double HardestStop = 1e4;   // turns/s², where a ramp is 0
constexpr double FastestMotor = 1e4;  // turns/s, where no limit is set

constexpr std::int64_t SmallestGearDivisor = 1000;  // increments per count: 1/1000 …
constexpr std::int64_t LargestGear = 8000;          // … to 8000

// Whole numbers that a gear may consist of, so that 64 bits are enough for every conversion.
constexpr std::int64_t MostCounts = std::int64_t{1} << 31;
constexpr std::int64_t MostTurns = 256;

constexpr std::int64_t HaltByQuickStopRamp = 2;  // 605Dh

}  // namespace

double Drive::velocityTurns(std::int64_t value) const noexcept {
    const double perTurn =
        traits_.unit == MotionUnit::TenthRpm ? TenthRpmPerTurn : scale_.countsPerTurn();
    return static_cast<double>(value) / perTurn;
}

void Drive::takeGear() noexcept {
    const auto number = [&](ObjectRef object) {
        return static_cast<std::int64_t>(dictionary_.getUnsigned(object));
    };
    // Increments per count = encoder · motor / shaft / (feed / shaft revolutions).
    const std::int64_t common = std::gcd(number(objects_.gearShaft) * number(objects_.feed),
                                         number(objects_.gearMotor) * number(objects_.feedShaft));
    const std::int64_t divisor = common > 0 ? common : 1;
    const std::int64_t counts = number(objects_.gearShaft) * number(objects_.feed) / divisor;
    const std::int64_t turns = number(objects_.gearMotor) * number(objects_.feedShaft) / divisor;
    gearValid_ = counts > 0 && turns > 0 && counts <= MostCounts && turns <= MostTurns;
    if (gearValid_) {
        const std::int64_t increments = PositionScale::IncrementsPerTurn * turns;
        gearValid_ =
            increments <= LargestGear * counts && increments * SmallestGearDivisor >= counts;
    }
    if (!gearValid_) return;
    scale_ = PositionScale{counts, traits_.truncatesPositions, turns};
}

double Drive::rate(ObjectRef object) const noexcept {
    const double value = velocityTurns(static_cast<std::int64_t>(dictionary_.getUnsigned(object)));
    return value > 0.0 ? value : HardestStop;
}

double Drive::speedLimit(bool profile) const noexcept {
    double limit = FastestMotor;
    const std::uint64_t rpm = dictionary_.getUnsigned(objects_.maxMotorSpeed);
    if (rpm != 0) limit = std::min(limit, static_cast<double>(rpm) / SecondsPerMinute);
    const std::uint64_t speed = profile ? dictionary_.getUnsigned(objects_.maxProfileVelocity) : 0;
    if (speed != 0) limit = std::min(limit, velocityTurns(static_cast<std::int64_t>(speed)));
    return limit;
}

double Drive::haltDeceleration() const noexcept {
    const std::int64_t code = dictionary_.getSigned(objects_.haltOption);
    if (code > HaltByQuickStopRamp) return HardestStop;
    return rate(code == HaltByQuickStopRamp ? objects_.quickStopDeceleration
                                            : objects_.profileDeceleration);
}

double Drive::turnsOf(std::int64_t counts) const noexcept {
    return PositionScale::turns(scale_.fromCounts(counts) + zero_);
}

std::int64_t Drive::userPosition(double turns) const noexcept {
    return scale_.counts(PositionScale::increments(turns) - zero_);
}

bool Drive::limitAhead(double velocity) const noexcept {
    return (velocity > 0.0 && positiveLimit()) || (velocity < 0.0 && negativeLimit());
}

bool Drive::motorStands() const noexcept {
    return motor_.velocity() < Standstill && motor_.velocity() > -Standstill;
}

}  // namespace takt::twin
