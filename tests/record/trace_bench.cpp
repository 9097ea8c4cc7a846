// How many rows of a machine with three axes reach the file in a second of this computer.
#include <time.h>

#include <cstdio>
#include <stdexcept>
#include <takt/record/csv_trace.hpp>
#include <takt/record/motion_trace.hpp>

using namespace takt::record;

namespace {

double cpuSeconds() {
    timespec now{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void writeRows(TraceRecorder& trace, TraceSink* const* sinks, int rows) {
    double position = 0.1;
    for (int k = 0; k < rows; ++k) {
        TraceRow row = trace.row();
        putCycle(row, static_cast<takt::core::CycleNumber>(k),
                 takt::core::HostTime{std::chrono::milliseconds{k}});
        for (int axis = 0; axis < 3; ++axis) {
            position += 0.0123456789 * (axis + 1);
            const auto counts = static_cast<std::int64_t>(position * 500.0);
            putAxis(row, {3, position, position * 0.37, position * 0.11, counts, position - 0.01,
                          position * 0.36, 0.01 + position * 1e-9, 15, 0x1637, 8, 0});
        }
        row.commit();
        if (k % 64 == 63) trace.drain({sinks, 2});
    }
    trace.drain({sinks, 2});
}

}  // namespace

int main() {
    constexpr int Rows = 200000;
    const std::vector<MotionAxis> axes{{"X", "mm"}, {"Y", "mm"}, {"Z", "mm"}};
    const std::vector<std::string> states{"Disabled", "Standstill", "Homing", "DiscreteMotion"};
    TraceRecorder trace{motionColumns(axes, states), 256};
    OutputFile file{"/dev/null"};
    CsvTrace csv{file, trace.columns()};
    PlotData data{trace.columns(), "t_ns", columnsOf(motionPlot("", "", axes))};
    TraceSink* sinks[] = {&csv, &data};
    const double begin = cpuSeconds();
    writeRows(trace, sinks, Rows);
    csv.finish();
    const double seconds = cpuSeconds() - begin;
    std::printf(
        "%d rows of %zu columns, every number changing: %.0f rows/s of processor time, %llu "
        "dropped\n",
        Rows, trace.columns().size(), Rows / seconds,
        static_cast<unsigned long long>(trace.dropped()));
    return 0;
}
