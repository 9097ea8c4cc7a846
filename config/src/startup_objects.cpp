#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <takt/core/cia402.hpp>

#include "machine_parts.hpp"

namespace takt::config {

namespace {

using fieldbus::StartupObject;
namespace cia402 = core::cia402;

struct ValueType {
    std::string_view name;
    std::uint16_t bits;
    std::int64_t least;
    std::int64_t most;
};

constexpr std::array Types{
    ValueType{"bool", 1, 0, 1},
    ValueType{"int8", 8, -128, 127},
    ValueType{"int16", 16, -32768, 32767},
    ValueType{"int32", 32, -2147483648LL, 2147483647LL},
    ValueType{"int64", 64, std::numeric_limits<std::int64_t>::min(),
              std::numeric_limits<std::int64_t>::max()},
    ValueType{"uint8", 8, 0, 0xFF},
    ValueType{"uint16", 16, 0, 0xFFFF},
    ValueType{"uint32", 32, 0, 0xFFFFFFFF},
    ValueType{"uint64", 64, 0, std::numeric_limits<std::int64_t>::max()},
};

const ValueType* typeOf(wire::DataType type) noexcept {
    using wire::DataType;
    switch (type) {
        case DataType::Boolean:
            return &Types[0];
        case DataType::Integer8:
            return &Types[1];
        case DataType::Integer16:
            return &Types[2];
        case DataType::Integer32:
            return &Types[3];
        case DataType::Integer64:
            return &Types[4];
        case DataType::Unsigned8:
            return &Types[5];
        case DataType::Unsigned16:
            return &Types[6];
        case DataType::Unsigned32:
            return &Types[7];
        case DataType::Unsigned64:
            return &Types[8];
        case DataType::Real32:
        case DataType::Real64:
        case DataType::VisibleString:
        case DataType::OctetString:
            return nullptr;
    }
    return nullptr;
}

std::vector<std::uint8_t> littleEndian(std::int64_t value, std::uint16_t bits) {
    std::vector<std::uint8_t> bytes((bits + 7U) / 8U);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8U * i));
    }
    return bytes;
}

const wire::ObjectEntryDescription* findEntry(const wire::DeviceDescription& device,
                                              std::uint16_t index, std::uint8_t subindex) noexcept {
    const wire::ObjectDescription* const object = device.findObject(index);
    if (object == nullptr) return nullptr;
    for (const wire::ObjectEntryDescription& entry : object->entries) {
        if (entry.subindex == subindex) return &entry;
    }
    return nullptr;
}

/// Objects that the master itself writes at every start.
bool belongsToMaster(std::uint16_t index) noexcept {
    return (index >= 0x1600 && index <= 0x17FF) || (index >= 0x1A00 && index <= 0x1BFF) ||
           (index >= 0x1C10 && index <= 0x1C33);
}

bool hasObject(const SlavePart& slave, std::uint16_t index, std::uint8_t subindex) {
    const auto same = [&](const auto& object) {
        return object.index == index && object.subindex == subindex;
    };
    const fieldbus::SlaveParams& params = slave.params;
    return std::any_of(params.startup.begin(), params.startup.end(), same) ||
           (params.listed &&
            std::any_of(params.listed->objects.begin(), params.listed->objects.end(), same));
}

/// The range a value must be in: that of its type, narrowed by the dictionary.
IntegerRange rangeOf(const ValueType& type, const wire::ObjectEntryDescription* entry) {
    IntegerRange range{type.least, type.most};
    if (entry != nullptr && entry->minimum) range.least = std::max(range.least, *entry->minimum);
    if (entry != nullptr && entry->maximum) range.most = std::min(range.most, *entry->maximum);
    return range;
}

/// The type told in the file, else that of the dictionary; a contradiction is an error.
const ValueType* chooseType(ElementReader& reader, const wire::ObjectEntryDescription* entry,
                            const std::string& shown) {
    std::vector<std::pair<std::string, const ValueType*>> choices;
    choices.reserve(Types.size());
    for (const ValueType& type : Types) choices.emplace_back(type.name, &type);
    const ValueType* const known = entry != nullptr ? typeOf(entry->type) : nullptr;
    const auto told = reader.choice<const ValueType*>(
        "type", choices, known != nullptr ? Presence::Optional : Presence::Required);
    if (!told) return known;
    if (entry != nullptr && (*told)->bits != entry->bits) {
        reader.error("type", fmt::format("the object {} has {} bits", shown, entry->bits),
                     known != nullptr ? std::string{known->name} : "another type");
        return nullptr;
    }
    return *told;
}

void readOne(XmlElement element, SlavePart& slave) {
    ElementReader reader{element, slave.reader.label() + ", <Startup>", slave.reader.place().file,
                         slave.reader.diagnostics()};
    StartupObject object;
    const auto index = reader.integer("index", {1, 0xFFFF}, Presence::Required);
    object.index = static_cast<std::uint16_t>(index.value_or(0));
    object.subindex = static_cast<std::uint8_t>(reader.integer("sub", {0, 255}).value_or(0));
    const std::string shown = fmt::format("0x{:04X}:{:02X}", object.index, object.subindex);
    const auto* const entry = findEntry(*slave.params.device, object.index, object.subindex);
    const ValueType* const type = chooseType(reader, entry, shown);
    const auto value = reader.integer(
        "value", type != nullptr ? rangeOf(*type, entry) : IntegerRange{}, Presence::Required);
    object.required = reader.flag("required").value_or(true);
    object.origin = format(reader.place());
    reader.finish();
    if (!index) return;
    if (belongsToMaster(object.index)) {
        reader.error("index", fmt::format("the object {} is written by the master", shown),
                     "other objects", "use <Pdo> and <Dc>");
    } else if (entry != nullptr && !entry->writable) {
        reader.error("index", fmt::format("the object {} cannot be written", shown),
                     "objects that the dictionary marks as writable");
    } else if (hasObject(slave, object.index, object.subindex)) {
        reader.error("index", fmt::format("the object {} is there twice", shown), "once");
    } else if (type != nullptr && value) {
        object.data = littleEndian(*value, type->bits);
        slave.params.startup.push_back(std::move(object));
    }
}

