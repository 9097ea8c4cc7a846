#pragma once

#include <memory>
#include <span>
#include <string>
#include <takt/config/machine_config.hpp>
#include <takt/core/time.hpp>
#include <takt/daemon/run_options.hpp>
#include <takt/record/csv_trace.hpp>
#include <takt/record/motion_trace.hpp>
#include <takt/record/output_file.hpp>
#include <takt/record/pcapng_writer.hpp>
#include <takt/record/plot_data.hpp>
#include <takt/record/top_view.hpp>
#include <takt/record/trace.hpp>
#include <vector>

#include "axes.hpp"

namespace takt::daemon {

/// The files a run leaves behind: trace, plots and frame capture, each only when asked for.
class Recorders {
public:
    /// Opens the files. \throw std::runtime_error naming the file that cannot be written
    Recorders(const RunOptions& options, const config::MachineConfig& machine);

    /// rt. One row of the trace.
    void row(core::CycleNumber cycle, const Movers& movers) noexcept;
    /// Outside the cycle: hands to the files what the cycle has left in the rings.
    void drain();
    /// Writes the rest and the plot. \return one line for each file that could not be completed
    [[nodiscard]] std::vector<std::string> finish(const std::string& title,
                                                  const std::string& subtitle);

    /// Null when no capture was asked for.
    [[nodiscard]] record::PcapngWriter* capture() noexcept { return capture_.get(); }

private:
    void openTopView(const config::MachineConfig& machine,
                     const std::vector<record::TraceColumn>& columns);

    core::Duration cycle_;
    std::filesystem::path plotPath_;
    std::filesystem::path topViewPath_;
    record::TopViewSpec topViewSpec_;
    std::vector<record::MotionAxis> motionAxes_;
    std::vector<record::MotionGroup> motionGroups_;
    std::unique_ptr<record::TraceRecorder> trace_;
    std::unique_ptr<record::OutputFile> csvFile_;
    std::unique_ptr<record::CsvTrace> csv_;
    std::unique_ptr<record::PlotData> plot_;
    std::unique_ptr<record::TopViewData> topView_;
    std::unique_ptr<record::OutputFile> captureFile_;
    std::unique_ptr<record::PcapngWriter> capture_;
    std::vector<record::TraceSink*> sinks_;
};

}  // namespace takt::daemon
