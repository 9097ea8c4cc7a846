#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "devices.hpp"
#include "sync_managers.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using wire::Command;

class TwinSegment : public ::testing::Test {
protected:
    TwinParams params = lineOf(3, "generic");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};

    Bytes raw(const Bytes& sent) {
        wire::Frame frame;
        std::copy(sent.begin(), sent.end(), frame.bytes.begin());
        frame.size = static_cast<std::uint16_t>(sent.size());
        twin.link().send({&frame, 1});
        wire::Frame slot;
        const auto deadline = twin.clock().now() + milliseconds{1};
        if (twin.link().receive({&slot, 1}, deadline) == 0) return {};
        return {slot.bytes.begin(), slot.bytes.begin() + slot.size};
    }
};

Bytes padded(Bytes frame) {
    frame.resize(std::max<std::size_t>(frame.size(), 60), 0);
    return frame;
}

const Bytes header{0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00,
                   0x10, 0x54, 0x41, 0x4B, 0x54, 0x88, 0xA4};

Bytes frameOf(const Bytes& datagrams) {
    Bytes frame = header;
    frame.push_back(static_cast<std::uint8_t>(datagrams.size()));
    frame.push_back(0x10);
    frame.insert(frame.end(), datagrams.begin(), datagrams.end());
    return padded(frame);
}

/// What comes back: the first controller has marked the source address.
Bytes marked(const Bytes& datagrams) {
    Bytes frame = frameOf(datagrams);
    frame[6] = 0x02;
    return frame;
}

TEST_F(TwinSegment, AnswersABroadcastReadByteForByte) {
    const Bytes sent = frameOf(
        {0x07, 0x11, 0x00, 0x00, 0x30, 0x01, 0x02, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00});
    // Position counted to 3, AL status INIT ORed in, working counter 3.
    const Bytes back = marked(
        {0x07, 0x11, 0x03, 0x00, 0x30, 0x01, 0x02, 0x00, 0x00, 0x00, 0x01, 0x00, 0x03, 0x00});
    EXPECT_EQ(raw(sent), back);
}

TEST_F(TwinSegment, AnswersAPositionReadOnlyAtItsPlaceByteForByte) {
    // Second device: 0xFFFF counts to 2 over three controllers; FMMUs 3, SyncManagers 4, 8 KiB, two
    // MII ports.
    const Bytes sent = frameOf(
        {0x01, 0x01, 0xFF, 0xFF, 0x04, 0x00, 0x04, 0x00, 0x00, 0x00, 0, 0, 0, 0, 0x00, 0x00});
    const Bytes back = marked(
        {0x01, 0x01, 0x02, 0x00, 0x04, 0x00, 0x04, 0x00, 0x00, 0x00, 3, 4, 8, 0x0F, 0x01, 0x00});
    EXPECT_EQ(raw(sent), back);
}

TEST_F(TwinSegment, PassesUnknownAndIdleCommandsUnchanged) {
    for (const std::uint8_t command : {std::uint8_t{0}, std::uint8_t{15}, std::uint8_t{0xFF}}) {
        const Bytes datagram{command, 0x01, 0x05, 0x00, 0x30, 0x01, 0x02,
                             0x00,    0x00, 0x00, 0xAB, 0xCD, 0x07, 0x00};
        EXPECT_EQ(raw(frameOf(datagram)), marked(datagram)) << int{command};
    }
}

TEST_F(TwinSegment, DestroysWhatIsNoSoundEtherCatFrameAndCountsIt) {
    Bytes foreign = padded(header);
    foreign[12] = 0x08;
    foreign[13] = 0x00;
    EXPECT_TRUE(raw(foreign).empty());
    Bytes tooLong = frameOf({0x07, 0x11, 0, 0, 0x30, 0x01, 0x40, 0x00, 0, 0, 0, 0, 0, 0});
    EXPECT_TRUE(raw(tooLong).empty());
    EXPECT_EQ(master.send(Command::Aprd, 0, 0x030C, {0}).data[0], 2);
    EXPECT_EQ(master.send(Command::Apwr, 0, 0x030C, {1}).wkc, 1);
    EXPECT_EQ(master.send(Command::Aprd, 0, 0x030C, {0}).data[0], 0);
}

