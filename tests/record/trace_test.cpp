#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <takt/record/trace.hpp>
#include <thread>
#include <vector>

namespace takt::record {
namespace {

class Collector : public TraceSink {
public:
    void take(std::span<const TraceCell> row) override { rows.push_back(row.front().integer); }
    std::vector<std::int64_t> rows;
};

std::vector<TraceColumn> oneInteger() {
    return {{"n", ColumnKind::Integer, {}}};
}

void writeRow(TraceRecorder& trace, std::int64_t value) {
    TraceRow row = trace.row();
    row.integer(value);
    row.commit();
}

TEST(TraceRecorder, HandsRowsOverInTheOrderWritten) {
    TraceRecorder trace{oneInteger(), 4};
    Collector collector;
    TraceSink* sinks[] = {&collector};
    for (std::int64_t i = 0; i < 10; ++i) {
        writeRow(trace, i);
        if (i % 3 == 2) trace.drain(sinks);
    }
    trace.drain(sinks);
    EXPECT_EQ(collector.rows, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(trace.dropped(), 0U);
}

TEST(TraceRecorder, CountsRowsThatFindNoRoomAndKeepsTheOldOnes) {
    TraceRecorder trace{oneInteger(), 3};
    for (std::int64_t i = 0; i < 5; ++i) writeRow(trace, i);
    Collector collector;
    TraceSink* sinks[] = {&collector};
    EXPECT_EQ(trace.drain(sinks), 3U);
    EXPECT_EQ(collector.rows, (std::vector<std::int64_t>{0, 1, 2}));
    EXPECT_EQ(trace.dropped(), 2U);
}

TEST(TraceRecorder, HasRoomAgainAfterDraining) {
    TraceRecorder trace{oneInteger(), 1};
    Collector collector;
    TraceSink* sinks[] = {&collector};
    writeRow(trace, 1);
    trace.drain(sinks);
    writeRow(trace, 2);
    trace.drain(sinks);
    EXPECT_EQ(collector.rows, (std::vector<std::int64_t>{1, 2}));
}

TEST(TraceRecorder, ForgetsARowThatWasNotCommitted) {
    TraceRecorder trace{oneInteger(), 4};
    trace.row().integer(7);
    writeRow(trace, 8);
    Collector collector;
    TraceSink* sinks[] = {&collector};
    trace.drain(sinks);
    EXPECT_EQ(collector.rows, (std::vector<std::int64_t>{8}));
}

TEST(TraceRecorder, FeedsEverySink) {
    TraceRecorder trace{oneInteger(), 4};
    writeRow(trace, 5);
    Collector first;
    Collector second;
    TraceSink* sinks[] = {&first, &second};
    trace.drain(sinks);
    EXPECT_EQ(first.rows, second.rows);
    EXPECT_EQ(first.rows.size(), 1U);
}

TEST(TraceRecorder, HandsRowsFromOneThreadToAnother) {
    constexpr std::int64_t Rows = 20000;
    TraceRecorder trace{oneInteger(), 7};
    std::thread producer{[&] {
        for (std::int64_t i = 0; i < Rows;) {
            const std::uint64_t before = trace.dropped();
            writeRow(trace, i);
            if (trace.dropped() == before) {
                ++i;
            } else {
                std::this_thread::yield();
            }
        }
    }};
    Collector collector;
    TraceSink* sinks[] = {&collector};
    while (collector.rows.size() < Rows) {
        if (trace.drain(sinks) == 0) std::this_thread::yield();
    }
    producer.join();
    std::vector<std::int64_t> expected(Rows);
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(collector.rows, expected);
}

TEST(TraceRecorder, RefusesToHaveNoColumnsOrNoRoom) {
    EXPECT_THROW(TraceRecorder({}, 4), std::invalid_argument);
    EXPECT_THROW(TraceRecorder(oneInteger(), 0), std::invalid_argument);
}

}  // namespace
}  // namespace takt::record
