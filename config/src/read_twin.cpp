#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "machine_parts.hpp"
#include "numbers.hpp"

namespace takt::config {

namespace {

constexpr double LargestPpm = 1000.0;
constexpr double FarAway =
    1.0e6;  // turns: a switch without an end reaches as far as anything moves

/// Positions of a simulated axis: written in the axis' user unit or in motor turns, kept in motor
/// turns.
class MotorPositions {
public:
    explicit MotorPositions(const AxisPart* axis) : axis_{axis} {}

    std::optional<double> read(ElementReader& reader, std::string_view name) const {
        const auto attribute = reader.element().attribute(name);
        const bool turns =
            axis_ == nullptr || (attribute && trim(attribute->value).ends_with("turns"));
        if (turns) {
            const auto value = reader.quantity(name, Dimension::MotorTurns);
            return value ? std::optional{value->value} : std::nullopt;
        }
        const auto value = reader.quantity(name, dimensionsOf(axis_->params.unit).position);
        if (!value || !axis_->complete) return std::nullopt;
        return value->value * turnsPerUnit(axis_->params.scaling);
    }

    /// A switch or another pair of ends, in ascending motor turns; a missing end is far away.
    std::optional<twin::SwitchParams> readSpan(ElementReader reader, std::string_view from,
                                               std::string_view to) const {
        const bool reversed = axis_ != nullptr && axis_->params.scaling.reversed;
        const double first = read(reader, from).value_or(reversed ? FarAway : -FarAway);
        const double last = read(reader, to).value_or(reversed ? -FarAway : FarAway);
        reader.finish();
        if (!reader.present()) return std::nullopt;
        const bool swapped = reversed ? first <= last : first >= last;
        if (swapped) {
            reader.error(from, fmt::format("'{}' is not below '{}'", from, to),
                         fmt::format("{} below {}", from, to));
        }
        return twin::SwitchParams{std::min(first, last), std::max(first, last)};
    }

private:
    const AxisPart* axis_;
};

void readMechanics(ElementReader reader, const AxisPart* axis, twin::MechanicsParams& mechanics) {
    const MotorPositions positions{axis};
    mechanics.startTurns = positions.read(reader, "start").value_or(mechanics.startTurns);
    mechanics.indexTurns = positions.read(reader, "index").value_or(mechanics.indexTurns);
    const auto number = [&](std::string_view name, Dimension dimension, Sign sign,
                            double fallback) {
        const auto value = reader.quantity(name, dimension, sign);
        return value ? value->value : fallback;
    };
    mechanics.inertia = number("inertia", Dimension::Inertia, Sign::Positive, mechanics.inertia);
    mechanics.friction =
        number("friction", Dimension::Torque, Sign::NotNegative, mechanics.friction);
    mechanics.loadTorque = number("loadTorque", Dimension::Torque, Sign::Any, mechanics.loadTorque);
    mechanics.homeSwitch = positions.readSpan(reader.childReader("HomeSwitch"), "from", "to");
    mechanics.negativeLimit = positions.readSpan(reader.childReader("NegativeLimit"), "from", "to");
    mechanics.positiveLimit = positions.readSpan(reader.childReader("PositiveLimit"), "from", "to");
    const auto stops = positions.readSpan(reader.childReader("HardStops"), "from", "to");
    reader.finish();
    if (!stops) return;
    if (stops->fromTurns > -FarAway) mechanics.hardStopNegative = stops->fromTurns;
    if (stops->toTurns < FarAway) mechanics.hardStopPositive = stops->toTurns;
    const bool inside =
        mechanics.startTurns >= stops->fromTurns && mechanics.startTurns <= stops->toTurns;
    if (!inside) {
        reader.error("start", "the start position is outside the hard stops",
                     "between <HardStops> from and to");
    }
}

double readPpm(ElementReader& reader, std::string_view name) {
    const auto value = reader.quantity(name, Dimension::Frequency);
    if (!value) return 0.0;
    if (std::abs(value->value) > LargestPpm) {
        reader.error(name, "no oscillator is as far off as this", "-1000 ppm to 1000 ppm");
    }
    return value->value;
}

const AxisPart* axisOf(const std::string& slave, const std::vector<AxisPart>& axes) noexcept {
    for (const AxisPart& axis : axes) {
        if (axis.params.drive.slave == slave) return &axis;
    }
    return nullptr;
}

void readDevice(ElementReader& reader, const AxisPart* axis, twin::TwinDeviceParams& device) {
    device.clockPpm = readPpm(reader, "clock");
    device.clockStart = reader.time("clockStart").value_or(device.clockStart);
    device.forwardDelay = reader.time("forwardDelay").value_or(device.forwardDelay);
    device.cableDelay = reader.time("cableDelay").value_or(device.cableDelay);
    constexpr std::int64_t MostSubSteps = 64;
    device.subSteps = static_cast<std::uint32_t>(
        reader.integer("subSteps", {1, MostSubSteps}).value_or(device.subSteps));
    readMechanics(reader.childReader("Mechanics"), axis, device.mechanics);
    reader.finish();
}

/// One device for each slave as it is without a word in <Twin>.
std::vector<twin::TwinDeviceParams> plainDevices(const NetworkPart& network,
                                                 const std::vector<AxisPart>& axes) {
    std::vector<twin::TwinDeviceParams> devices;
    for (const SlavePart& slave : network.slaves) {
        twin::TwinDeviceParams device;
        device.slave = slave.params.name;
        device.profile = slave.profile != nullptr ? slave.profile->name : "generic";
        const AxisPart* const axis = axisOf(device.slave, axes);
        if (axis != nullptr) {
            device.countsPerTurn = axis->params.scaling.countsPerTurn;
        } else if (slave.profile != nullptr && slave.profile->countsPerTurn != 0) {
            device.countsPerTurn = slave.profile->countsPerTurn;
        }
        devices.push_back(std::move(device));
    }
    return devices;
}

}  // namespace

twin::TwinParams readTwin(ElementReader reader, NetworkPart& network,
                          const std::vector<AxisPart>& axes) {
    twin::TwinParams params;
    params.devices = plainDevices(network, axes);
    params.hostPpm = readPpm(reader, "clock");
    params.wakeJitter = reader.time("wakeJitter").value_or(params.wakeJitter);
    params.seed = static_cast<std::uint64_t>(
        reader.integer("seed", {0, std::numeric_limits<std::int64_t>::max()}).value_or(1));
    std::set<std::string> seen;
    for (const XmlElement element : reader.children("Device")) {
        ElementReader deviceReader{element, "twin, <Device>", reader.place().file,
                                   reader.diagnostics()};
        const std::string name = deviceReader.text("slave", Presence::Required).value_or("");
        const auto found = std::find_if(params.devices.begin(), params.devices.end(),
                                        [&](const auto& device) { return device.slave == name; });
        if (!name.empty()) deviceReader.relabel(fmt::format("twin of '{}'", name));
        if (found == params.devices.end()) {
            if (!name.empty() && network.slavesKnown) {
                deviceReader.error("slave", fmt::format("there is no slave '{}'", name),
                                   "the slaves of <Network>");
            }
            continue;  // its positions cannot be understood without its axis
        }
        if (!seen.insert(name).second) {
            deviceReader.error("slave", fmt::format("the slave '{}' is described twice", name),
                               "once");
        }
        SlavePart* const slave = network.find(name);
        if (const auto type = deviceReader.text("device"); type && slave != nullptr) {
            slave->twinDevice = selectDevice(*type, {}, deviceReader, network.catalogue);
        }
        readDevice(deviceReader, axisOf(name, axes), *found);
    }
    reader.finish();
    return params;
}

}  // namespace takt::config