struct CounterRule {
    Command command;
    std::uint16_t adp;
    std::uint16_t wkc;
    std::uint16_t adpBack;
};

TEST_F(TwinSegment, CountsEveryCommandAsTheStandardSays) {
    master.addressAll();
    const CounterRule rules[] = {
        {Command::Aprd, 0xFFFF, 1, 2},  {Command::Apwr, 0xFFFF, 1, 2},
        {Command::Aprw, 0xFFFF, 3, 2},  {Command::Aprd, 0xFFFD, 0, 0},
        {Command::Fprd, 1002, 1, 1002}, {Command::Fpwr, 1002, 1, 1002},
        {Command::Fprw, 1002, 3, 1002}, {Command::Fprd, 999, 0, 999},
        {Command::Brd, 0, 3, 3},        {Command::Bwr, 0, 3, 3},
        {Command::Brw, 0, 9, 3},        {Command::Armw, 0, 3, 3},
        {Command::Frmw, 1001, 3, 1001}, {Command::Frmw, 999, 3, 999},
    };
    for (const CounterRule& rule : rules) {
        const Reply reply = master.send(rule.command, rule.adp, 0x0F80, Bytes(4, 0));
        EXPECT_EQ(reply.wkc, rule.wkc) << int(rule.command) << " to " << rule.adp;
        EXPECT_EQ(reply.adp, rule.adpBack) << int(rule.command) << " to " << rule.adp;
    }
}

TEST_F(TwinSegment, ExchangesOldForNewInReadWriteCommands) {
    master.addressAll();
    master.write(0, 0x0F80, {1, 2});
    EXPECT_EQ(master.send(Command::Fprw, 1001, 0x0F80, {8, 9}).data, (Bytes{1, 2}));
    EXPECT_EQ(master.read(0, 0x0F80, 2).data, (Bytes{8, 9}));
}

TEST_F(TwinSegment, ReadsFromOneAndWritesToTheOthersInMultipleWrites) {
    master.addressAll();
    master.write(1, 0x0F80, {0x55});
    EXPECT_EQ(master.send(Command::Frmw, 1002, 0x0F80, {0x11}).data, Bytes{0x55});
    EXPECT_EQ(master.read(0, 0x0F80, 1).data, Bytes{0x11});  // before the reference: what was sent
    EXPECT_EQ(master.read(2, 0x0F80, 1).data, Bytes{0x55});
}

TEST_F(TwinSegment, OrsBroadcastReads) {
    master.addressAll();
    for (std::size_t i = 0; i < 3; ++i)
        master.write(i, 0x0F80, {static_cast<std::uint8_t>(1 << i)});
    EXPECT_EQ(master.send(Command::Brd, 0, 0x0F80, {0x40}).data, Bytes{0x47});
}

TEST_F(TwinSegment, KeepsReadOnlyRegisters) {
    master.addressAll();
    constexpr std::array<std::uint16_t, 7> addresses{0x0000, 0x0004, 0x0008, 0x0110,
                                                     0x0130, 0x0134, 0x0982};
    for (const std::uint16_t address : addresses) {
        const Bytes before = master.read(0, address, 1).data;
        EXPECT_EQ(master.write(0, address, {static_cast<std::uint8_t>(~before[0])}).wkc, 1);
        EXPECT_EQ(master.read(0, address, 1).data, before) << std::hex << address;
    }
}

TEST_F(TwinSegment, DoesNotCountWhatLiesBeyondItsMemory) {
    master.addressAll();
    EXPECT_EQ(master.read(0, 0x2FFF, 1).wkc, 1);
    EXPECT_EQ(master.read(0, 0x3000, 1).wkc, 0);
    EXPECT_EQ(master.read(0, 0x2FFF, 2).wkc, 0);
}

