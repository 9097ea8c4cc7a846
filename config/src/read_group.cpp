#include <fmt/format.h>

#include <algorithm>

#include "machine_parts.hpp"
#include "names.hpp"

namespace takt::config {

namespace {

const AxisPart* findAxis(const std::vector<AxisPart>& axes, const std::string& name) {
    const auto found = std::find_if(axes.begin(), axes.end(), [&name](const AxisPart& part) {
        return part.params.name == name;
    });
    return found == axes.end() ? nullptr : &*found;
}

std::string axisNames(const std::vector<AxisPart>& axes) {
    std::vector<std::string> names;
    names.reserve(axes.size());
    for (const AxisPart& axis : axes) names.push_back(axis.params.name);
    return names.empty() ? "the machine has no axis" : joined(names);
}

/// One <Member>: reports what keeps the axis out of the group.
void readMember(ElementReader reader, const std::vector<AxisPart>& axes, axis::GroupParams& group) {
    const auto name = reader.text("axis", Presence::Required);
    reader.finish();
    if (!name) return;
    const AxisPart* const axis = findAxis(axes, *name);
    if (axis == nullptr) {
        reader.error("axis", fmt::format("there is no axis '{}'", *name), axisNames(axes));
        return;
    }
    const auto index = static_cast<std::size_t>(axis - axes.data());
    if (std::find(group.axes.begin(), group.axes.end(), index) != group.axes.end()) {
        reader.error("axis", fmt::format("axis '{}' is in the group already", *name),
                     "each axis once");
        return;
    }
    if (axis->params.scaling.modulo) {
        reader.error("axis", fmt::format("axis '{}' is a modulo axis", *name), "linear axes");
        return;
    }
    const bool cartesian = !group.axes.empty() && group.axes.size() < axis::CartesianAxes;
    const std::string& unit = axis->params.unit;
    if (cartesian && unit != group.unit) {
        reader.error("axis",
                     fmt::format("axis '{}' is in {}, the first axis of the group in {}", *name,
                                 unit, group.unit),
                     fmt::format("the first {} axes in one unit: path length is measured in them",
                                 axis::CartesianAxes));
        return;
    }
    if (group.axes.empty()) group.unit = unit;
    group.axes.push_back(index);
}

void readMembers(ElementReader& reader, const std::vector<AxisPart>& axes,
                 axis::GroupParams& group) {
    const std::vector<XmlElement> members = reader.children("Member");
    if (members.empty()) {
        reader.error({}, "the group has no axis", axisNames(axes), "add <Member axis=\"…\"/>");
    } else if (members.size() > axis::MaxGroupAxes) {
        reader.error({}, fmt::format("the group has {} axes", members.size()),
                     fmt::format("at most {}", axis::MaxGroupAxes));
        return;
    }
    for (const XmlElement element : members) {
        readMember({element, fmt::format("{}, member", reader.label()), reader.place().file,
                    reader.diagnostics()},
                   axes, group);
    }
}

void readPathLimits(ElementReader& group, axis::GroupParams& params) {
    ElementReader reader = group.childReader("Limits", Presence::Required);
    const UnitDimensions units = dimensionsOf(params.unit);
    constexpr double RampsPerSecond = 10.0;  // as for an axis: acceleration builds up in 100 ms
    const auto value = [&](const char* name, Dimension dimension, Presence presence,
                           double fallback) {
        const auto read = reader.quantity(name, dimension, Sign::Positive, presence);
        return read ? read->value : fallback;
    };
    axis::PathLimitParams& limits = params.limits;
    const double velocity = value("velocity", units.velocity, Presence::Required, 0.0);
    const double up = value("acceleration", units.acceleration, Presence::Required, 0.0);
    const double down = value("deceleration", units.acceleration, Presence::Optional, up);
    limits.velocity = core::Velocity{velocity};
    limits.acceleration = core::Acceleration{up};
    limits.deceleration = core::Acceleration{down};
    limits.jerk = core::Jerk{
        value("jerk", units.jerk, Presence::Optional, RampsPerSecond * std::max(up, down))};
    reader.finish();
}

}  // namespace

axis::GroupParams readGroup(ElementReader reader, const std::vector<AxisPart>& axes) {
    axis::GroupParams group;
    group.unit = "mm";
    const auto name = reader.name("name");
    group.name = name.value_or("");
    group.origin = format(reader.place());
    if (name) reader.relabel(fmt::format("group '{}'", *name));
    if (name && findAxis(axes, *name) != nullptr) {
        reader.error("name", fmt::format("there is an axis '{}', too", *name),
                     "names that no axis has", "rename one of them");
    }
    constexpr std::int64_t DeepestQueue = 32;
    constexpr std::int64_t LongestLatency = 100;
    group.queueDepth = static_cast<std::uint32_t>(
        reader.integer("queue", {1, DeepestQueue}).value_or(group.queueDepth));
    group.latencyCycles = static_cast<std::uint32_t>(
        reader.integer("latency", {1, LongestLatency}).value_or(group.latencyCycles));
    readMembers(reader, axes, group);
    readPathLimits(reader, group);
    reader.finish();
    return group;
}

}  // namespace takt::config
