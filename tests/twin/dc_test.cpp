#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "dc_unit.hpp"
#include "devices.hpp"
#include "local_clock.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using wire::Command;

core::TrueTime at(std::int64_t ns) {
    return core::TrueTime{core::Duration{ns}};
}

TEST(TwinLocalClock, RunsFastByItsPpm) {
    const LocalClock clock{50.0, 1000};
    EXPECT_EQ(clock.at(at(0)), 1000);
    EXPECT_NEAR(static_cast<double>(clock.at(at(1'000'000'000))), 1'000'051'000.0, 1.0);
    // Far from the start the product has more than 64 bits.
    EXPECT_NEAR(static_cast<double>(clock.at(at(100'000'000'000'000))), 100'005'000'001'000.0,
                100.0);
}

TEST(TwinLocalClock, FindsTheFirstInstantAtWhichItShowsATime) {
    for (const double ppm : {-200.0, -0.3, 0.0, 0.7, 50.0, 977.0}) {
        const LocalClock clock{ppm, -5};
        for (const std::int64_t local : {1LL, 999'999LL, 123'456'789LL, 86'400'000'000'000LL}) {
            const core::TrueTime when = clock.whenReaching(local);
            EXPECT_GE(clock.at(when), local) << ppm;
            EXPECT_LT(clock.at(when - core::Duration{1}), local) << ppm;
        }
    }
}

TEST(TwinLocalClock, KeepsItsTimeWhenItsSpeedChanges) {
    LocalClock clock{50.0, 0};
    const std::int64_t before = clock.at(at(1'000'000));
    clock.adjust(at(1'000'000), rateFromPpm(-50.0), rateFromPpm(100.0), core::Duration{1000});
    EXPECT_EQ(clock.at(at(1'000'000)), before);
    // The slew ends by itself; afterwards trim and oscillator cancel.
    EXPECT_NEAR(static_cast<double>(clock.at(at(101'000'000)) - before), 100'000'000.0, 1.0);
}

TEST(TwinDc, LatchesReceiveTimesOfTheWholeLine) {
    TwinParams params = lineOf(3, "generic");
    for (TwinDeviceParams& device : params.devices) device.clockPpm = 0.0;
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.addressAll();
    ASSERT_EQ(master.send(Command::Bwr, 0, 0x0900, le32(0)).wkc, 3);
    std::int64_t port0[3];
    std::int64_t port1[3];
    for (std::size_t i = 0; i < 3; ++i) {
        const Bytes times = master.read(i, 0x0900, 8).data;
        const auto start = static_cast<std::uint32_t>(params.devices[i].clockStart.count());
        port0[i] = signed32(number(std::span{times}.first(4)) - start);
        port1[i] = signed32(number(std::span{times}.subspan(4, 4)) - start);
    }
    // Out: forward 600 plus the cable before the next device; back: the same, the last turns round
    // once.
    EXPECT_EQ(port0[1] - port0[0], 600 + 75);
    EXPECT_EQ(port0[2] - port0[1], 600 + 110);
    EXPECT_EQ(port1[1] - port0[1], 2 * (600 + 110));
    EXPECT_EQ(port1[0] - port0[0], 2 * (600 + 110) + 2 * (600 + 75));
}

TEST(TwinDc, LatchesOnlyByBroadcastAndStationWrites) {
    const TwinParams params = lineOf(1, "generic");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.addressAll();
    const auto latched = [&] { return number(master.read(0, 0x0900, 4).data); };
    const std::uint64_t before = latched();
    EXPECT_EQ(master.send(Command::Apwr, 0, 0x0900, le32(0)).wkc, 1);
    EXPECT_EQ(latched(), before);
    EXPECT_NE(number(master.read(0, 0x0918, 8).data), 0U);
    master.write(0, 0x0900, {0});
    EXPECT_NE(latched(), before);
}

TEST(TwinDc, ShowsSystemTimeAsLocalTimePlusOffsetMinusDelay) {
    TwinParams params = lineOf(1, "generic");
    params.devices[0].clockPpm = 0.0;
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.addressAll();
    master.write(0, 0x0920, le64(5'000'000'000'000U));
    master.write(0, 0x0928, le32(321));
    master.sleep(microseconds{100});  // the wire is free: the frame starts at once
    const auto sent = twin.trueTime();
    const std::uint64_t system = number(master.read(0, 0x0910, 8).data);
    const auto arrival = (sent + params.devices[0].cableDelay).time_since_epoch().count();
    const auto local = static_cast<std::uint64_t>(arrival + params.devices[0].clockStart.count());
    EXPECT_EQ(system, local + 5'000'000'000'000U - 321);
}

struct Skew {
    std::int64_t largest{0};
    std::size_t pulses{0};
};

/// Spread of the SYNC0 instants of equal number, in true time, over the last `measured` cycles.
Skew measureSkew(double scale, core::Duration wakeJitter, core::Duration cycleTime, int settle,
                 int measured) {
    TwinParams params = lineOf(6, "generic");
    params.wakeJitter = wakeJitter;
    params.hostPpm = -33.0;
    for (TwinDeviceParams& device : params.devices) device.clockPpm *= scale;
    Twin twin{params, descriptionsFor(params), cycleTime};
    std::vector<std::vector<std::int64_t>> pulses(6);
    TestMaster master{twin};
    master.toOp(cycleTime);
    master.cycles(settle);
    twin.onSync0([&](std::size_t device, core::TrueTime when) {
        pulses[device].push_back(when.time_since_epoch().count());
    });
    master.cycles(measured);
    Skew skew;
    skew.pulses = pulses[0].size();
    for (std::size_t k = 0; k + 1 < skew.pulses; ++k) {
        const std::int64_t reference = pulses[0][k];
        for (const auto& line : pulses) {
            for (std::size_t j = k == 0 ? 0 : k - 1; j < line.size() && j <= k + 1; ++j) {
                const std::int64_t distance = line[j] - reference;
                if (std::abs(distance) > cycleTime.count() / 2) continue;
                skew.largest = std::max(skew.largest, std::abs(distance));
            }
        }
    }
    return skew;
}

TEST(TwinDc, HoldsSync0OfAllDevicesWithin100NsAt50PpmWithJitteringFrames) {
    const Skew skew = measureSkew(1.0, microseconds{50}, milliseconds{1}, 200, 2000);
    EXPECT_GE(skew.pulses, 1999U);
    EXPECT_LE(skew.largest, 100);
    RecordProperty("skew_ns", static_cast<int>(skew.largest));
}

TEST(TwinDc, HoldsSync0Within100NsAt100PpmAndAFastOrSlowCycle) {
    for (const auto cycleTime : {microseconds{250}, microseconds{4000}}) {
        const Skew skew = measureSkew(2.0, microseconds{40}, cycleTime, 400, 1000);
        EXPECT_LE(skew.largest, 100) << cycleTime.count();
    }
}

TEST(TwinDc, ConvergesInHundredsOfFramesAndNotAtOnce) {
    TwinParams params = lineOf(2, "generic");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.addressAll();
    master.setUpClocks(0);
    master.sleep(milliseconds{10});  // 100 ppm apart: 1 µs
    const auto error = [&] { return std::abs(twin.probe(1).clockError.count()); };
    EXPECT_GT(error(), 900);
    const auto frames = [&](int count) {
        for (int i = 0; i < count; ++i) {
            master.send(Command::Frmw, TestMaster::station(0), 0x0910, Bytes(8, 0));
            master.sleep(milliseconds{1});
        }
    };
    frames(10);
    EXPECT_GT(error(), 100);
    frames(590);
    EXPECT_LE(error(), 5);
}

TEST(TwinDc, LearnsTheSpeedSoThatAPauseOfTheFramesCostsLittle) {
    TwinParams params = lineOf(2, "generic");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.addressAll();
    master.setUpClocks(3000);
    master.sleep(milliseconds{100});
    EXPECT_LE(std::abs(twin.probe(1).clockError.count()), 100);
    // Forgetting it brings the drift back: 100 ppm over 100 ms are 10 µs.
    master.write(1, 0x0930, le16(0x1000));
    master.sleep(milliseconds{100});
    EXPECT_NEAR(static_cast<double>(std::abs(twin.probe(1).clockError.count())), 10'000.0, 200.0);
}

TEST(TwinDc, ShowsTheDifferenceAsMagnitudeWithASignThatIsSetWhenAhead) {
    TwinParams params = lineOf(2, "generic");
    for (TwinDeviceParams& device : params.devices) device.clockPpm = 0.0;
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.addressAll();
    master.setUpClocks(0);
    const std::uint64_t offset = number(master.read(1, 0x0920, 8).data);
    const auto difference = [&](std::uint64_t newOffset) {
        master.write(1, 0x0920, le64(newOffset));
        master.write(1, 0x0930, le16(0x1000));
        master.send(Command::Frmw, TestMaster::station(0), 0x0910, Bytes(8, 0));
        return static_cast<std::uint32_t>(number(master.read(1, 0x092C, 4).data));
    };
    EXPECT_NEAR(difference(offset + 500) & 0x7FFFFFFF, 500, 1);
    EXPECT_EQ(difference(offset + 500) >> 31, 1U);
    EXPECT_NEAR(difference(offset - 500) & 0x7FFFFFFF, 500, 1);
    EXPECT_EQ(difference(offset - 500) >> 31, 0U);
}

TEST(TwinDc, StartsSync0AtTheStartTimeInSystemTime) {
    TwinParams params = lineOf(1, "generic");
    params.devices[0].clockPpm = 0.0;
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    std::vector<core::TrueTime> pulses;
    twin.onSync0([&](std::size_t, core::TrueTime when) { pulses.push_back(when); });
    TestMaster master{twin};
    master.addressAll();
    const auto start = static_cast<std::uint64_t>(params.devices[0].clockStart.count()) + 7'000'000;
    master.write(0, 0x09A0, le32(500'000));
    master.write(0, 0x0990, le64(start));
    master.write(0, 0x0981, {0x03});
    EXPECT_EQ(master.read(0, 0x0984, 1).data[0], 0x01);  // first pulse pending
    master.sleep(milliseconds{10});
    ASSERT_GE(pulses.size(), 3U);
    EXPECT_EQ(pulses[0], at(7'000'000));
    EXPECT_EQ(pulses[1], at(7'500'000));
    EXPECT_EQ(master.read(0, 0x0984, 1).data[0], 0x00);
    const auto next = number(master.read(0, 0x0990, 8).data);
    EXPECT_EQ((next - start) % 500'000, 0U);
    EXPECT_GT(next, start);
    master.write(0, 0x0981, {0x00});
    const std::size_t count = pulses.size();
    master.sleep(milliseconds{5});
    EXPECT_EQ(pulses.size(), count);
}

TEST(TwinDc, NeverStartsSync0WhenTheStartTimeHasPassed) {
    const TwinParams params = lineOf(1, "generic");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    std::size_t pulses = 0;
    twin.onSync0([&](std::size_t, core::TrueTime) { ++pulses; });
    TestMaster master{twin};
    master.addressAll();
    master.write(0, 0x09A0, le32(1'000'000));
    master.write(0, 0x0990, le64(1));
    master.write(0, 0x0981, {0x03});
    master.sleep(milliseconds{20});
    EXPECT_EQ(pulses, 0U);
    EXPECT_EQ(master.read(0, 0x0984, 1).data[0], 0x05);
}

TEST(TwinDc, RefusesActivationWhileTheSyncUnitBelongsToTheDevice) {
    const TwinParams params = lineOf(1, "generic");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.addressAll();
    master.write(0, 0x0980, {0x01});
    master.write(0, 0x0981, {0x03});
    EXPECT_EQ(master.read(0, 0x0981, 1).data[0], 0x00);
}

}  // namespace
}  // namespace takt::twin::test
