#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "axis_rules.hpp"
#include "machine_parts.hpp"

namespace takt::config {

namespace {

void readDrive(AxisPart& axis, NetworkPart& network) {
    ElementReader reader = axis.reader.childReader("Drive", Presence::Required);
    axis::DriveParams& drive = axis.params.drive;
    drive.slave = reader.text("slave", Presence::Required).value_or("");
    const auto speed = reader.quantity("maxSpeed", Dimension::MotorSpeed, Sign::Positive);
    if (speed) drive.maxMotorSpeed = core::Quantity<0, -1>{speed->value};
    axis.params.supervision.driveDelayCycles = static_cast<std::uint32_t>(
        reader.integer("delayCycles", {0, 30}).value_or(axis.params.supervision.driveDelayCycles));
    const bool confirmed =
        reader.choice<bool>("lostCommunication", {{"confirmed", true}}).value_or(false);
    drive.bound = readBind(reader.childReader("Bind"), network, network.find(drive.slave));
    reader.finish();
    SlavePart* const slave = tieToSlave(axis, reader, network);
    if (slave == nullptr) return;
    checkLostCommunication(axis, *slave, reader, confirmed);
    drive.profile = slave->profile->name;
    drive.velocityUnit = slave->profile->velocityUnit;
    axis.params.scaling.countsPerTurn = slave->profile->countsPerTurn;
}

void readScaling(AxisPart& axis, const UnitDimensions& units) {
    ElementReader reader = axis.reader.childReader("Scaling", Presence::Required);
    axis::ScalingParams& scaling = axis.params.scaling;
    constexpr std::int64_t MostCounts = 2147483647;
    const auto counts = reader.integer(
        "countsPerTurn", {1, MostCounts},
        scaling.countsPerTurn == 0 && !axis.params.drive.profile.empty() ? Presence::Required
                                                                         : Presence::Optional);
    scaling.countsPerTurn = counts.value_or(std::max<std::int64_t>(scaling.countsPerTurn, 1));
    const auto perTurn =
        reader.quantity("perTurn", units.position, Sign::Positive, Presence::Required);
    if (perTurn && !perTurn->exact) {
        reader.error("perTurn", "the number has too many digits to be kept exactly",
                     "at most 18 digits");
    }
    const auto gear = reader.text("gear");
    const auto ratio = parseRatio(gear.value_or("1/1"));
    if (!ratio) {
        reader.error("gear",
                     fmt::format("gear=\"{}\": this is not a ratio of two positive numbers", *gear),
                     "motor turns / load turns, for example \"10/1\"");
    }
    scaling.reversed = reader.flag("reversed").value_or(false);
    const auto modulo = reader.quantity("modulo", units.position, Sign::Positive);
    if (modulo) scaling.modulo = core::Distance{modulo->value};
    reader.finish();
    if (!reader.present() || !ratio || !perTurn || !perTurn->exact) return;
    scaling.gearMotor = ratio->numerator;
    scaling.gearLoad = ratio->denominator;
    scaling.unitsPerTurnNumerator = perTurn->exact->numerator;
    scaling.unitsPerTurnDenominator = perTurn->exact->denominator;
    axis.complete = true;
}

void readLimits(AxisPart& axis, const UnitDimensions& units) {
    ElementReader reader = axis.reader.childReader("Limits", Presence::Required);
    axis::LimitParams& limits = axis.params.limits;
    const auto required = [&](std::string_view name, Dimension dimension) {
        const auto value = reader.quantity(name, dimension, Sign::Positive, Presence::Required);
        axis.complete = axis.complete && value;
        return value ? value->value : 0.0;
    };
    const auto optional = [&](std::string_view name, Dimension dimension, double fallback) {
        const auto value = reader.quantity(name, dimension, Sign::Positive);
        return value ? value->value : fallback;
    };
    constexpr double RampsPerSecond = 10.0;  // without a jerk: acceleration builds up in 100 ms
    const double acceleration = required("acceleration", units.acceleration);
    const double deceleration = optional("deceleration", units.acceleration, acceleration);
    const double jerk =
        optional("jerk", units.jerk, RampsPerSecond * std::max(acceleration, deceleration));
    limits.velocity = core::Velocity{required("velocity", units.velocity)};
    limits.acceleration = core::Acceleration{acceleration};
    limits.deceleration = core::Acceleration{deceleration};
    limits.jerk = core::Jerk{jerk};
    limits.stopDeceleration = core::Acceleration{
        optional("stopDeceleration", units.acceleration, std::max(acceleration, deceleration))};
    limits.stopJerk = core::Jerk{optional("stopJerk", units.jerk, jerk)};
    const auto negative = reader.quantity("softNegative", units.position);
    const auto positive = reader.quantity("softPositive", units.position);
    if (negative) limits.softNegative = core::Position{negative->value};
    if (positive) limits.softPositive = core::Position{positive->value};
    reader.finish();
    axis.complete = axis.complete && reader.present();
}

void readSupervision(AxisPart& axis, const UnitDimensions& units) {
    ElementReader reader = axis.reader.childReader("Supervision");
    axis::SupervisionParams& supervision = axis.params.supervision;
    // Without a window of the user: what the axis travels at full speed in 20 ms.
    constexpr double DefaultWindowSeconds = 0.02;
    const auto window = reader.quantity("followingError", units.position, Sign::NotNegative);
    supervision.followingError = core::Distance{
        window ? window->value : DefaultWindowSeconds * axis.params.limits.velocity.count()};
    supervision.followingErrorTime =
        reader.time("followingErrorTime").value_or(supervision.followingErrorTime);
    const auto inPosition = reader.quantity("inPosition", units.position, Sign::NotNegative);
    if (inPosition) supervision.inPositionWindow = core::Distance{inPosition->value};
    supervision.inPositionTime = reader.time("inPositionTime").value_or(supervision.inPositionTime);
    supervision.enableTimeout =
        reader.time("enableTimeout", Sign::Positive).value_or(supervision.enableTimeout);
    supervision.resetTimeout =
        reader.time("resetTimeout", Sign::Positive).value_or(supervision.resetTimeout);
    reader.finish();
}

void readHoming(AxisPart& axis, const UnitDimensions& units) {
    ElementReader reader = axis.reader.childReader("Homing");
    axis::HomingParams& homing = axis.params.homing;
    const axis::LimitParams& limits = axis.params.limits;
    const auto method = reader.integer("method", {-128, 127}, Presence::Required);
    homing.method = static_cast<std::int8_t>(method.value_or(homing.method));
    constexpr double SwitchShare = 0.1;  // of the axis' velocity, where nothing is said
    constexpr double ZeroShare = 0.01;
    const auto fast = reader.quantity("switchSpeed", units.velocity, Sign::Positive);
    const auto slow = reader.quantity("zeroSpeed", units.velocity, Sign::Positive);
    const auto ramp = reader.quantity("acceleration", units.acceleration, Sign::Positive);
    homing.switchSpeed = fast ? core::Velocity{fast->value} : limits.velocity * SwitchShare;
    homing.zeroSpeed = slow ? core::Velocity{slow->value} : limits.velocity * ZeroShare;
    homing.acceleration = ramp ? core::Acceleration{ramp->value} : limits.acceleration;
    homing.timeout = reader.time("timeout", Sign::Positive).value_or(homing.timeout);
    reader.finish();
}

void readPowerOff(AxisPart& axis) {
    ElementReader reader = axis.reader.childReader("PowerOff");
    using Mode = axis::PowerOffMode;
    axis.params.powerOff =
        reader
            .choice<Mode>("mode", {{"ramp", Mode::Ramp}, {"immediate", Mode::Immediate}},
                          Presence::Required)
            .value_or(Mode::Ramp);
    reader.finish();
}

}  // namespace

UnitDimensions dimensionsOf(std::string_view unit) noexcept {
    if (unit != "deg") return {};
    return {Dimension::Angle, Dimension::AngularVelocity, Dimension::AngularAcceleration,
            Dimension::AngularJerk};
}

double turnsPerUnit(const axis::ScalingParams& scaling) noexcept {
    const double turns = static_cast<double>(scaling.gearMotor) *
                         static_cast<double>(scaling.unitsPerTurnDenominator) /
                         (static_cast<double>(scaling.gearLoad) *
                          static_cast<double>(scaling.unitsPerTurnNumerator));
    return scaling.reversed ? -turns : turns;
}

AxisPart readAxis(ElementReader reader, NetworkPart& network) {
    AxisPart axis{std::move(reader)};
    const auto name = axis.reader.name("name");
    axis.params.name = name.value_or("");
    axis.params.origin = format(axis.reader.place());
    if (name) axis.reader.relabel(fmt::format("axis '{}'", *name));
    const auto unit =
        axis.reader.choice<std::string>("unit", {{"mm", "mm"}, {"deg", "deg"}}, Presence::Required);
    axis.params.unit = unit.value_or("mm");
    axis.params.vertical = axis.reader.flag("vertical").value_or(false);
    constexpr std::int64_t DeepestQueue = 64;
    axis.params.queueDepth = static_cast<std::uint32_t>(
        axis.reader.integer("queue", {1, DeepestQueue}).value_or(axis.params.queueDepth));
    readDrive(axis, network);
    if (!unit) {
        // Every quantity below depends on the unit: one message is enough.
        for (const char* known : {"Scaling", "Limits", "Supervision", "Homing"})
            axis.reader.children(known);
    } else {
        const UnitDimensions units = dimensionsOf(*unit);
        readScaling(axis, units);
        readLimits(axis, units);
        readSupervision(axis, units);
        readHoming(axis, units);
    }
    readPowerOff(axis);
    axis.reader.finish();
    if (axis.complete) checkAxis(axis, network);
    return axis;
}

}  // namespace takt::config
