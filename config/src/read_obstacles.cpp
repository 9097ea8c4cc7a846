#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "machine_parts.hpp"
#include "names.hpp"

namespace takt::config {

namespace {

namespace roadmap = planner::roadmap;

/// The group that the obstacles are of, and what its axes are called.
struct Members {
    const axis::GroupParams* group{nullptr};
    std::vector<const axis::AxisParams*> axes;

    [[nodiscard]] std::string names() const {
        std::vector<std::string> all;
        for (const axis::AxisParams* axis : axes) all.push_back(axis->name);
        return joined(all);
    }
};

Members membersOf(ElementReader& reader, const std::vector<AxisPart>& axes,
                  const std::vector<axis::GroupParams>& groups) {
    Members members;
    const auto name = reader.text("group", Presence::Required);
    if (!name) return members;
    std::vector<std::string> known;
    for (const axis::GroupParams& group : groups) {
        known.push_back(group.name);
        if (group.name == *name) members.group = &group;
    }
    if (members.group == nullptr) {
        reader.error("group", fmt::format("there is no group '{}'", *name),
                     known.empty() ? "the machine has no group" : joined(known));
        return members;
    }
    for (const std::size_t index : members.group->axes) members.axes.push_back(&axes[index].params);
    return members;
}

/// Ways are looked for within the soft limits.
void checkBounds(const ElementReader& reader, const Members& members) {
    for (const axis::AxisParams* axis : members.axes) {
        const axis::LimitParams& limits = axis->limits;
        if (limits.softNegative && limits.softPositive) continue;
        reader.error("group",
                     fmt::format("axis '{}' of the group has no {}", axis->name,
                                 limits.softNegative ? "softPositive" : "softNegative"),
                     "both soft limits: a way is looked for between them",
                     fmt::format("add them in {}", axis->origin));
    }
}

/// Reads one <Box> or <Cylinder>.
class KeepOutReader {
public:
    KeepOutReader(ElementReader reader, const Members& members, core::Distance clearance)
        : reader_{std::move(reader)}, members_{members}, units_{dimensionsOf(members.group->unit)} {
        const auto name = reader_.name("name");
        keepOut_.name = name.value_or("");
        keepOut_.origin = format(reader_.place());
        if (name) reader_.relabel(fmt::format("keep-out '{}'", *name));
        const auto own = reader_.quantity("clearance", units_.position, Sign::NotNegative);
        keepOut_.clearance = own ? core::Distance{own->value} : clearance;
    }

    roadmap::KeepOutParams readBox() {
        readSpans();
        if (reader_.element().child("Span").present()) return finished();
        reader_.error({}, "the box has no <Span>: it would cover everything",
                      "a <Span> for each axis that bounds it");
        return finished();
    }

    roadmap::KeepOutParams readCylinder() {
        const auto radius =
            reader_.quantity("radius", units_.position, Sign::Positive, Presence::Required);
        const std::vector<XmlElement> centres = reader_.children("Centre");
        std::vector<std::pair<std::size_t, core::Position>> found;
        for (const XmlElement element : centres) {
            ElementReader centre = childReader(element, "centre");
            const auto axis = axisOf(centre);
            const auto at = centre.quantity("at", units_.position, Sign::Any, Presence::Required);
            centre.finish();
            if (axis && at) found.emplace_back(*axis, core::Position{at->value});
        }
        if (centres.size() != 2) {
            reader_.error({}, fmt::format("the cylinder has {} <Centre>", centres.size()),
                          "two: the axes in whose plane it is round");
        } else if (radius && found.size() == 2) {
            keepOut_.disc = roadmap::KeepOutDisc{found[0].first, found[1].first, found[0].second,
                                                 found[1].second, core::Distance{radius->value}};
        }
        readSpans();
        return finished();
    }

    [[nodiscard]] const ElementReader& reader() const noexcept { return reader_; }

private:
    roadmap::KeepOutParams finished() {
        reader_.finish();
        return std::move(keepOut_);
    }

    ElementReader childReader(XmlElement element, const char* kind) const {
        return {element, fmt::format("{}, {}", reader_.label(), kind), reader_.place().file,
                reader_.diagnostics()};
    }

    void readSpans() {
        for (const XmlElement element : reader_.children("Span")) {
            ElementReader reader = childReader(element, "span");
            const auto axis = axisOf(reader);
            const auto from = reader.quantity("from", units_.position);
            const auto to = reader.quantity("to", units_.position);
            reader.finish();
            if (!from && !to) {
                const bool unreadable =
                    element.attribute("from").has_value() || element.attribute("to").has_value();
                if (!unreadable) reader.error({}, "the span has no end", "from, to, or both");
                continue;
            }
            if (from && to && from->value >= to->value) {
                reader.error(
                    "from",
                    fmt::format("the span has no extent: {:g} {} is not below {:g} {}", from->value,
                                members_.group->unit, to->value, members_.group->unit),
                    "from below to");
            }
            if (axis) warnIfOutside(reader, *axis, from, to);
            roadmap::KeepOutSpan span;
            span.axis = axis.value_or(0);
            if (from) span.from = core::Position{from->value};
            if (to) span.to = core::Position{to->value};
            keepOut_.spans.push_back(span);
        }
    }

