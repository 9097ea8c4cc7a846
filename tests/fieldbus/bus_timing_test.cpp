#include <gmock/gmock.h>

#include <takt/fieldbus/bus_timing.hpp>

#include "cycle_plan.hpp"
#include "example_network.hpp"
#include "logical_layout.hpp"

namespace {

using namespace takt;
using fieldbus::computeTiming;
using std::chrono::microseconds;
using std::chrono::nanoseconds;

/// A device with `out` and `in` bytes of process data and no mailbox.
fieldbus::NetworkParams plainNetwork(std::size_t slaves, unsigned out, unsigned in) {
    fieldbus::NetworkParams network;
    auto device = std::make_shared<wire::DeviceDescription>();
    for (std::size_t i = 0; i < slaves; ++i) {
        fieldbus::SlaveParams slave;
        slave.device = device;
        for (unsigned byte = 0; byte < out; ++byte) {
            slave.outputs.push_back({0x1600, {{0x7000, 1, 8}}, false});
        }
        for (unsigned byte = 0; byte < in; ++byte) {
            slave.inputs.push_back({0x1A00, {{0x6000, 1, 8}}, false});
        }
        network.slaves.push_back(slave);
    }
    return network;
}

TEST(BusTiming, CountsEveryByteOnTheWire) {
    const auto timing = computeTiming(plainNetwork(3, 12, 16));
    // FRMW 12+8, LRW 12+84, BRD 12+2, slice of three AL status reads 3·(12+6).
    const std::size_t datagrams = 20 + 96 + 14 + 54;
    EXPECT_EQ(timing.acyclicBytes, 54U);
    EXPECT_EQ(timing.frames, 1U);
    EXPECT_EQ(timing.frameBytes, 14 + 2 + datagrams);
    EXPECT_EQ(timing.wireTime, nanoseconds((8 + 14 + 2 + datagrams + 4 + 12) * 80));
    EXPECT_EQ(timing.roundTrip, timing.wireTime + microseconds(3));
}

TEST(BusTiming, NeverCountsLessThanTheShortestFrame) {
    const auto timing = computeTiming(plainNetwork(1, 0, 0));
    // Reference time, a NOP of one byte, AL status and one AL status read of the slice.
    EXPECT_EQ(timing.frameBytes, 14U + 2 + 20 + 13 + 14 + 18);
    EXPECT_GE(timing.wireTime, nanoseconds(84 * 80));
}

TEST(BusTiming, AgreesWithTheModelForAHundredAxes) {
    // Published figure of the wire model: 234 µs for process data and reference time of 100 axes
    // with 12 + 16 bytes; the AL status read and the acyclic frame come on top.
    const auto timing = computeTiming(plainNetwork(100, 12, 16));
    EXPECT_EQ(timing.frames, 3U);
    const auto processData =
        timing.wireTime - nanoseconds((timing.acyclicBytes + 40) * 80) - nanoseconds(14 * 80);
    EXPECT_NEAR(static_cast<double>(processData.count()), 234'000, 500);
}

TEST(BusTiming, WaitsThirtyPercentOfALongCycle) {
    auto network = plainNetwork(3, 12, 16);
    network.cycle = std::chrono::milliseconds{4};
    EXPECT_EQ(computeTiming(network).receiveDeadline, microseconds(1200));
    EXPECT_EQ(computeTiming(network).sync0AfterSend, microseconds(1000));
}

TEST(BusTiming, WaitsForTheWireInAShortCycle) {
    auto network = plainNetwork(3, 12, 16);
    network.cycle = microseconds{125};
    const auto timing = computeTiming(network);
    EXPECT_EQ(timing.receiveDeadline, timing.roundTrip + microseconds(50 + 50));
    // 1.5 µs to the last device, 50 µs of jitter, 25 µs of copying where the device does not tell.
    EXPECT_EQ(timing.sync0AfterSend, timing.wireTime + nanoseconds(1500) + microseconds(75));
    EXPECT_GT(timing.load, 0.8);
}

TEST(BusTiming, TakesTheCopyTimeTheDeviceTells) {
    auto network = plainNetwork(2, 12, 16);
    network.cycle = microseconds{250};
    auto device = std::make_shared<wire::DeviceDescription>();
    device->objects = {{0x1C32,
                        "sync",
                        {{6,
                          "copy",
                          wire::DataType::Unsigned32,
                          32,
                          true,
                          false,
                          false,
                          wire::PdoMappable::No,
                          {0xA0, 0x86, 0x01, 0x00},
                          {},
                          {}}}}};
    network.slaves[1].device = device;
    const auto timing = computeTiming(network);
    EXPECT_EQ(timing.sync0AfterSend, timing.wireTime + microseconds(1 + 50 + 100));
}

TEST(BusTiming, LoadIsTheNeedByTheCycle) {
    auto network = plainNetwork(10, 12, 16);
    network.cycle = std::chrono::milliseconds{1};
    const auto timing = computeTiming(network);
    const double need = static_cast<double>((timing.roundTrip + microseconds(100)).count());
    EXPECT_DOUBLE_EQ(timing.load, need / 1e6);
}

TEST(BusTiming, ReservesTheLargestMailboxInTheSlice) {
    EXPECT_EQ(fieldbus::acyclicSliceBytes(test::exampleNetwork(2)), 128U + 12);
    EXPECT_EQ(fieldbus::acyclicSliceBytes(test::exampleNetwork(20)), 20U * 18);
    EXPECT_EQ(fieldbus::acyclicSliceBytes(test::exampleNetwork(500)), 1498U);
}

using fieldbus::ethercat::makeLayout;
using fieldbus::ethercat::makePlan;

TEST(LogicalLayout, PutsOutputsOfAllBeforeInputsOfAll) {
    const auto layout = makeLayout(plainNetwork(3, 12, 16));
    ASSERT_EQ(layout.groups.size(), 1U);
    EXPECT_EQ(layout.groups[0].outputBytes, 36);
    EXPECT_EQ(layout.groups[0].inputBytes, 48);
    EXPECT_EQ(layout.slaves[2].outputOffset, 24);
    EXPECT_EQ(layout.slaves[2].inputOffset, 32);
    EXPECT_EQ(layout.groups[0].inputLogical(), layout.groups[0].logical + 36);
}

TEST(LogicalLayout, ExpectsThreeForADeviceWithBothAndLessForOneWithoutInputs) {
    auto network = plainNetwork(3, 2, 2);
    network.slaves[1].inputs.clear();
    network.slaves[2].outputs.clear();
    EXPECT_EQ(makeLayout(network).groups[0].expectedLrw(), 3 + 2 + 1);
}

TEST(LogicalLayout, NeverSplitsADeviceAndNeverOverfillsAFrame) {
    for (std::size_t count : {40U, 53U, 54U, 107U, 200U}) {
        const auto network = plainNetwork(count, 12, 16);
        const auto layout = makeLayout(network);
        const auto plan = makePlan(network, layout);
        std::size_t slaves = 0;
        for (std::size_t g = 0; g < layout.groups.size(); ++g) {
            const auto& group = layout.groups[g];
            EXPECT_EQ(group.firstSlave, slaves);
            slaves += group.slaveCount;
            EXPECT_EQ(group.outputBytes, 12 * group.slaveCount);
            EXPECT_LE(plan.bytesOf(g), 1498U);
        }
        EXPECT_EQ(slaves, count);
        EXPECT_TRUE(layout.fits);
    }
}

TEST(LogicalLayout, TellsADeviceThatExceedsAFrame) {
    EXPECT_FALSE(makeLayout(plainNetwork(1, 800, 700)).fits);
    EXPECT_TRUE(makeLayout(plainNetwork(1, 700, 700)).fits);
}

}  // namespace
