#include "recorders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <takt/record/motion_trace.hpp>
#include <takt/record/svg_plot.hpp>

#include "ground_plan.hpp"

namespace takt::daemon {

namespace {

/// Rows between two drains; in virtual time one, on a machine what a busy disk may need.
constexpr std::size_t TraceRows = 8192;
constexpr std::size_t CaptureBytes = std::size_t{8} << 20;

std::vector<std::string> stateNames() {
    std::vector<std::string> names;
    for (std::uint8_t i = 0; i <= static_cast<std::uint8_t>(axis::AxisState::ErrorStop); ++i) {
        names.emplace_back(axis::name(static_cast<axis::AxisState>(i)));
    }
    return names;
}

std::vector<std::string> groupStateNames() {
    std::vector<std::string> names;
    for (std::uint8_t i = 0; i <= static_cast<std::uint8_t>(axis::GroupState::ErrorStop); ++i) {
        names.emplace_back(axis::name(static_cast<axis::GroupState>(i)));
    }
    return names;
}

record::GroupSample sampleOf(const axis::GroupStatus& status) noexcept {
    return {.state = static_cast<std::uint32_t>(status.state),
            .path = status.path.count(),
            .velocity = status.velocity.count(),
            .acceleration = status.acceleration.count(),
            .jerk = status.jerk.count(),
            .command = status.command,
            .queued = status.queued,
            .error = static_cast<std::uint32_t>(status.error)};
}

record::MotionSample sampleOf(const axis::AxisStatus& status) noexcept {
    return {.state = static_cast<std::uint32_t>(status.state),
            .set = status.set.count(),
            .setVelocity = status.setVelocity.count(),
            .setAcceleration = status.setAcceleration.count(),
            .target = status.target,
            .actual = status.actual.count(),
            .actualVelocity = status.actualVelocity.count(),
            .lag = status.lag.count(),
            .controlword = status.controlword,
            .statusword = status.statusword,
            .mode = status.mode,
            .error = static_cast<std::uint32_t>(status.error)};
}

}  // namespace

Recorders::Recorders(const RunOptions& options, const config::MachineConfig& machine)
    : cycle_{machine.network.cycle}, plotPath_{options.plot}, topViewPath_{options.topView} {
    for (const axis::AxisParams& axis : machine.axes) motionAxes_.push_back({axis.name, axis.unit});
    for (const axis::GroupParams& group : machine.groups)
        motionGroups_.push_back({group.name, group.unit});
    auto columns = record::motionColumns(motionAxes_, stateNames());
    const auto ofGroups = record::groupColumns(motionGroups_, groupStateNames());
    columns.insert(columns.end(), ofGroups.begin(), ofGroups.end());
    if (!options.trace.empty()) {
        csvFile_ = std::make_unique<record::OutputFile>(options.trace);
        csv_ = std::make_unique<record::CsvTrace>(*csvFile_, columns);
        sinks_.push_back(csv_.get());
    }
    if (!plotPath_.empty()) {
        // Opened once at the start, so that a place that cannot be written is told before anything
        // moves.
        record::OutputFile{plotPath_}.flush();
        const auto spec = record::motionPlot({}, {}, motionAxes_, motionGroups_);
        plot_ = std::make_unique<record::PlotData>(columns, "t_ns", record::columnsOf(spec));
        sinks_.push_back(plot_.get());
    }
    if (!topViewPath_.empty()) openTopView(machine, columns);
    if (!sinks_.empty()) trace_ = std::make_unique<record::TraceRecorder>(columns, TraceRows);
    if (!options.capture.empty()) {
        captureFile_ = std::make_unique<record::OutputFile>(options.capture);
        capture_ = std::make_unique<record::PcapngWriter>(*captureFile_, "takt", CaptureBytes);
    }
}

void Recorders::openTopView(const config::MachineConfig& machine,
                            const std::vector<record::TraceColumn>& columns) {
    auto spec = groundPlanOf(machine);
    if (!spec) {
        throw std::runtime_error(fmt::format(
            "{}: there is nothing to be seen from above: a group whose first two axes have soft "
            "limits is needed",
            topViewPath_.string()));
    }
    record::OutputFile{topViewPath_}.flush();
    topViewSpec_ = std::move(*spec);
    constexpr double Fineness = 1e-4;  // of the longer side: far below a pixel
    const record::TopViewAxis& x = topViewSpec_.x;
    const record::TopViewAxis& y = topViewSpec_.y;
    topView_ = std::make_unique<record::TopViewData>(
        columns, x.name, y.name, Fineness * std::max(x.high - x.low, y.high - y.low));
    sinks_.push_back(topView_.get());
}

void Recorders::row(core::CycleNumber cycle, const Movers& movers) noexcept {
    if (!trace_) return;
    record::TraceRow row = trace_->row();
    record::putCycle(row, cycle, core::HostTime{cycle_ * static_cast<std::int64_t>(cycle)});
    for (const axis::Axis& axis : movers.axes) record::putAxis(row, sampleOf(axis.status()));
    for (const axis::Group& group : movers.groups) record::putGroup(row, sampleOf(group.status()));
    row.commit();
}

void Recorders::drain() {
    if (trace_) trace_->drain(sinks_);
    if (capture_) capture_->drain();
}

std::vector<std::string> Recorders::finish(const std::string& title, const std::string& subtitle) {
    drain();
    std::vector<std::string> problems;
    const auto incomplete = [&problems](const std::filesystem::path& path) {
        problems.push_back(fmt::format("{}: not complete; is the disk full?", path.string()));
    };
    if (csv_ && (!csv_->finish() || trace_->dropped() > 0)) incomplete(csvFile_->path());
    if (capture_ && (!capture_->finish() || capture_->dropped() > 0))
        incomplete(captureFile_->path());
    if (plot_) {
        record::OutputFile file{plotPath_};
        file.write(record::drawSvg(record::motionPlot(title, subtitle, motionAxes_, motionGroups_),
                                   *plot_));
        if (!file.flush()) incomplete(plotPath_);
    }
    if (topView_) {
        topViewSpec_.title = title;
        topViewSpec_.subtitle = subtitle;
        record::OutputFile file{topViewPath_};
        file.write(record::drawTopView(topViewSpec_, *topView_));
        if (!file.flush()) incomplete(topViewPath_);
    }
    return problems;
}

}  // namespace takt::daemon