/// Adds start-up objects for an axis, in the drive's units.
class DriveObjects {
public:
    DriveObjects(SlavePart& slave, const AxisPart& axis) : slave_{slave}, axis_{axis} {}

    /// Leaves out what the device has not, cannot write, or the user writes. A value that the
    /// device does not take is an error at `where`, or, without one, brought into range.
    void add(std::uint16_t index, std::uint8_t subindex, double value, bool required,
             const ElementReader* where = nullptr, std::string_view attribute = {}) {
        const auto* const entry = findEntry(*slave_.params.device, index, subindex);
        if (entry == nullptr || !entry->writable || hasObject(slave_, index, subindex)) return;
        const ValueType* const type = typeOf(entry->type);
        if (type == nullptr) return;
        const IntegerRange range = rangeOf(*type, entry);
        const double rounded = std::nearbyint(value);
        const bool fits = rounded >= static_cast<double>(range.least) &&
                          rounded <= static_cast<double>(range.most);
        if (!fits && where != nullptr && where->element().attribute(attribute)) {
            where->error(attribute,
                         fmt::format("the drive would need {:.0f} in 0x{:04X}:{:02X}", rounded,
                                     index, subindex),
                         fmt::format("{} to {} in the drive's units, {}", range.least, range.most,
                                     inUserUnits(index, range)));
            return;
        }
        const double bounded =
            std::clamp(rounded, static_cast<double>(range.least), static_cast<double>(range.most));
        slave_.params.startup.push_back(
            {index, subindex, littleEndian(static_cast<std::int64_t>(bounded), type->bits),
             required, fmt::format("axis '{}' ({})", axis_.params.name, axis_.params.origin)});
    }

    /// Drive units for one user unit, of speed per second or of acceleration per second squared.
    [[nodiscard]] double perUnit() const noexcept {
        const axis::AxisParams& params = axis_.params;
        const double turns = std::abs(turnsPerUnit(params.scaling));
        switch (params.drive.velocityUnit) {
            case axis::DriveVelocityUnit::CountsPerSecond:
                return turns * static_cast<double>(params.scaling.countsPerTurn);
            case axis::DriveVelocityUnit::TenthRpm:
                return turns * 600.0;
        }
        return turns;
    }

private:
    [[nodiscard]] std::string inUserUnits(std::uint16_t index, IntegerRange range) const {
        const char* const time = index == cia402::HomingAcceleration ? "s^2" : "s";
        return fmt::format("at most {:.6g} {}/{}", static_cast<double>(range.most) / perUnit(),
                           axis_.params.unit, time);
    }

    SlavePart& slave_;
    const AxisPart& axis_;
};

}  // namespace

void readStartup(SlavePart& slave) {
    for (const XmlElement element : slave.reader.children("Startup")) readOne(element, slave);
}

void addDriveObjects(SlavePart& slave, const AxisPart& axis, std::uint32_t lostLimit) {
    constexpr std::uint16_t SyncErrorSettings = 0x10F1;
    constexpr std::uint16_t AbortConnectionOption = 0x6007;
    constexpr std::uint16_t DisableOperationOption = 0x605C;
    constexpr std::uint16_t FaultReactionOption = 0x605E;
    constexpr double QuickStopCommand = 3.0;  // of 6007h: as the quick stop command
    DriveObjects objects{slave, axis};
    const axis::AxisParams& params = axis.params;
    const double perUnit = objects.perUnit();

    // A killed controller must end in a ramp, not in free coasting, wherever the drive offers the
    // choice.
    objects.add(SyncErrorSettings, 2, static_cast<double>(lostLimit) + 1.0, false);
    objects.add(AbortConnectionOption, 0, QuickStopCommand, false);
    objects.add(cia402::QuickStopOption, 0, slave.profile->quickStopOption, true);
    objects.add(DisableOperationOption, 0, 1.0, false);
    objects.add(FaultReactionOption, 0, slave.profile->quickStopOption, false);
    const double stop = params.limits.stopDeceleration.count() * perUnit;
    // 605Ah = 1 names 6084h in one manual and 6085h in the standard: both get the stop ramp.
    objects.add(cia402::ProfileDeceleration, 0, stop, false);
    objects.add(cia402::QuickStopDeceleration, 0, stop, false);

    const XmlElement element = axis.reader.element().child("Homing");
    const ElementReader homing{element, axis.reader.label() + ", <Homing>",
                               axis.reader.place().file, axis.reader.diagnostics()};
    objects.add(cia402::HomingMethod, 0, params.homing.method, true, &homing, "method");
    constexpr std::int8_t NoMotion = 35;
    if (params.homing.method == NoMotion || params.homing.method == 37) return;
    objects.add(cia402::HomingSpeeds, 1, params.homing.switchSpeed.count() * perUnit, true, &homing,
                "switchSpeed");
    objects.add(cia402::HomingSpeeds, 2, params.homing.zeroSpeed.count() * perUnit, true, &homing,
                "zeroSpeed");
    objects.add(cia402::HomingAcceleration, 0, params.homing.acceleration.count() * perUnit, true,
                &homing, "acceleration");
}

}  // namespace takt::config
