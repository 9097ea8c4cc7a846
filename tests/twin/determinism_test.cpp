#include <gtest/gtest.h>

#include "devices.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

std::vector<Bytes> runOnce(std::uint64_t seed) {
    TwinParams params = lineOf(3, "cd300e");
    params.wakeJitter = microseconds{40};
    params.hostPpm = 12.0;
    params.seed = seed;
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.tracing = true;
    master.toOp();
    master.cycles(60);
    for (std::size_t i = 0; i < 3; ++i) master.enable(i, 8);
    for (int k = 0; k < 500; ++k) {
        for (std::size_t i = 0; i < 3; ++i) master.command(i, 0x000F, 8, k * k / 100);
        master.cycle();
    }
    return master.trace;
}

TEST(TwinDeterminism, GivesTheSameBytesForTheSameSeed) {
    EXPECT_EQ(runOnce(7), runOnce(7));
}

TEST(TwinDeterminism, GivesOtherFramesForAnotherSeed) {
    EXPECT_NE(runOnce(7), runOnce(8));
}

TEST(TwinClock, NeverWakesEarlyAndAtMostTheJitterLate) {
    TwinParams params = lineOf(1, "generic");
    params.wakeJitter = microseconds{40};
    params.hostPpm = 100.0;
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    core::Duration latest{0};
    core::HostTime wake = twin.clock().now();
    for (int i = 0; i < 1000; ++i) {
        wake += milliseconds{1};
        twin.clock().sleepUntil(wake);
        ASSERT_GE(twin.clock().now(), wake);
        latest = std::max(latest, twin.clock().now() - wake);
    }
    EXPECT_LE(latest, microseconds{40} + core::Duration{5});
    EXPECT_GE(latest, microseconds{38});
    // 1 s of a clock that is 100 ppm fast: 100 µs less of true time.
    EXPECT_NEAR(static_cast<double>(twin.trueTime().time_since_epoch().count()), 999'900'000.0,
                50'000.0);
}

TEST(TwinClock, ReturnsAtOnceWhenTheTimeHasPassed) {
    const TwinParams params = lineOf(1, "generic");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    twin.clock().sleepUntil(twin.clock().now() + milliseconds{3});
    const auto before = twin.trueTime();
    twin.clock().sleepUntil(twin.clock().now() - milliseconds{1});
    EXPECT_EQ(twin.trueTime(), before);
}

TEST(Twin, RefusesParametersThatDoNotFitTogether) {
    TwinParams params = lineOf(2, "generic");
    auto descriptions = descriptionsFor(params);
    descriptions.pop_back();
    EXPECT_THROW((Twin{params, descriptions, milliseconds{1}}), std::invalid_argument);
    EXPECT_THROW((Twin{params, descriptionsFor(params), milliseconds{0}}), std::invalid_argument);
    params.devices[1].countsPerTurn = 0;
    EXPECT_THROW((Twin{params, descriptionsFor(params), milliseconds{1}}), std::invalid_argument);
}

}  // namespace
}  // namespace takt::twin::test
