#include "frame_set.hpp"

#include <gmock/gmock.h>

#include <deque>
#include <numeric>
#include <takt/wire/registers.hpp>
#include <vector>

#include "acyclic.hpp"

namespace {

using namespace takt;
using fieldbus::ethercat::AcyclicMachine;
using fieldbus::ethercat::AcyclicSlice;
using fieldbus::ethercat::FrameSet;
using fieldbus::ethercat::Reply;
using fieldbus::ethercat::Request;
using fieldbus::ethercat::WorkSet;
using wire::Command;

/// Keeps what was sent; hands out what the test puts there.
class ScriptedLink final : public wire::Link {
public:
    wire::LinkStatus send(std::span<wire::Frame> frames) noexcept override {
        sent.insert(sent.end(), frames.begin(), frames.end());
        return status;
    }
    std::size_t receive(std::span<wire::Frame> slots, core::HostTime) noexcept override {
        ++receiveCalls;
        std::size_t got = 0;
        for (; got < slots.size() && !replies.empty(); ++got) {
            slots[got] = replies.front();
            replies.pop_front();
        }
        return got;
    }
    /// The frame as one device would return it.
    static wire::Frame returned(wire::Frame frame, std::uint16_t counter) {
        frame.bytes[6] |= wire::SourceSeenBit;
        wire::DatagramCursor cursor{frame.view()};
        while (cursor.next()) cursor.datagram().setWorkingCounter(counter);
        return frame;
    }

    std::vector<wire::Frame> sent;
    std::deque<wire::Frame> replies;
    wire::LinkStatus status{wire::LinkStatus::Ok};
    int receiveCalls{0};
};

class TwoFrames : public testing::Test {
protected:
    void SetUp() override {
        frames.begin();
        frames.openFrame();
        first = frames.append(Command::Brd, 0, wire::reg::AlStatus, 2);
        frames.openFrame();
        second = frames.append(Command::Fprd, 1001, wire::reg::Type, 10);
        third = frames.append(Command::Fprd, 1002, wire::reg::Type, 10);
        frames.finish();
        ASSERT_EQ(frames.send(link), wire::LinkStatus::Ok);
    }

    ScriptedLink link;
    FrameSet frames{3, 10};
    fieldbus::ethercat::DatagramId first{}, second{}, third{};
};

TEST_F(TwoFrames, AreSentWithOneCallAndDifferentIndices) {
    ASSERT_EQ(link.sent.size(), 2U);
    EXPECT_NE(link.sent[0].bytes[17], link.sent[1].bytes[17]);
    EXPECT_EQ(link.sent[1].bytes[17], link.sent[1].bytes[17 + 22]);
}

TEST_F(TwoFrames, GoldenBytesOfARequest) {
    const std::vector<std::uint8_t> expected{
        0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0x10, 0x54, 0x41,
        0x4B, 0x54, 0x88, 0xA4, 0x0E, 0x10,                       // 14 bytes of datagrams, type 1
        0x07, 0x00, 0x00, 0x00, 0x30, 0x01, 0x02, 0x00, 0,    0,  // BRD, index 0, 0x0130, 2 bytes
        0x00, 0x00, 0x00, 0x00};
    ASSERT_EQ(link.sent[0].size, 60);
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), link.sent[0].bytes.begin()));
    EXPECT_EQ(std::accumulate(link.sent[0].bytes.begin() + 30, link.sent[0].bytes.begin() + 60, 0),
              0);
}

TEST_F(TwoFrames, MayComeBackInAnyOrder) {
    link.replies = {ScriptedLink::returned(link.sent[1], 1),
                    ScriptedLink::returned(link.sent[0], 2)};
    frames.receive(link, {});
    EXPECT_EQ(frames.reply(first).workingCounter, 2);
    EXPECT_EQ(frames.reply(second).workingCounter, 1);
    EXPECT_EQ(frames.reply(third).data.size(), 10U);
    EXPECT_EQ(link.receiveCalls, 1);
    EXPECT_EQ(frames.counters().lost, 0U);
}

