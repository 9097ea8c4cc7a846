#include <gtest/gtest.h>

#include <takt/scheduler/grid.hpp>

namespace takt::scheduler {
namespace {

using core::Duration;
using core::HostTime;
using namespace std::chrono_literals;

class HandClock : public core::ClockSource {
public:
    HostTime time{};
    Duration oversleep{0};

    [[nodiscard]] HostTime now() const noexcept override { return time; }
    void sleepUntil(HostTime wake) noexcept override {
        if (wake > time) time = wake + oversleep;
    }
};

TEST(Grid, KeepsTheAbsoluteGridWhateverTheWakeUpJitter) {
    HandClock clock;
    clock.oversleep = 70us;
    Grid grid{HostTime{10ms}, 1ms};
    for (int i = 0; i < 100; ++i) {
        const Beat beat = grid.wait(clock);
        EXPECT_EQ(beat.planned, HostTime{10ms + i * 1ms});
        EXPECT_EQ(beat.lateness(), 70us);
        EXPECT_EQ(beat.skipped, 0U);
    }
}

TEST(Grid, SkipsPointsThatHavePassedAndNeverCatchesUp) {
    HandClock clock;
    Grid grid{HostTime{1ms}, 1ms};
    grid.wait(clock);
    clock.time = HostTime{3500us};
    const Beat beat = grid.wait(clock);
    EXPECT_EQ(beat.planned, HostTime{4ms});
    EXPECT_EQ(beat.skipped, 2U);
    EXPECT_EQ(beat.number, 1U);
}

TEST(Grid, CountsAFewMissedPointsAsCycles) {
    HandClock clock;
    Grid grid{HostTime{1ms}, 1ms, 2};
    grid.wait(clock);
    clock.time = HostTime{3500us};
    const Beat beat = grid.wait(clock);
    EXPECT_EQ(beat.skipped, 2U);
    EXPECT_EQ(beat.madeUpFor, 2U);
    EXPECT_EQ(beat.number, 3U) << "the number is the place on the grid";
}

TEST(Grid, LetsTheMachinesTimeStandStillOverALongGap) {
    HandClock clock;
    Grid grid{HostTime{1ms}, 1ms, 2};
    grid.wait(clock);
    clock.time = HostTime{500ms};
    const Beat beat = grid.wait(clock);
    EXPECT_EQ(beat.skipped, 499U);
    EXPECT_EQ(beat.madeUpFor, 0U);
    EXPECT_EQ(beat.number, 1U);
}

TEST(Grid, MovesAllFurtherPointsByAShift) {
    HandClock clock;
    Grid grid{HostTime{1ms}, 1ms};
    grid.wait(clock);
    grid.shift(-3us);
    EXPECT_EQ(grid.wait(clock).planned, HostTime{1997us});
    EXPECT_EQ(grid.wait(clock).planned, HostTime{2997us});
}

}  // namespace
}  // namespace takt::scheduler