TEST_F(TwinSegment, TakesANewAddressOnlyAtTheEndOfTheFrame) {
    wire::Frame frame;
    wire::FrameWriter writer{frame};
    const auto set = writer.append(Command::Apwr, 1, 0, 0x0010, 2);
    writer.data(set)[0] = 0x77;
    const auto use = writer.append(Command::Fprd, 2, 0x0077, 0x0010, 2);
    writer.finish();
    const Bytes back = raw({frame.bytes.begin(), frame.bytes.begin() + frame.size});
    EXPECT_EQ(back[set.dataOffset() + 2], 1);
    EXPECT_EQ(back[use.dataOffset() + 2], 0);
    EXPECT_EQ(master.send(Command::Fprd, 0x0077, 0x0010, {0, 0}).wkc, 1);
}

TEST_F(TwinSegment, ShowsOpenPortsWhereNeighboursAre) {
    master.addressAll();
    const auto open = [&](std::size_t device, unsigned port) {
        return ((number(master.read(device, 0x0110, 2).data) >> (8 + 2 * port)) & 3) == 2;
    };
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(open(i, 0));
        EXPECT_EQ(open(i, 1), i < 2);
        EXPECT_FALSE(open(i, 2));
        EXPECT_FALSE(open(i, 3));
    }
}

TEST_F(TwinSegment, TellsAnAlStatusChangeInTheIrqFieldUntilItIsRead) {
    master.addressAll();
    master.write(1, 0x0200, le16(0x0008));
    master.setMailboxes(1);
    EXPECT_EQ(master.read(0, 0x0000, 1).irq, 0);
    master.write(1, 0x0120, le16(2));
    master.sleep(milliseconds{5});
    EXPECT_EQ(master.read(0, 0x0000, 1).irq, 0x0008);
    master.read(1, 0x0130, 2);
    EXPECT_EQ(master.read(0, 0x0000, 1).irq, 0);
}

TEST_F(TwinSegment, LocksAlControlUntilTheDeviceHasReadIt) {
    master.addressAll();
    master.setMailboxes(0);
    master.write(0, 0x0120, le16(2));
    master.write(0, 0x0120, le16(8));  // ignored
    EXPECT_EQ(number(master.read(0, 0x0120, 2).data), 2U);
    master.sleep(milliseconds{5});
    EXPECT_EQ(number(master.read(0, 0x0130, 2).data), 2U);
}

TEST_F(TwinSegment, RepliesAfterWireTimeAndAllForwardingDelays) {
    wire::Frame frame;
    wire::FrameWriter writer{frame};
    writer.append(Command::Brd, 0, 0, 0x0000, 1);
    writer.finish();
    const auto start = twin.trueTime();
    twin.link().send({&frame, 1});
    wire::Frame slot;
    ASSERT_EQ(twin.link().receive({&slot, 1}, twin.clock().now() + milliseconds{1}), 1U);
    // 72 bytes with preamble and check sequence; cables 40, 75, 110 both ways; 600 ns five times.
    EXPECT_EQ((twin.trueTime() - start).count(), 72 * 80 + 2 * (40 + 75 + 110) + 5 * 600);
    EXPECT_EQ(slot.stamp, twin.clock().now());
}

TEST_F(TwinSegment, WaitsForTheDeadlineWhenNothingComes) {
    wire::Frame slot;
    const auto deadline = twin.clock().now() + microseconds{123};
    EXPECT_EQ(twin.link().receive({&slot, 1}, deadline), 0U);
    EXPECT_EQ(twin.clock().now(), deadline);
}

TEST_F(TwinSegment, LosesFramesWhileTheCableIsCut) {
    twin.cutCable(true);
    EXPECT_FALSE(master.send(Command::Brd, 0, 0, {0}).arrived);
    twin.cutCable(false);
    EXPECT_EQ(master.send(Command::Brd, 0, 0, {0}).wkc, 3);
}