TEST_F(TwoFrames, AreJudgedOneByOne) {
    link.replies = {ScriptedLink::returned(link.sent[1], 1)};
    frames.receive(link, {});
    EXPECT_FALSE(frames.reply(first).arrived);
    EXPECT_TRUE(frames.reply(second).arrived);
    EXPECT_EQ(frames.counters().lost, 1U);
}

TEST_F(TwoFrames, DuplicatesDoNotTakeThePlaceOfTheOther) {
    const auto good = ScriptedLink::returned(link.sent[0], 1);
    link.replies = {good, good, ScriptedLink::returned(link.sent[1], 1)};
    frames.receive(link, {});
    EXPECT_TRUE(frames.reply(first).arrived);
    EXPECT_TRUE(frames.reply(second).arrived);
    EXPECT_EQ(frames.counters().duplicate, 1U);
    EXPECT_EQ(frames.counters().lost, 0U);
}

TEST_F(TwoFrames, DoNotWaitForeverInAFloodOfStrays) {
    auto stray = ScriptedLink::returned(link.sent[0], 1);
    stray.bytes[17] = 200;
    for (int i = 0; i < 1000; ++i) link.replies.push_back(stray);
    frames.receive(link, {});
    EXPECT_LE(link.receiveCalls, 10);
    EXPECT_EQ(frames.counters().lost, 2U);
}

TEST_F(TwoFrames, OfTheNextExchangeHaveNewIndices) {
    const auto old = ScriptedLink::returned(link.sent[0], 1);
    frames.begin();
    frames.openFrame();
    const auto id = frames.append(Command::Brd, 0, wire::reg::AlStatus, 2);
    frames.finish();
    frames.send(link);
    link.replies = {old};
    frames.receive(link, {});
    EXPECT_FALSE(frames.reply(id).arrived);
    EXPECT_EQ(frames.counters().late, 1U);
}

TEST_F(TwoFrames, TakePositionsCountedUpByTheDevicesForGranted) {
    auto back = ScriptedLink::returned(link.sent[0], 3);
    back.bytes[18] = 3;  // three devices passed: a broadcast comes back with position 3
    link.replies = {back, ScriptedLink::returned(link.sent[1], 1)};
    frames.receive(link, {});
    EXPECT_TRUE(frames.reply(first).arrived);
}

TEST(KeptFrames, AreSentAgainWithNewIndicesAndTheDataLeftInThem) {
    ScriptedLink link;
    FrameSet frames{3, 10};
    frames.begin();
    frames.openFrame();
    const auto kept = frames.append(Command::Fpwr, 1001, 0x0F80, 4);
    frames.keep();
    frames.data(kept)[0] = 0x5A;
    for (int i = 0; i < 2; ++i) {
        frames.repeat();
        frames.finish();
        frames.send(link);
    }
    ASSERT_EQ(link.sent.size(), 2U);
    EXPECT_EQ(link.sent[0].bytes[26], 0x5A);
    EXPECT_EQ(static_cast<std::uint8_t>(link.sent[0].bytes[17] + 1), link.sent[1].bytes[17]);
    link.sent[0].bytes[17] = link.sent[1].bytes[17];
    EXPECT_EQ(link.sent[0].bytes, link.sent[1].bytes);
}

TEST(KeptFrames, ForgetWhatWasAppendedForOneExchange) {
    ScriptedLink link;
    FrameSet frames{2, 10};
    frames.begin();
    frames.openFrame();
    const auto kept = frames.append(Command::Brd, 0, 0x0130, 2);
    frames.keep();
    frames.repeat();
    frames.finish();
    frames.send(link);
    frames.repeat();
    const auto extra = frames.append(Command::Fprd, 1001, 0x0000, 60);
    frames.openFrame();
    const auto other = frames.append(Command::Fprd, 1002, 0x0000, 10);
    frames.finish();
    frames.send(link);
    link.replies = {ScriptedLink::returned(link.sent[1], 1),
                    ScriptedLink::returned(link.sent[2], 1)};
    frames.receive(link, {});
    for (const auto id : {kept, extra, other}) EXPECT_TRUE(frames.reply(id).served());
    EXPECT_EQ(frames.reply(extra).data.size(), 60U);
    frames.repeat();
    frames.finish();
    frames.send(link);
    ASSERT_EQ(link.sent.size(), 4U);
    EXPECT_FALSE(frames.reply(kept).arrived);
    link.sent[0].bytes[17] = link.sent[3].bytes[17] = 0;
    EXPECT_TRUE(std::equal(link.sent[0].view().begin(), link.sent[0].view().end(),
                           link.sent[3].view().begin(), link.sent[3].view().end()));
}

