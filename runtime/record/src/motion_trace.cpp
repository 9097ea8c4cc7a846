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

PlotSpec motionPlot(std::string_view title, std::string_view subtitle,
                    std::span<const MotionAxis> axes) {
    PlotSpec spec{std::string{title}, std::string{subtitle}, {}, {}};
    std::vector<std::string> units;
    for (std::size_t i = 0; i < axes.size(); ++i) {
        spec.bands.push_back({axes[i].name + ".state", axes[i].name, i});
        if (std::find(units.begin(), units.end(), axes[i].unit) == units.end()) {
            units.push_back(axes[i].unit);
        }
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
    return spec;
}

}  // namespace takt::record
