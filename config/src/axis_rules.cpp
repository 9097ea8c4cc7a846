#include "axis_rules.hpp"

#include <fmt/format.h>

#include <cmath>

namespace takt::config {

namespace {

constexpr double LargestCount = 2147483647.0;        // a position in the drive: 32 bits with sign
constexpr double MostCountsPerCycle = 1073741824.0;  // 2^30: a step must not be mistaken for a wrap
constexpr double LargestProduct = 4.0e18;            // the ratio is kept in 64-bit numbers

ElementReader childOf(const AxisPart& axis, std::string_view name) {
    const ElementReader& reader = axis.reader;
    return {reader.element().child(name), fmt::format("{}, <{}>", reader.label(), name),
            reader.place().file, reader.diagnostics()};
}

double countsPerUnit(const AxisPart& axis) noexcept {
    return std::abs(turnsPerUnit(axis.params.scaling)) *
           static_cast<double>(axis.params.scaling.countsPerTurn);
}

void checkRatio(const AxisPart& axis) {
    const axis::ScalingParams& scaling = axis.params.scaling;
    const double counts = static_cast<double>(scaling.countsPerTurn) *
                          static_cast<double>(scaling.gearMotor) *
                          static_cast<double>(scaling.unitsPerTurnDenominator);
    const double units =
        static_cast<double>(scaling.gearLoad) * static_cast<double>(scaling.unitsPerTurnNumerator);
    if (counts <= LargestProduct && units <= LargestProduct) return;
    childOf(axis, "Scaling")
        .error("perTurn", "countsPerTurn, gear and perTurn together need more than 64 bits", {},
               "write gear and perTurn with fewer digits");
}

void checkSoftLimits(const AxisPart& axis) {
    const ElementReader reader = childOf(axis, "Limits");
    const axis::LimitParams& limits = axis.params.limits;
    const std::string& unit = axis.params.unit;
    const double most = LargestCount / countsPerUnit(axis);
    const auto check = [&](const char* name, const std::optional<core::Position>& limit) {
        if (!limit) return;
        if (axis.params.scaling.modulo) {
            reader.error(name, "a modulo axis turns endlessly and has no soft limits",
                         "either modulo or soft limits");
        } else if (std::abs(limit->count()) > most) {
            reader.error(
                name,
                fmt::format("{}=\"{}\" is {:.4g} counts, the drive has 32 bits", name,
                            reader.element().attribute(name)->value,
                            limit->count() * countsPerUnit(axis)),
                fmt::format("-{0:.10g} {1} to {0:.10g} {1} with this scaling", most, unit));
        }
    };
    check("softNegative", limits.softNegative);
    check("softPositive", limits.softPositive);
    if (axis.params.scaling.modulo) return;
    if (limits.softNegative && limits.softPositive &&
        *limits.softNegative >= *limits.softPositive) {
        reader.error(
            "softNegative",
            fmt::format("the soft limits are swapped: {:g} {} is not below {:g} {}",
                        limits.softNegative->count(), unit, limits.softPositive->count(), unit),
            "softNegative below softPositive");
    }
    if (!limits.softNegative || !limits.softPositive) {
        reader.diagnostics().warning(
            reader.place(),
            fmt::format("{}: a linear axis without {} runs until the drive's counter is full or a "
                        "stop is hit",
                        axis.reader.label(), limits.softNegative ? "softPositive" : "softNegative"),
            fmt::format("-{0:.10g} {1} to {0:.10g} {1} with this scaling", most, unit),
            "add both soft limits");
    }
}

/// Way from a steady velocity to rest with a jerk-limited ramp.
double stoppingDistance(double velocity, double deceleration, double jerk) {
    const bool full = velocity >= deceleration * deceleration / jerk;
    const double time =
        full ? velocity / deceleration + deceleration / jerk : 2.0 * std::sqrt(velocity / jerk);
    return velocity * time / 2.0;
}

/// A move may end at a soft limit. A stop on the way there that needs more room than the end of the
/// move goes beyond it.
void checkStopRamp(const AxisPart& axis) {
    const ElementReader reader = childOf(axis, "Limits");
    const axis::LimitParams& limits = axis.params.limits;
    if (!limits.softNegative && !limits.softPositive) return;
    constexpr int Speeds = 20;
    constexpr double Rounding = 1e-9;
    double worst = 0.0;
    double room = 0.0;
    for (int i = 1; i <= Speeds; ++i) {
        const double velocity = limits.velocity.count() * i / Speeds;
        const double end =
            stoppingDistance(velocity, limits.deceleration.count(), limits.jerk.count());
        const double stop =
            stoppingDistance(velocity, limits.stopDeceleration.count(), limits.stopJerk.count());
        worst = std::max(worst, stop - end);
        room = end;
    }
    if (worst <= room * Rounding) return;
    reader.diagnostics().warning(
        reader.place(),
        fmt::format(
            "{}: the stop ramp is weaker than the deceleration of a move: a stop close to a "
            "soft limit overruns it by up to {:.4g} {}",
            axis.reader.label(), worst, axis.params.unit),
        fmt::format("stopDeceleration from {:.6g} {}/s^2 and stopJerk from {:.6g} {}/s^3",
                    limits.deceleration.count(), axis.params.unit, limits.jerk.count(),
                    axis.params.unit),
        "make the stop ramp stronger, or keep so much room between soft limit and hard stop");
}

void checkModulo(const AxisPart& axis) {
    const auto& modulo = axis.params.scaling.modulo;
    if (!modulo) return;
    const double counts = modulo->count() * countsPerUnit(axis);
    if (counts <= LargestCount && counts >= 1.0) return;
    childOf(axis, "Scaling")
        .error("modulo", fmt::format("one period is {:.4g} counts", counts),
               fmt::format("1 to {:.0f} counts", LargestCount));
}

void checkVelocity(const AxisPart& axis, core::Duration cycle) {
    const ElementReader reader = childOf(axis, "Limits");
    const double velocity = axis.params.limits.velocity.count();
    const double turns = std::abs(turnsPerUnit(axis.params.scaling));
    const double maxTurns = axis.params.drive.maxMotorSpeed.count();
    const std::string& unit = axis.params.unit;
    constexpr double Rounding = 1.0 + 1e-12;
    if (maxTurns > 0.0 && velocity * turns > maxTurns * Rounding) {
        reader.error(
            "velocity",
            fmt::format("the motor would have to turn at {:.6g} rpm", velocity * turns * 60.0),
            fmt::format("at most {:.6g} {}/s, which is maxSpeed of the drive, {:.6g} rpm",
                        maxTurns / turns, unit, maxTurns * 60.0));
    }
    const double seconds = static_cast<double>(cycle.count()) * 1e-9;
    const double counts = velocity * countsPerUnit(axis) * seconds;
    if (counts >= MostCountsPerCycle) {
        reader.error("velocity", fmt::format("the encoder would count {:.4g} in one cycle", counts),
                     fmt::format("below {:.6g} {}/s: 2^30 counts in a cycle",
                                 MostCountsPerCycle / (countsPerUnit(axis) * seconds), unit));
    }
}

void checkHoming(const AxisPart& axis, const SlavePart& slave) {
    const ElementReader reader = childOf(axis, "Homing");
    const axis::HomingParams& homing = axis.params.homing;
    const axis::LimitParams& limits = axis.params.limits;
    if (!takesHomingMethod(*slave.profile, homing.method)) {
        reader.error("method",
                     fmt::format("the homing method {} is not known to the {}", homing.method,
                                 slave.params.device->type),
                     std::string{slave.profile->homingText});
    }
    const auto checkSpeed = [&](const char* name, core::Velocity speed) {
        if (speed <= limits.velocity) return;
        reader.error(
            name, fmt::format("{} is above the velocity of the axis", name),
            fmt::format("at most {:.10g} {}/s", limits.velocity.count(), axis.params.unit));
    };
    checkSpeed("switchSpeed", homing.switchSpeed);
    checkSpeed("zeroSpeed", homing.zeroSpeed);
}

}  // namespace

SlavePart* tieToSlave(const AxisPart& axis, const ElementReader& drive, NetworkPart& network) {
    const std::string& name = axis.params.drive.slave;
    if (name.empty()) return nullptr;
    SlavePart* const slave = network.find(name);
    if (slave == nullptr && !network.slavesKnown) return nullptr;
    if (slave == nullptr) {
        std::string known;
        for (const SlavePart& other : network.slaves) {
            known += fmt::format("{}{}", known.empty() ? "" : ", ", other.params.name);
        }
        drive.error("slave", fmt::format("there is no slave '{}'", name), known);
        return nullptr;
    }
    if (slave->hasAxis) {
        drive.error("slave", fmt::format("the slave '{}' already drives another axis", name),
                    "one axis for each slave");
        return nullptr;
    }
    slave->hasAxis = true;
    if (!slave->params.device) return nullptr;
    checkCyclicPositionEntries(*slave, axis.params.drive.bound);
    if (!slave->params.dc.enabled) {
        slave->reader.diagnostics().warning(
            slave->reader.place(),
            fmt::format("{}: the drive of an axis runs without distributed clocks",
                        slave->reader.label()),
            "a DC mode with SYNC0", "add <Dc mode=\"…\"/> if the device has one");
    }
    return slave;
}

void checkLostCommunication(const AxisPart& axis, const SlavePart& slave,
                            const ElementReader& drive, bool confirmed) {
    if (confirmed) return;
    const std::string what =
        fmt::format("how the {} stops when communication is lost {}", slave.params.device->type,
                    slave.profile->lostCommunication);
    if (axis.params.vertical) {
        drive.error(
            {}, fmt::format("{}, and the axis is vertical", what),
            "lostCommunication=\"confirmed\" once it is certain that a brake holds the load",
            "test it at the machine and write it down here");
    } else {
        drive.diagnostics().note(
            drive.place(), fmt::format("{}: {}", axis.reader.label(), what), {},
            "test it at the machine, then write lostCommunication=\"confirmed\"");
    }
}

void checkAxis(const AxisPart& axis, const NetworkPart& network) {
    checkRatio(axis);
    checkSoftLimits(axis);
    checkStopRamp(axis);
    checkModulo(axis);
    checkVelocity(axis, network.params.cycle);
    for (const SlavePart& slave : network.slaves) {
        const bool own = slave.params.name == axis.params.drive.slave;
        if (own && slave.params.device) checkHoming(axis, slave);
    }
}

}  // namespace takt::config
