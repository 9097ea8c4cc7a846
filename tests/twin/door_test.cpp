#include <gtest/gtest.h>

#include <array>
#include <takt/wire/registers.hpp>

#include "devices.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

core::TrueTime at(core::Duration time) {
    return core::TrueTime{time};
}

/// Reads the system time of the first device (register 0x0910).
wire::Frame timeRequest() {
    wire::Frame frame;
    wire::FrameWriter writer{frame};
    writer.append(wire::Command::Aprd, 1, 0, wire::reg::DcSystemTime, 8);
    writer.finish();
    return frame;
}

std::uint64_t timeIn(wire::Frame& frame) {
    wire::DatagramCursor cursor{frame.view()};
    EXPECT_TRUE(cursor.next());
    EXPECT_EQ(cursor.datagram().workingCounter(), 1);
    return number(cursor.datagram().data());
}

/// Devices whose clocks are exact.
TwinParams exactLine() {
    TwinParams params = lineOf(2, "generic");
    for (TwinDeviceParams& device : params.devices) device.clockPpm = 0.0;
    return params;
}

class Door : public testing::Test {
protected:
    std::uint64_t timeAt(core::TrueTime arrival) {
        EXPECT_TRUE(twin_.arrive(timeRequest(), arrival));
        std::array<wire::Frame, 4> back;
        EXPECT_EQ(twin_.comeBack(back), 1U);
        return timeIn(back[0]);
    }

    TwinParams params_{exactLine()};
    Twin twin_{params_, descriptionsFor(params_), milliseconds{1}};
};

TEST_F(Door, LetsAFrameActWhenItArrived) {
    const std::uint64_t first = timeAt(at(milliseconds{5}));
    const std::uint64_t second = timeAt(at(milliseconds{5} + microseconds{1234}));
    EXPECT_EQ(second - first, 1'234'000U);
}

TEST_F(Door, DoesNotCareHowFarTheWorldHadBeenLetRunBefore) {
    Twin other{params_, descriptionsFor(params_), milliseconds{1}};
    for (int i = 1; i < 50; ++i) {
        const core::TrueTime arrival = at(i * microseconds{777});
        other.advance(arrival - microseconds{100 + i});
        ASSERT_TRUE(other.arrive(timeRequest(), arrival));
        std::array<wire::Frame, 4> back;
        ASSERT_EQ(other.comeBack(back), 1U);
        ASSERT_EQ(timeIn(back[0]), timeAt(arrival));
        ASSERT_EQ(other.trueTime(), twin_.trueTime());
    }
}

TEST_F(Door, ServesAFrameThatComesLateAtOnce) {
    twin_.advance(at(milliseconds{10}));
    const std::uint64_t now = timeAt(at(milliseconds{2}));
    const std::uint64_t later = timeAt(at(milliseconds{20}));
    EXPECT_NEAR(static_cast<double>(later - now), 10e6, 100e3);
}

TEST_F(Door, ReturnsSeveralFramesInTheirOrder) {
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(twin_.arrive(timeRequest(), at(milliseconds{1})));
    std::array<wire::Frame, 4> back;
    ASSERT_EQ(twin_.comeBack(back), 3U);
    EXPECT_LT(timeIn(back[0]), timeIn(back[1]));
    EXPECT_LT(timeIn(back[1]), timeIn(back[2]));
}

TEST_F(Door, GivesNothingBackThroughACutCable) {
    twin_.cutCable(true);
    ASSERT_TRUE(twin_.arrive(timeRequest(), at(milliseconds{1})));
    std::array<wire::Frame, 4> back;
    EXPECT_EQ(twin_.comeBack(back), 0U);
    EXPECT_EQ(twin_.trueTime(), at(milliseconds{1}));
}

}  // namespace
}  // namespace takt::twin::test
