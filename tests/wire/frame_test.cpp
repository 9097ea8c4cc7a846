#include <gmock/gmock.h>

#include <algorithm>
#include <initializer_list>
#include <takt/wire/frame.hpp>
#include <takt/wire/registers.hpp>
#include <vector>

namespace {

using namespace takt::wire;

std::vector<std::uint8_t> bytesOf(const Frame& frame) {
    return {frame.bytes.begin(), frame.bytes.begin() + frame.size};
}

Frame frameOf(std::initializer_list<int> bytes) {
    Frame frame;
    for (const int byte : bytes) frame.bytes[frame.size++] = static_cast<std::uint8_t>(byte);
    return frame;
}

/// Two datagrams: FPRD of 4 bytes at 1001:0x0130 and LRW of 2 bytes at 0x00012345.
Frame goldenFrame() {
    return frameOf(
        {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x02, 0x10, 0x54, 0x41, 0x4B, 0x54, 0x88, 0xA4,
         0x1E, 0x10,                                                  // 30 bytes, type 1
         0x04, 0x2A, 0xE9, 0x03, 0x30, 0x01, 0x04, 0x80, 0x05, 0x00,  // more follow, IRQ 5
         0x08, 0x00, 0x11, 0x22, 0x01, 0x00,                          // data, counter 1
         0x0C, 0x2A, 0x45, 0x23, 0x01, 0x00, 0x02, 0x40, 0x00, 0x00,  // circulating
         0xAB, 0xCD, 0x03, 0x00,                                      //
         0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0});
}

TEST(FrameWriter, WritesGoldenBytes) {
    Frame frame;
    FrameWriter writer{frame};
    const DatagramPlace first = writer.append(Command::Apwr, 0x11, 0xFFFE, reg::StationAddress, 2);
    writer.data(first)[0] = 0xEB;
    writer.data(first)[1] = 0x03;
    const DatagramPlace second = writer.appendLogical(Command::Lrw, 0x11, 0x00010000, 24);
    writer.data(second)[23] = 0x77;
    writer.finish();
    const std::vector<std::uint8_t> expected{
        0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0x10, 0x54, 0x41, 0x4B, 0x54, 0x88, 0xA4,
        0x32, 0x10, 0x02, 0x11, 0xFE, 0xFF, 0x10, 0x00, 0x02, 0x80, 0x00, 0x00, 0xEB, 0x03,
        0x00, 0x00, 0x0C, 0x11, 0x00, 0x00, 0x01, 0x00, 0x18, 0x00, 0x00, 0x00, 0,    0,
        0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,
        0,    0,    0,    0,    0,    0,    0,    0x77, 0x00, 0x00};
    EXPECT_EQ(bytesOf(frame), expected);
}

TEST(FrameWriter, PadsToTheShortestFrameWithZeros) {
    Frame frame;
    frame.bytes.fill(0xEE);
    FrameWriter writer{frame};
    writer.append(Command::Brd, 1, 0, reg::AlStatus, 2);
    writer.finish();
    ASSERT_EQ(frame.size, 60);
    EXPECT_EQ(frame.bytes[14], 14);
    EXPECT_TRUE(std::all_of(frame.bytes.begin() + 26, frame.bytes.begin() + 60,
                            [](std::uint8_t byte) { return byte == 0; }));
}

TEST(FrameWriter, ClearsDataOfAnEarlierFrame) {
    Frame frame;
    frame.bytes.fill(0xEE);
    FrameWriter writer{frame};
    const auto place = writer.append(Command::Brd, 1, 0, reg::AlStatus, 40);
    EXPECT_TRUE(std::all_of(writer.data(place).begin(), writer.data(place).end(),
                            [](std::uint8_t byte) { return byte == 0; }));
}

TEST(FrameWriter, LeavesTheSeenBitOfTheSourceClear) {
    Frame frame;
    frame.bytes.fill(0xFF);
    const FrameWriter writer{frame};
    EXPECT_EQ(frame.bytes[6] & SourceSeenBit, 0);
}

TEST(FrameWriter, HasRoomFor1486BytesInOneDatagram) {
    Frame frame;
    FrameWriter writer{frame};
    EXPECT_TRUE(writer.empty());
    EXPECT_EQ(writer.room(), 1486U);
    writer.append(Command::Lrw, 0, 0, 0, 1486);
    EXPECT_EQ(writer.room(), 0U);
    writer.finish();
    EXPECT_EQ(frame.size, 1514);
}

TEST(FrameWriter, LeavesTwelveBytesLessForEveryDatagram) {
    Frame frame;
    FrameWriter writer{frame};
    writer.append(Command::Nop, 0, 0, 0, 100);
    EXPECT_EQ(writer.room(), 1486U - 112);
}

TEST(FrameWriter, GoesOnBehindADatagramAsIfTheRestHadNeverBeen) {
    Frame whole;
    FrameWriter first{whole};
    const auto kept = first.append(Command::Brd, 5, 0, reg::AlStatus, 2);
    first.append(Command::Fprd, 5, 1001, reg::Type, 100);
    first.finish();
    FrameWriter{whole, kept}.finish();
    Frame fresh;
    FrameWriter alone{fresh};
    alone.append(Command::Brd, 5, 0, reg::AlStatus, 2);
    alone.finish();
    EXPECT_EQ(bytesOf(whole), bytesOf(fresh));

    FrameWriter again{whole, kept};
    again.append(Command::Fpwr, 5, 1002, reg::AlControl, 2);
    again.finish();
    FrameWriter both{fresh};
    both.append(Command::Brd, 5, 0, reg::AlStatus, 2);
    both.append(Command::Fpwr, 5, 1002, reg::AlControl, 2);
    both.finish();
    EXPECT_EQ(bytesOf(whole), bytesOf(fresh));
}

TEST(DatagramCursor, ReadsGoldenBytes) {
    Frame frame = goldenFrame();
    DatagramCursor cursor{frame.view()};
    ASSERT_TRUE(cursor.next());
    const DatagramView first = cursor.datagram();
    EXPECT_EQ(first.rawCommand(), static_cast<std::uint8_t>(Command::Fprd));
    EXPECT_EQ(first.index(), 0x2A);
    EXPECT_EQ(first.adp(), 1001);
    EXPECT_EQ(first.ado(), 0x0130);
    EXPECT_EQ(first.irq(), 5);
    EXPECT_FALSE(first.circulating());
    EXPECT_EQ(first.workingCounter(), 1);
    EXPECT_THAT(first.data(), testing::ElementsAre(0x08, 0x00, 0x11, 0x22));
    ASSERT_TRUE(cursor.next());
    EXPECT_EQ(cursor.datagram().logicalAddress(), 0x00012345U);
    EXPECT_TRUE(cursor.datagram().circulating());
    EXPECT_EQ(cursor.datagram().workingCounter(), 3);
    EXPECT_FALSE(cursor.next());
    EXPECT_FALSE(cursor.malformed());
}

TEST(DatagramCursor, WritesThroughToTheFrame) {
    Frame frame = goldenFrame();
    DatagramCursor cursor{frame.view()};
    ASSERT_TRUE(cursor.next());
    cursor.datagram().setAdp(0x1234);
    cursor.datagram().setCirculating();
    cursor.datagram().orIrq(0x0800);
    cursor.datagram().setWorkingCounter(0x0102);
    cursor.datagram().data()[0] = 0x99;
    EXPECT_EQ(frame.bytes[18], 0x34);
    EXPECT_EQ(frame.bytes[19], 0x12);
    EXPECT_EQ(frame.bytes[23], 0xC0);
    EXPECT_EQ(frame.bytes[24], 0x05);
    EXPECT_EQ(frame.bytes[25], 0x08);
    EXPECT_EQ(frame.bytes[26], 0x99);
    EXPECT_EQ(frame.bytes[30], 0x02);
    EXPECT_EQ(frame.bytes[31], 0x01);
    EXPECT_EQ(frame.bytes[32], 0x0C) << "the next datagram is untouched";
}

/// Walks to the end. \return number of datagrams
int walk(Frame& frame, bool& malformed) {
    DatagramCursor cursor{frame.view()};
    int count = 0;
    while (cursor.next()) ++count;
    malformed = cursor.malformed();
    return count;
}

TEST(DatagramCursor, RefusesAnotherEtherType) {
    Frame frame = goldenFrame();
    frame.bytes[13] = 0xA5;
    bool malformed = false;
    EXPECT_EQ(walk(frame, malformed), 0);
    EXPECT_TRUE(malformed);
}

TEST(DatagramCursor, RefusesAnotherEtherCatType) {
    Frame frame = goldenFrame();
    frame.bytes[15] = 0x40;
    bool malformed = false;
    EXPECT_EQ(walk(frame, malformed), 0);
    EXPECT_TRUE(malformed);
}

TEST(DatagramCursor, StopsWhereADatagramLeavesTheFrame) {
    Frame frame = goldenFrame();
    frame.bytes[32 + 6] = 3;  // second datagram one byte longer than the frame says
    bool malformed = false;
    EXPECT_EQ(walk(frame, malformed), 1);
    EXPECT_TRUE(malformed);
}

TEST(DatagramCursor, NoticesAMissingDatagram) {
    Frame frame = goldenFrame();
    frame.bytes[32 + 7] |= 0x80;  // "more follow" on the last one
    bool malformed = false;
    EXPECT_EQ(walk(frame, malformed), 2);
    EXPECT_TRUE(malformed);
}

TEST(DatagramCursor, NoticesBytesBehindTheLastDatagram) {
    Frame frame = goldenFrame();
    frame.bytes[23] = 0x00;  // no more follow, but they do
    bool malformed = false;
    EXPECT_EQ(walk(frame, malformed), 1);
    EXPECT_TRUE(malformed);
}

TEST(DatagramCursor, NeverReadsBeyondAFrameCutAnywhere) {
    for (std::uint16_t size = 0; size < 46; ++size) {
        Frame frame = goldenFrame();
        frame.size = size;
        bool malformed = false;
        EXPECT_EQ(walk(frame, malformed), 0) << size;
        EXPECT_TRUE(malformed) << size;
    }
}

TEST(DatagramCursor, SurvivesEverySingleByteChanged) {
    // Only that nothing is read outside the frame; the sanitizer is the judge.
    for (std::size_t at = 0; at < 46; ++at) {
        for (const int value : {0x00, 0x7F, 0x80, 0xFF}) {
            Frame frame = goldenFrame();
            frame.bytes[at] = static_cast<std::uint8_t>(value);
            bool malformed = false;
            EXPECT_LE(walk(frame, malformed), 2);
        }
    }
}

TEST(WireBytes, CountPreambleFcsAndGap) {
    EXPECT_EQ(wireBytes(60), 84U);
    EXPECT_EQ(wireBytes(20), 84U);
    EXPECT_EQ(wireBytes(1514), 1538U);
}

}  // namespace
