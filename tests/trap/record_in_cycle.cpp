// What the recorder offers to the cycle, done inside the cycle: run with the trap in front, it must
// end with 0. Every ring is driven beyond its end as well.
#include <array>
#include <string>
#include <takt/core/cycle_guard.hpp>
#include <takt/record/event_log.hpp>
#include <takt/record/histogram.hpp>
#include <takt/record/motion_trace.hpp>
#include <takt/record/pcapng_writer.hpp>
#include <vector>

using namespace takt;

int main() {
    const std::vector<record::MotionAxis> axes{{"X", "mm"}};
    const std::vector<std::string> states{"Disabled", "Standstill"};
    record::TraceRecorder trace{record::motionColumns(axes, states), 100};
    record::OutputFile file{"/dev/null"};
    record::PcapngWriter capture{file, "cycle", 10000};
    record::EventLog events{100};
    record::Histogram histogram;
    const std::array<std::uint8_t, 60> frame{};
    {
        const core::CycleGuard guard;
        for (std::uint64_t k = 0; k < 200; ++k) {
            record::TraceRow row = trace.row();
            record::putCycle(row, k, core::HostTime{});
            record::putAxis(row, {});
            row.commit();
            capture.packet(record::Direction::Outbound, core::HostTime{}, frame);
            events.add({k, 1, 0, {}});
            histogram.add(static_cast<std::int64_t>(k));
        }
    }
    const bool allCounted = trace.dropped() == 100 && events.dropped() == 100 &&
                            capture.packets() + capture.dropped() == 200 &&
                            histogram.count() == 200;
    return allCounted ? 0 : 1;
}