    /// A keep-out that no axis can reach was probably meant to be elsewhere.
    void warnIfOutside(const ElementReader& reader, std::size_t place,
                       const std::optional<Quantity>& from,
                       const std::optional<Quantity>& to) const {
        const axis::AxisParams& axis = *members_.axes[place];
        const axis::LimitParams& limits = axis.limits;
        if (!limits.softNegative || !limits.softPositive) return;
        const double clearance = keepOut_.clearance.count();
        const double low = limits.softNegative->count() - clearance;
        const double high = limits.softPositive->count() + clearance;
        if (!((from && from->value > high) || (to && to->value < low))) return;
        reader.diagnostics().warning(
            reader.place(),
            fmt::format("{}: it lies beyond the soft limits of axis '{}' and is in nobody's way",
                        reader_.label(), axis.name),
            fmt::format("{:g} {} to {:g} {}", limits.softNegative->count(), axis.unit,
                        limits.softPositive->count(), axis.unit));
    }

    /// Its place in the group.
    std::optional<std::size_t> axisOf(ElementReader& reader) {
        const auto name = reader.text("axis", Presence::Required);
        if (!name) return std::nullopt;
        const auto found =
            std::find_if(members_.axes.begin(), members_.axes.end(),
                         [&name](const axis::AxisParams* axis) { return axis->name == *name; });
        if (found == members_.axes.end()) {
            reader.error("axis",
                         fmt::format("'{}' is no axis of group '{}'", *name, members_.group->name),
                         members_.names());
            return std::nullopt;
        }
        const auto [line, fresh] = lines_.emplace(*name, reader.place().line);
        if (!fresh) {
            reader.error("axis",
                         fmt::format("axis '{}' stands in line {} already", *name, line->second),
                         "each axis once in a keep-out");
        } else if ((*found)->unit != members_.group->unit) {
            reader.error("axis",
                         fmt::format("axis '{}' is in {}, the paths of the group in {}", *name,
                                     (*found)->unit, members_.group->unit),
                         "axes in the unit of the group's paths");
        }
        return static_cast<std::size_t>(found - members_.axes.begin());
    }

    ElementReader reader_;
    const Members& members_;
    UnitDimensions units_;
    roadmap::KeepOutParams keepOut_;
    std::map<std::string, int> lines_;
};

}  // namespace

std::optional<roadmap::ObstacleParams> readObstacles(ElementReader reader,
                                                     const std::vector<AxisPart>& axes,
                                                     const std::vector<axis::GroupParams>& groups) {
    const Members members = membersOf(reader, axes, groups);
    if (members.group == nullptr) return std::nullopt;
    reader.relabel(fmt::format("obstacles of group '{}'", members.group->name));
    checkBounds(reader, members);
    const UnitDimensions units = dimensionsOf(members.group->unit);
    const auto clearance = reader.quantity("clearance", units.position, Sign::NotNegative);
    const core::Distance common{clearance ? clearance->value : 0.0};
    roadmap::ObstacleParams obstacles;
    obstacles.group = static_cast<std::size_t>(members.group - groups.data());
    obstacles.origin = format(reader.place());
    constexpr std::int64_t LongestLatency = 100000;
    obstacles.latencyCycles = static_cast<std::uint32_t>(
        reader.integer("latency", {1, LongestLatency}).value_or(obstacles.latencyCycles));
    std::map<std::string, int> lines;
    const auto keep = [&](roadmap::KeepOutParams keepOut, const ElementReader& element) {
        const auto [first, fresh] = lines.emplace(keepOut.name, element.place().line);
        if (!fresh && !keepOut.name.empty()) {
            element.error("name",
                          fmt::format("there is a keep-out of this name in line {}", first->second),
                          "each name once", "rename one of them");
        }
        obstacles.keepOuts.push_back(std::move(keepOut));
    };
    for (const char* kind : {"Box", "Cylinder"}) {
        for (const XmlElement element : reader.children(kind)) {
            KeepOutReader keepOut{
                {element, kind, reader.place().file, reader.diagnostics()}, members, common};
            const bool box = element.name() == "Box";
            keep(box ? keepOut.readBox() : keepOut.readCylinder(), keepOut.reader());
        }
    }
    reader.finish();
    return obstacles;
}

}  // namespace takt::config
