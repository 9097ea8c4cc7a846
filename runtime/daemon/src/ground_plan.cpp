#include "ground_plan.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

namespace takt::daemon {

namespace roadmap = planner::roadmap;

namespace {

constexpr double Infinite = std::numeric_limits<double>::infinity();

struct Range {
    double low{-Infinite};
    double high{Infinite};
};

/// " (Z from -50 mm to 0 mm)": where it does not reach through the whole height.
std::string heightOf(const roadmap::KeepOutParams& keepOut, const axis::GroupParams& group,
                     const config::MachineConfig& machine) {
    std::string text;
    for (const roadmap::KeepOutSpan& span : keepOut.spans) {
        if (span.axis < 2) continue;
        const axis::AxisParams& axis = machine.axes[group.axes[span.axis]];
        text += fmt::format("{}{}", text.empty() ? " (" : ", ", axis.name);
        if (std::isfinite(span.from.count()))
            text += fmt::format(" from {:g} {}", span.from.count(), axis.unit);
        if (std::isfinite(span.to.count()))
            text += fmt::format(" to {:g} {}", span.to.count(), axis.unit);
    }
    return text.empty() ? text : text + ")";
}

record::TopViewShape shapeOf(const roadmap::KeepOutParams& keepOut, std::string height) {
    record::TopViewShape shape;
    shape.label = keepOut.name + std::move(height);
    shape.clearance = keepOut.clearance.count();
    std::array<Range, 2> sides;
    for (const roadmap::KeepOutSpan& span : keepOut.spans) {
        if (span.axis < 2) sides[span.axis] = {span.from.count(), span.to.count()};
    }
    if (keepOut.disc) {
        const roadmap::KeepOutDisc& disc = *keepOut.disc;
        const double radius = disc.radius.count();
        std::array<double, 2> centre{};
        unsigned inPlane = 0;
        for (const auto& [axis, place] : {std::pair{disc.firstAxis, disc.firstCentre},
                                          std::pair{disc.secondAxis, disc.secondCentre}}) {
            if (axis >= 2) continue;
            centre[axis] = place.count();
            sides[axis] = {place.count() - radius, place.count() + radius};
            ++inPlane;
        }
        if (inPlane == 2) shape.circle = {centre[0], centre[1], radius};
    }
    shape.left = sides[0].low;
    shape.right = sides[0].high;
    shape.bottom = sides[1].low;
    shape.top = sides[1].high;
    return shape;
}

std::optional<record::TopViewAxis> axisOf(const axis::AxisParams& axis) {
    const axis::LimitParams& limits = axis.limits;
    if (!limits.softNegative || !limits.softPositive) return std::nullopt;
    return record::TopViewAxis{axis.name, axis.unit, limits.softNegative->count(),
                               limits.softPositive->count()};
}

}  // namespace

std::optional<record::TopViewSpec> groundPlanOf(const config::MachineConfig& machine) {
    const roadmap::ObstacleParams none;
    const roadmap::ObstacleParams& obstacles =
        machine.obstacles.empty() ? none : machine.obstacles.front();
    if (machine.groups.empty() || machine.groups[obstacles.group].axes.size() < 2)
        return std::nullopt;
    const axis::GroupParams& group = machine.groups[obstacles.group];
    const auto x = axisOf(machine.axes[group.axes[0]]);
    const auto y = axisOf(machine.axes[group.axes[1]]);
    if (!x || !y) return std::nullopt;
    record::TopViewSpec spec;
    spec.x = *x;
    spec.y = *y;
    for (const roadmap::KeepOutParams& keepOut : obstacles.keepOuts)
        spec.shapes.push_back(shapeOf(keepOut, heightOf(keepOut, group, machine)));
    return spec;
}

}  // namespace takt::daemon