TEST(FrameSet, IsFullWhenFramesOrDatagramsRunOut) {
    FrameSet frames{2, 3};
    frames.begin();
    EXPECT_EQ(frames.room(), 0U);
    EXPECT_TRUE(frames.openFrame());
    EXPECT_EQ(frames.room(), 1486U);
    for (int i = 0; i < 3; ++i) frames.append(Command::Nop, 0, 0, 1);
    EXPECT_EQ(frames.room(), 0U);
    EXPECT_TRUE(frames.openFrame());
    EXPECT_FALSE(frames.openFrame());
}

TEST(WorkSet, FindsMembersInOrder) {
    WorkSet set{200};
    EXPECT_EQ(set.firstFrom(0), WorkSet::none());
    for (const std::size_t i : {3U, 63U, 64U, 199U}) set.set(i);
    EXPECT_EQ(set.firstFrom(0), 3U);
    EXPECT_EQ(set.firstFrom(4), 63U);
    EXPECT_EQ(set.firstFrom(64), 64U);
    EXPECT_EQ(set.firstFrom(65), 199U);
    EXPECT_EQ(set.firstFrom(200), WorkSet::none());
    set.clear(199);
    EXPECT_EQ(set.firstFrom(65), WorkSet::none());
}

class Asker final : public AcyclicMachine {
public:
    bool next(core::HostTime, Request& request) noexcept override {
        request = {Command::Fprd, 1001, 0x0130, length, {}};
        return true;
    }
    void take(core::HostTime, const Reply&) noexcept override { ++served; }
    [[nodiscard]] bool busy() const noexcept override { return true; }
    std::uint16_t length{100};
    int served{0};
};

TEST(AcyclicSlice, ServesEveryMachineInTurnWithinItsBudget) {
    std::vector<Asker> askers(10);
    std::vector<AcyclicMachine*> machines;
    for (auto& asker : askers) machines.push_back(&asker);
    AcyclicSlice slice{10};
    for (std::size_t i = 0; i < 10; ++i) slice.work().set(i);
    FrameSet frames{2, 20};
    for (int round = 0; round < 10; ++round) {
        frames.begin();
        frames.openFrame();
        slice.fill(frames, machines, 3 * 112, {});
        EXPECT_EQ(slice.waiting(), 3U);
        frames.finish();
        slice.deliver(frames, machines, {});
    }
    for (const auto& asker : askers) EXPECT_EQ(asker.served, 3);
}

TEST(AcyclicSlice, OpensNoFrameForADatagramThatCannotBeAdded) {
    Asker asker;
    std::vector<AcyclicMachine*> machines{&asker};
    AcyclicSlice slice{1};
    slice.work().set(0);
    FrameSet frames{2, 1};
    frames.begin();
    frames.openFrame();
    frames.append(Command::Nop, 0, 0, 1);
    slice.fill(frames, machines, 1000, {});
    EXPECT_EQ(slice.waiting(), 0U);
    EXPECT_EQ(frames.frameCount(), 1U);
}

TEST(AcyclicSlice, OpensOneFrameMoreWhenTheLastOneIsFull) {
    Asker asker;
    std::vector<AcyclicMachine*> machines{&asker};
    AcyclicSlice slice{1};
    slice.work().set(0);
    FrameSet frames{2, 20};
    frames.begin();
    frames.openFrame();
    frames.append(Command::Nop, 0, 0, 1450);
    slice.fill(frames, machines, 1000, {});
    EXPECT_EQ(slice.waiting(), 1U);
    EXPECT_EQ(frames.frameCount(), 2U);
}

}  // namespace
