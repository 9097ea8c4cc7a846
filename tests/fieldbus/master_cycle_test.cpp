#include <algorithm>
#include <takt/wire/byte_io.hpp>

#include "master_fixture.hpp"

namespace {

using namespace takt;
using fieldbus::ethercat::NetworkProblem;
using fieldbus::ethercat::NetworkState;
using test::MasterOnFake;
using testing::HasSubstr;
using testing::IsEmpty;

class MasterCycle : public MasterOnFake {
protected:
    void startUp(std::size_t slaves = 3) {
        build(test::exampleNetwork(slaves));
        ASSERT_THAT(bringUp(), IsEmpty());
        ASSERT_TRUE(toOp()) << name(master->state()) << ": " << master->problem();
    }
    void setInput(std::size_t slave, std::uint8_t value) {
        std::fill_n(segment.devices[slave].memory.begin() + 0x1400, 6, value);
    }
    [[nodiscard]] std::uint8_t input(std::size_t slave) { return master->image(slave).inputs[0]; }
    /// Changes the reply of the next cycle's frame.
    void onNextReply(const std::function<bool(wire::Frame&)>& change) {
        segment.onReply = [change, done = false](wire::Frame& frame, std::uint64_t) mutable {
            if (done) return true;
            done = true;
            return change(frame);
        };
    }
};

TEST_F(MasterCycle, ReachesOpAndMarksEveryDeviceOperational) {
    startUp();
    EXPECT_EQ(master->expectedWorkingCounter(), 9);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(master->image(i).health->operational);
        EXPECT_TRUE(master->image(i).health->inputsFresh);
        EXPECT_EQ(master->image(i).health->lostInRow, 0U);
    }
    EXPECT_EQ(master->counters().workingCounterErrors, 0U);
    EXPECT_EQ(master->counters().framesLost, 0U);
}

TEST_F(MasterCycle, WaitsInSafeOpUntilTheClockIsLocked) {
    build(test::exampleNetwork(2));
    ASSERT_THAT(bringUp(), IsEmpty());
    wake = master->firstSend(clock.now());
    master->requestOp();
    cycle(500);
    EXPECT_EQ(master->state(), NetworkState::SafeOp);
    master->setClockLocked(true);
    cycle(50);
    EXPECT_EQ(master->state(), NetworkState::Op);
}