TEST_F(TwinSegment, MapsBytesOfALogicalDatagramThatOnlyPartlyOverlaps) {
    master.addressAll();
    // Four bytes at logical 0x1000 to user RAM, read and write.
    const Bytes fmmu{0x00, 0x10, 0, 0, 4, 0, 0, 7, 0x80, 0x0F, 0, 3, 1, 0, 0, 0};
    master.write(1, 0x0600, fmmu);
    master.write(1, 0x0F80, {1, 2, 3, 4});
    const Reply read = master.logical(Command::Lrd, 0x0FFE, {0xA0, 0xA1, 0xA2, 0xA3, 0xA4});
    EXPECT_EQ(read.wkc, 1);
    EXPECT_EQ(read.data, (Bytes{0xA0, 0xA1, 1, 2, 3}));
    EXPECT_EQ(master.logical(Command::Lwr, 0x1002, {9, 8, 7}).wkc, 1);
    EXPECT_EQ(master.read(1, 0x0F80, 4).data, (Bytes{1, 2, 9, 8}));
    const Reply both = master.logical(Command::Lrw, 0x1000, {5, 6});
    EXPECT_EQ(both.wkc, 3);
    EXPECT_EQ(both.data, (Bytes{1, 2}));
    EXPECT_EQ(master.logical(Command::Lrd, 0x1004, {0}).wkc, 0);
}

TEST_F(TwinSegment, MapsSingleBitsAndLeavesTheOthers) {
    master.addressAll();
    // Bit 0 of 0x0F80 to bit 5 of logical 0x9000.
    const Bytes fmmu{0x00, 0x90, 0, 0, 1, 0, 5, 5, 0x80, 0x0F, 0, 1, 1, 0, 0, 0};
    master.write(2, 0x0620, fmmu);
    master.write(2, 0x0F80, {0x01});
    EXPECT_EQ(master.logical(Command::Lrd, 0x9000, {0x82}).data, Bytes{0xA2});
    master.write(2, 0x0F80, {0xFE});
    const Reply reply = master.logical(Command::Lrd, 0x9000, {0xFF});
    EXPECT_EQ(reply.data, Bytes{0xDF});
    EXPECT_EQ(reply.wkc, 1);
}

// SyncManagers

TEST_F(TwinSegment, GuardsAMailboxByItsFirstAndLastByte) {
    master.addressAll();
    master.setMailboxes(0);
    EXPECT_EQ(master.write(0, 0x1004, {1}).wkc, 0);  // not opened
    EXPECT_EQ(master.read(0, 0x1000, 1).wkc, 0);     // wrong direction
    EXPECT_EQ(master.read(0, 0x1080, 128).wkc, 0);   // empty
    EXPECT_EQ(master.write(0, 0x1000, Bytes(10, 1)).wkc, 1);
    EXPECT_EQ(master.read(0, 0x0805, 1).data[0] & 0x08, 0);
    EXPECT_EQ(master.write(0, 0x107F, {0}).wkc, 1);  // the last byte closes it
    EXPECT_EQ(master.read(0, 0x0805, 1).data[0] & 0x09, 0x09);
    EXPECT_EQ(master.write(0, 0x1000, Bytes(128, 0)).wkc, 0);  // full
}

TEST_F(TwinSegment, KeepsSyncManagerSettingsWhileEnabled) {
    master.addressAll();
    master.setMailboxes(0);
    master.write(0, 0x0800, {0x00, 0x20});
    EXPECT_EQ(number(master.read(0, 0x0800, 2).data), 0x1000U);
    master.write(0, 0x0806, {0});
    master.write(0, 0x0800, {0x00, 0x20});
    EXPECT_EQ(number(master.read(0, 0x0800, 2).data), 0x2000U);
}

TEST_F(TwinSegment, IsPlainMemoryWhereNoSyncManagerIsOn) {
    master.addressAll();
    EXPECT_EQ(master.write(0, 0x1000, {1, 2, 3}).wkc, 1);
    EXPECT_EQ(master.read(0, 0x1000, 3).data, (Bytes{1, 2, 3}));
}

