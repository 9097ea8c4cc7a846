#include <algorithm>
#include <takt/record/motion_trace.hpp>

namespace takt::record {

std::vector<TraceColumn> motionColumns(std::span<const MotionAxis> axes,
                                       std::span<const std::string> stateNames) {
    std::vector<TraceColumn> columns{{"cycle", ColumnKind::Integer, {}},
                                     {"t_ns", ColumnKind::Integer, {}}};
    for (const MotionAxis& axis : axes) {
        const auto add = [&](const char* what, ColumnKind kind) -> TraceColumn& {
            return columns.emplace_back(TraceColumn{axis.name + "." + what, kind, {}});
        };
        add("state", ColumnKind::Text).names.assign(stateNames.begin(), stateNames.end());
        add("set", ColumnKind::Real);
        add("setVel", ColumnKind::Real);
        add("setAcc", ColumnKind::Real);
        add("target", ColumnKind::Integer);
        add("actual", ColumnKind::Real);
        add("actualVel", ColumnKind::Real);
        add("lag", ColumnKind::Real);
        add("controlword", ColumnKind::Integer);
        add("statusword", ColumnKind::Integer);
        add("mode", ColumnKind::Integer);
        add("error", ColumnKind::Integer);
    }
    return columns;
}

void putCycle(TraceRow& row, core::CycleNumber cycle, core::HostTime time) noexcept {
    row.integer(static_cast<std::int64_t>(cycle));
    row.integer(time.time_since_epoch().count());
}

void putAxis(TraceRow& row, const MotionSample& sample) noexcept {
    row.text(sample.state);
    row.real(sample.set);
    row.real(sample.setVelocity);
    row.real(sample.setAcceleration);
    row.integer(sample.target);
    row.real(sample.actual);
    row.real(sample.actualVelocity);
    row.real(sample.lag);
    row.integer(sample.controlword);
    row.integer(sample.statusword);
    row.integer(sample.mode);
    row.integer(sample.error);
}

std::vector<TraceColumn> groupColumns(std::span<const MotionGroup> groups,
                                      std::span<const std::string> stateNames) {
    std::vector<TraceColumn> columns;
    for (const MotionGroup& group : groups) {
        const auto add = [&](const char* what, ColumnKind kind) -> TraceColumn& {
            return columns.emplace_back(TraceColumn{group.name + "." + what, kind, {}});
        };
        add("state", ColumnKind::Text).names.assign(stateNames.begin(), stateNames.end());
        add("s", ColumnKind::Real);
        add("sVel", ColumnKind::Real);
        add("sAcc", ColumnKind::Real);
        add("sJerk", ColumnKind::Real);
        add("command", ColumnKind::Integer);
        add("queued", ColumnKind::Integer);
        add("error", ColumnKind::Integer);
    }
    return columns;
}

void putGroup(TraceRow& row, const GroupSample& sample) noexcept {
    row.text(sample.state);
    row.real(sample.path);
    row.real(sample.velocity);
    row.real(sample.acceleration);
    row.real(sample.jerk);
    row.integer(sample.command);
    row.integer(sample.queued);
    row.integer(sample.error);
}

PlotSpec motionPlot(std::string_view title, std::string_view subtitle,
                    std::span<const MotionAxis> axes, std::span<const MotionGroup> groups) {
    PlotSpec spec{std::string{title}, std::string{subtitle}, {}, {}};
    std::vector<std::string> units;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        spec.bands.push_back({axes[i].name + ".state", axes[i].name, i});
        if (std::find(units.begin(), units.end(), axes[i].unit) == units.end()) {
            units.push_back(axes[i].unit);
        }
    }
    for (std::size_t i = 0; i < groups.size(); ++i) {
        spec.bands.push_back({groups[i].name + ".state", groups[i].name, axes.size() + i});
    }
    struct Quantity {
        const char* title;
        const char* per;
        const char* commanded;
        const char* measured;
    };
    constexpr Quantity Quantities[] = {{"position", "", ".set", ".actual"},
                                       {"velocity", "/s", ".setVel", ".actualVel"},
                                       {"acceleration", "/s²", ".setAcc", nullptr},
                                       {"following error", "", nullptr, ".lag"}};
    for (const Quantity& quantity : Quantities) {
        for (const std::string& unit : units) {
            PlotPanel& panel = spec.panels.emplace_back();
            panel.title = quantity.title;
            panel.unit = unit + quantity.per;
            const auto add = [&](const char* column, const char* what, CurveStyle style) {
                if (column == nullptr) return;
                for (std::size_t i = 0; i < axes.size(); ++i) {
                    if (axes[i].unit != unit) continue;
                    panel.curves.push_back({axes[i].name + column, axes[i].name + what, i, style});
                }
            };
            add(quantity.commanded, " set", CurveStyle::Commanded);
            add(quantity.measured, quantity.commanded == nullptr ? "" : " actual",
                CurveStyle::Measured);
        }
    }
    struct PathQuantity {
        const char* title;
        const char* per;
        const char* column;
    };
    constexpr PathQuantity PathQuantities[] = {{"velocity along the path", "/s", ".sVel"},
                                               {"acceleration along the path", "/s²", ".sAcc"},
                                               {"jerk along the path", "/s³", ".sJerk"}};
    for (std::size_t i = 0; i < groups.size(); ++i) {
        for (const PathQuantity& quantity : PathQuantities) {
            PlotPanel& panel = spec.panels.emplace_back();
            panel.title = groups[i].name + ": " + quantity.title;
            panel.unit = groups[i].unit + quantity.per;
            panel.curves.push_back({groups[i].name + quantity.column, groups[i].name,
                                    axes.size() + i, CurveStyle::Measured});
        }
    }
    return spec;
}

}  // namespace takt::record