TEST_F(MasterCycle, WaitsInSafeOpForAClockThatDeviates) {
    build(test::exampleNetwork(2));
    ASSERT_THAT(bringUp(), IsEmpty());
    wire::store32(segment.devices[1].memory, 0x092C, 0x8000'0000U + 1500);
    master->setClockLocked(true);
    wake = master->firstSend(clock.now());
    master->requestOp();
    cycle(500);
    EXPECT_EQ(master->state(), NetworkState::SafeOp);
    cycle(31'000);
    EXPECT_EQ(master->state(), NetworkState::Failed);
    EXPECT_EQ(master->problem(),
              "slave 1 'y': its clock is 1500 ns away from the reference, allowed are 1000 ns");
}

TEST_F(MasterCycle, CarriesOutputsOutAndInputsIn) {
    startUp();
    for (std::size_t i = 0; i < 3; ++i) {
        setInput(i, static_cast<std::uint8_t>(0x30 + i));
        const auto outputs = master->image(i).outputs;
        std::fill(outputs.begin(), outputs.end(), static_cast<std::uint8_t>(0x50 + i));
    }
    cycle(2);  // prepare puts the outputs into the frame, the next exchange sends it
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(input(i), 0x30 + i);
        const auto& memory = segment.devices[i].memory;
        EXPECT_TRUE(std::all_of(memory.begin() + 0x1100, memory.begin() + 0x1106,
                                [i](std::uint8_t byte) { return byte == 0x50 + i; }));
        EXPECT_EQ(memory[0x1106], 0);
    }
}

TEST_F(MasterCycle, KeepsInputsWhenAFrameIsLost) {
    startUp();
    setInput(1, 0x11);
    cycle();
    setInput(1, 0x22);
    segment.lose = {segment.frameNumber, segment.frameNumber + 1};
    cycle(2);
    EXPECT_EQ(input(1), 0x11);
    EXPECT_FALSE(master->image(1).health->inputsFresh);
    EXPECT_EQ(master->image(1).health->lostInRow, 2U);
    EXPECT_EQ(master->counters().framesLost, 2U);
    EXPECT_FALSE(master->dcSample().valid);
    EXPECT_TRUE(master->image(1).health->operational);
    cycle();
    EXPECT_EQ(input(1), 0x22);
    EXPECT_TRUE(master->image(1).health->inputsFresh);
    EXPECT_EQ(master->image(1).health->lostInRow, 0U);
    EXPECT_EQ(master->state(), NetworkState::Op);
}

TEST_F(MasterCycle, DropsALateFrameAndTakesTheRightOne) {
    startUp();
    setInput(0, 0x11);
    wire::Frame late;
    onNextReply([&](wire::Frame& frame) {
        late = frame;
        return false;
    });
    cycle();
    setInput(0, 0x22);
    segment.replies.push_front(late);
    cycle();
    EXPECT_EQ(input(0), 0x22);
    EXPECT_EQ(master->counters().framesLate, 1U);
    EXPECT_EQ(master->counters().framesLost, 1U);
}

TEST_F(MasterCycle, NeverTakesALateFrameForANewerCycle) {
    startUp();
    setInput(0, 0x11);
    cycle();
    setInput(0, 0x22);
    wire::Frame late;
    onNextReply([&](wire::Frame& frame) {
        late = frame;
        return false;
    });
    cycle();
    onNextReply([](wire::Frame&) { return false; });
    segment.replies.push_front(late);
    cycle();
    EXPECT_EQ(input(0), 0x11);
    EXPECT_EQ(master->image(0).health->lostInRow, 2U);
}

TEST_F(MasterCycle, DropsADuplicateFrame) {
    startUp();
    onNextReply([&](wire::Frame& frame) {
        segment.replies.push_back(frame);
        return true;
    });
    cycle(3);
    // The second copy is still in the queue when the next cycle begins: it is late by then.
    EXPECT_EQ(master->counters().framesLate + master->counters().framesDuplicate, 1U);
    EXPECT_EQ(master->counters().framesLost, 0U);
    EXPECT_TRUE(master->image(0).health->inputsFresh);
}

struct Spoil {
    const char* what;
    std::function<void(wire::Frame&)> change;
};

TEST_F(MasterCycle, RejectsEveryKindOfMalformedReply) {
    startUp();
    const Spoil spoils[] = {
        {"EtherCAT length beyond the frame",
         [](wire::Frame& f) { f.bytes[14] = 0xFF, f.bytes[15] = 0x17; }},
        {"EtherCAT length too short", [](wire::Frame& f) { f.bytes[14] = 8, f.bytes[15] = 0x10; }},
        {"EtherCAT type",
         [](wire::Frame& f) {
             f.bytes[15] = static_cast<std::uint8_t>((f.bytes[15] & 0x0F) | 0x40);
         }},
        {"EtherType", [](wire::Frame& f) { f.bytes[12] = 0x08; }},
        {"cut short", [](wire::Frame& f) { f.size = 20; }},
        {"cut inside the Ethernet header", [](wire::Frame& f) { f.size = 9; }},
        {"empty", [](wire::Frame& f) { f.size = 0; }},
        {"command", [](wire::Frame& f) { f.bytes[16] ^= 1; }},
        {"index of the second datagram", [](wire::Frame& f) { f.bytes[37] ^= 0x10; }},
        {"address", [](wire::Frame& f) { f.bytes[20] ^= 1; }},
        {"logical address", [](wire::Frame& f) { f.bytes[38] ^= 1; }},
        {"datagram length", [](wire::Frame& f) { f.bytes[22] ^= 4; }},
        {"no more datagrams", [](wire::Frame& f) { f.bytes[23] &= 0x7F; }},
        {"seen by no device",
         [](wire::Frame& f) { f.bytes[6] &= static_cast<std::uint8_t>(~wire::SourceSeenBit); }},
    };
    for (const Spoil& spoil : spoils) {
        setInput(0, 0x11);
        cycle(2);
        setInput(0, 0x22);
        const auto before = master->counters();
        onNextReply([&](wire::Frame& frame) {
            spoil.change(frame);
            return true;
        });
        cycle();
        const auto after = master->counters();
        EXPECT_EQ(input(0), 0x11) << spoil.what;
        EXPECT_FALSE(master->image(0).health->inputsFresh) << spoil.what;
        EXPECT_EQ(after.framesLost, before.framesLost + 1) << spoil.what;
        EXPECT_EQ(after.framesMalformed + after.framesForeign,
                  before.framesMalformed + before.framesForeign + 1)
            << spoil.what;
    }
    EXPECT_EQ(master->state(), NetworkState::Op);
}

TEST_F(MasterCycle, KeepsInputsWhenTheWorkingCounterIsLow) {
    startUp();
    setInput(0, 0x11);
    cycle();
    setInput(0, 0x22);
    segment.devices[1].refusesOutputs = true;
    cycle();
    EXPECT_EQ(input(0), 0x11);
    EXPECT_FALSE(master->image(0).health->inputsFresh);
    EXPECT_EQ(master->groups()[0].expected, 9);
    EXPECT_EQ(master->groups()[0].lastSeen, 7);
    EXPECT_EQ(master->counters().workingCounterErrors, 1U);
}

TEST_F(MasterCycle, KeepsInputsWhenTheWorkingCounterIsHigh) {
    startUp();
    setInput(0, 0x11);
    cycle();
    setInput(0, 0x22);
    onNextReply([](wire::Frame& frame) {
        const std::size_t lrw = 16 + 20;
        frame.bytes[lrw + 10 + 36] = 10;
        return true;
    });
    cycle();
    EXPECT_EQ(input(0), 0x11);
    EXPECT_EQ(master->groups()[0].lastSeen, 10);
}

TEST_F(MasterCycle, FindsTheDeviceThatFellBackWithinFiveCycles) {
    startUp();
    segment.devices[2].state(0x14, 0x001B);
    cycle(5);
    EXPECT_TRUE(master->image(0).health->operational);
    EXPECT_TRUE(master->image(1).health->operational);
    EXPECT_FALSE(master->image(2).health->operational);
    EXPECT_EQ(master->image(2).health->alStatusCode, 0x001B);
    EXPECT_EQ(master->state(), NetworkState::Op) << "the others go on";
    EXPECT_THAT(master->problem(), HasSubstr("slave 2 'z' left OP in cycle"));
    EXPECT_THAT(master->problem(), HasSubstr("0x001b: SyncManager watchdog"));
}

TEST_F(MasterCycle, LeadsAFallenDeviceUpAgainOnlyWhenAsked) {
    startUp();
    segment.devices[2].state(0x14, 0x001B);
    cycle(50);
    EXPECT_EQ(wire::load16(segment.devices[2].memory, 0x0130), 0x14);
    segment.devices[2].stateRequests.clear();
    master->requestOp();
    cycle(20);
    EXPECT_THAT(segment.devices[2].stateRequests, testing::ElementsAre(0x14, 0x08));
    EXPECT_TRUE(master->image(2).health->operational);
    EXPECT_EQ(master->image(2).health->alStatusCode, 0);
}

TEST_F(MasterCycle, NeedsNoLockedClockWithoutDistributedClocks) {
    auto params = test::exampleNetwork(2);
    for (auto& slave : params.slaves) slave.dc.enabled = false;
    build(params);
    ASSERT_THAT(bringUp(), IsEmpty());
    wake = master->firstSend(clock.now());
    EXPECT_EQ(wake.time_since_epoch() % network.cycle, core::Duration{0});
    master->requestOp();
    cycle(100);
    EXPECT_EQ(master->state(), NetworkState::Op);
    EXPECT_FALSE(master->dcSample().valid);
    EXPECT_EQ(segment.devices[0].memory[0x0981], 0);
}

TEST_F(MasterCycle, CarriesDevicesWithoutProcessData) {
    auto params = test::exampleNetwork(2);
    for (auto& slave : params.slaves) {
        slave.inputs.clear();
        slave.outputs.clear();
    }
    build(params);
    ASSERT_THAT(bringUp(), IsEmpty());
    EXPECT_TRUE(toOp()) << master->problem();
    EXPECT_EQ(master->expectedWorkingCounter(), 0);
    EXPECT_TRUE(master->image(0).inputs.empty());
}

TEST_F(MasterCycle, CountsACycleOnADeadLinkAsLost) {
    startUp();
    segment.down = true;
    cycle(2);
    EXPECT_EQ(master->image(0).health->lostInRow, 2U);
    EXPECT_EQ(master->counters().sendFailures, 2U);
    segment.down = false;
    cycle();
    EXPECT_TRUE(master->image(0).health->inputsFresh);
}

TEST_F(MasterCycle, EndsGoingDownEvenWhenADeviceDiesWhileItsClockIsAwaited) {
    build(test::exampleNetwork(2));
    ASSERT_THAT(bringUp(), IsEmpty());
    wake = master->firstSend(clock.now());
    master->requestOp();
    cycle(20);
    ASSERT_EQ(master->state(), NetworkState::SafeOp);
    segment.devices[1].dead = true;
    cycle(10);
    EXPECT_EQ(master->state(), NetworkState::Failed);
    master->requestInit();
    cycle(300);
    EXPECT_EQ(master->state(), NetworkState::Init);
}

TEST_F(MasterCycle, FindsADeviceThatIsGone) {
    startUp();
    segment.devices[1].dead = true;
    cycle(5);
    EXPECT_TRUE(master->image(0).health->operational);
    EXPECT_FALSE(master->image(1).health->operational);
    EXPECT_TRUE(master->image(2).health->operational);
    EXPECT_THAT(master->problem(), HasSubstr("slave 1 'y' does not answer"));
}

TEST_F(MasterCycle, SaysWhichDeviceRefusesOp) {
    build(test::exampleNetwork(2));
    segment.devices[1].refusals[8] = 0x0019;
    ASSERT_THAT(bringUp(), IsEmpty());
    EXPECT_FALSE(toOp());
    EXPECT_EQ(master->state(), NetworkState::Failed);
    EXPECT_EQ(master->problemRecord().slave, 1);
    EXPECT_THAT(master->problem(), HasSubstr("slave 1 'y' refuses OP and is in SAFEOP, AL status "
                                             "code 0x0019: no valid outputs"));
}

TEST_F(MasterCycle, GoesDownStepByStepAndStopsSync) {
    startUp();
    for (auto& device : segment.devices) device.stateRequests.clear();
    master->requestInit();
    cycle(40);
    EXPECT_EQ(master->state(), NetworkState::Init);
    for (const auto& device : segment.devices) {
        EXPECT_THAT(device.stateRequests, testing::ElementsAre(4, 2, 1));
        EXPECT_EQ(device.memory[0x0981], 0);
        EXPECT_EQ(device.memory[0x060C], 0);
    }
    EXPECT_FALSE(master->image(0).health->operational);
}

TEST_F(MasterCycle, GoesDownPastADeviceThatIsGone) {
    startUp();
    segment.devices[0].dead = true;
    master->requestInit();
    cycle(200);
    EXPECT_EQ(master->state(), NetworkState::Init);
    EXPECT_EQ(wire::load16(segment.devices[2].memory, 0x0130), 1);
}

TEST_F(MasterCycle, CanBeBroughtUpAgain) {
    startUp();
    master->requestInit();
    cycle(40);
    EXPECT_THAT(bringUp(), IsEmpty());
    EXPECT_TRUE(toOp());
}

TEST_F(MasterCycle, FollowsTheReferenceAcrossAPhaseStep) {
    startUp();
    wake += std::chrono::microseconds{70};
    cycle();
    EXPECT_EQ(master->dcSample().phaseError, std::chrono::microseconds{70});
    wake -= std::chrono::microseconds{170};
    cycle();
    EXPECT_EQ(master->dcSample().phaseError, std::chrono::microseconds{-100});
}

TEST_F(MasterCycle, UsesLrdAndLwrWhereADeviceDoesNotKnowLrw) {
    auto params = test::exampleNetwork(2);
    auto device = test::exampleDrive();
    device.lrwSupported = false;
    params.slaves[0].device = std::make_shared<const wire::DeviceDescription>(device);
    build(params);
    ASSERT_THAT(bringUp(), IsEmpty());
    ASSERT_TRUE(toOp());
    std::vector<std::uint8_t> commands;
    segment.onSend = [&](const wire::Frame& sent) {
        wire::Frame frame = sent;
        wire::DatagramCursor cursor{frame.view()};
        while (cursor.next()) commands.push_back(cursor.datagram().rawCommand());
    };
    setInput(1, 0x42);
    cycle(1);
    EXPECT_THAT(commands, testing::ElementsAre(14, 11, 10, 10, 7));
    EXPECT_EQ(input(1), 0x42);
    EXPECT_EQ(master->expectedWorkingCounter(), 4);
}

TEST_F(MasterCycle, SplitsALargeNetworkOverFramesWithoutSplittingADevice) {
    startUp(150);  // 1800 bytes of process data
    EXPECT_EQ(master->groups().size(), 2U);
    for (std::size_t i = 0; i < 150; ++i) setInput(i, static_cast<std::uint8_t>(i));
    cycle();
    for (std::size_t i = 0; i < 150; ++i) EXPECT_EQ(input(i), static_cast<std::uint8_t>(i));
    EXPECT_EQ(master->expectedWorkingCounter(), 450);
}

}  // namespace