TEST(TwinSyncManagers, HandOverTheNewestCompleteBuffer) {
    Bytes registers(0x1000, 0);
    Bytes ram(0x1000, 0);
    SyncManagers managers{registers, ram, 4};
    const Bytes outputs{0x00, 0x11, 0x04, 0x00, 0x64, 0x00, 0x01, 0x00};
    for (std::size_t i = 0; i < 8; ++i) {
        managers.writeRegister(static_cast<std::uint16_t>(0x0810 + i), outputs[i]);
    }
    EXPECT_TRUE(managers.newest(2).empty());
    EXPECT_TRUE(managers.write(0x1100, Bytes{1, 2}));  // not complete
    EXPECT_EQ(managers.commit().written, 0);
    EXPECT_TRUE(managers.newest(2).empty());
    EXPECT_TRUE(managers.write(0x1102, Bytes{3, 4}));
    EXPECT_TRUE(managers.newest(2).empty());  // not before the frame's end
    const SyncManagerEvents events = managers.commit();
    EXPECT_EQ(events.written, 4);
    EXPECT_TRUE(events.watchdog);
    const auto first = managers.newest(2);
    EXPECT_EQ(Bytes(first.begin(), first.end()), (Bytes{1, 2, 3, 4}));
    EXPECT_TRUE(managers.write(0x1100, Bytes{5, 6, 7, 8}));
    EXPECT_EQ(managers.newest(2)[0], 1);
    managers.commit();
    EXPECT_EQ(managers.newest(2)[0], 5);
}

TEST(TwinSyncManagers, RefuseToReadABufferThatWasNeverWritten) {
    Bytes registers(0x1000, 0);
    Bytes ram(0x1000, 0);
    SyncManagers managers{registers, ram, 4};
    const Bytes inputs{0x00, 0x14, 0x02, 0x00, 0x20, 0x00, 0x01, 0x00};
    for (std::size_t i = 0; i < 8; ++i) {
        managers.writeRegister(static_cast<std::uint16_t>(0x0818 + i), inputs[i]);
    }
    Bytes data(2, 0);
    EXPECT_FALSE(managers.read(0x1400, data, false));
    EXPECT_EQ(registers[0x081D] & 0x30, 0x30);
    managers.nextBuffer(3)[0] = 0x42;
    managers.publish(3);
    EXPECT_TRUE(managers.read(0x1400, data, false));
    EXPECT_EQ(data[0], 0x42);
}

// EEPROM

TEST_F(TwinSegment, ReadsTheEepromAfterBeingBusy) {
    master.addressAll();
    master.write(1, 0x0502, {0x00, 0x01, 0x08, 0x00, 0x00, 0x00});
    EXPECT_EQ(number(master.read(1, 0x0502, 2).data) & 0x8700, 0x8100U);
    master.sleep(milliseconds{1});
    EXPECT_EQ(number(master.read(1, 0x0502, 2).data) & 0xE740, 0x0040U);
    EXPECT_EQ(number(master.read(1, 0x0508, 8).data), 0x000000420000AFFEU);
}

TEST_F(TwinSegment, KeepsTheMasterOffAnEepromThatBelongsToTheDevice) {
    master.addressAll();
    master.write(1, 0x0500, {0x01});
    master.write(1, 0x0502, {0x00, 0x01, 0x08, 0x00, 0x00, 0x00});
    EXPECT_EQ(number(master.read(1, 0x0502, 2).data) & 0x8000, 0U);
    master.write(1, 0x0500, {0x00});
    EXPECT_EQ(number(master.readSii(1, 12)), 0x1234567800010002U);
}

TEST_F(TwinSegment, RefusesToWriteTheEepromWithoutEnableBit) {
    master.addressAll();
    master.write(0, 0x0502, {0x00, 0x02, 0x04, 0x00, 0x00, 0x00});
    EXPECT_EQ(number(master.read(0, 0x0502, 2).data) & 0x4000, 0x4000U);
    master.write(0, 0x0502, {0x00, 0x00});
    EXPECT_EQ(number(master.read(0, 0x0502, 2).data) & 0x4000, 0U);
}

}  // namespace
}  // namespace takt::twin::test
