#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <takt/fieldbus/ethercat/segment_tool.hpp>
#include <takt/twin/twin.hpp>
#include <takt/wire/mailbox.hpp>
#include <vector>

#include "../twin/devices.hpp"

namespace {

using namespace takt;
using core::ObjectState;
using fieldbus::ethercat::SegmentTool;
using Bytes = std::vector<std::uint8_t>;

/// The mailbox of the drive holds 128 bytes: 122 behind its header, of which the first message of a
/// download has 112 for data and a segment 119. Lengths on both sides of each change.
constexpr std::array Lengths{1U,   4U,   5U,   8U,   9U,   111U, 112U, 113U, 118U,
                             119U, 120U, 231U, 232U, 237U, 238U, 239U, 350U, 1000U};
constexpr std::uint16_t FirstIndex = 0x2F00;

std::shared_ptr<wire::DeviceDescription> deviceWithLongObjects() {
    auto device = twin::test::servoDescription("cd300e");
    for (std::size_t i = 0; i < Lengths.size(); ++i) {
        wire::ObjectEntryDescription entry;
        entry.type = wire::DataType::OctetString;
        entry.bits = static_cast<std::uint16_t>(8 * Lengths[i]);
        entry.writable = true;
        entry.defaultValue.resize(Lengths[i]);
        device->objects.push_back({static_cast<std::uint16_t>(FirstIndex + i), "octets", {entry}});
    }
    return device;
}

/// Loses one frame on its way out, or on its way back.
class LosingLink final : public wire::Link {
public:
    explicit LosingLink(wire::Link& link) : link_{link} {}
    void loseFrame(std::size_t number, bool onItsWayBack) {
        lost_ = sent_ + number;
        back_ = onItsWayBack;
    }

    wire::LinkStatus send(std::span<wire::Frame> frames) noexcept override {
        const bool losing = sent_++ == lost_;
        drop_ = losing && back_;
        return losing && !back_ ? wire::LinkStatus::Ok : link_.send(frames);
    }
    std::size_t receive(std::span<wire::Frame> slots, core::HostTime deadline) noexcept override {
        const std::size_t count = link_.receive(slots, deadline);
        return drop_ ? 0 : count;
    }
    [[nodiscard]] std::size_t sent() const { return sent_; }

private:
    wire::Link& link_;
    std::size_t sent_{0};
    std::size_t lost_{SIZE_MAX};
    bool back_{false};
    bool drop_{false};
};

class LongObjects : public testing::Test {
protected:
    LongObjects()
        : twin_{twin::test::lineOf(1, "cd300e"),
                {deviceWithLongObjects()},
                std::chrono::milliseconds{1}},
          link_{twin_.link()},
          tool_{link_, twin_.clock()} {
        tool_.scan();
        EXPECT_TRUE(tool_.toState(0, wire::AlState::PreOp));
    }
    static Bytes pattern(std::size_t length, std::uint8_t first) {
        Bytes bytes(length);
        for (std::size_t i = 0; i < length; ++i)
            bytes[i] = static_cast<std::uint8_t>(first + 7 * i + i / 256);
        return bytes;
    }
    Bytes read(std::uint16_t index) {
        Bytes value;
        const auto reply = tool_.uploadLong(0, {index, 0}, value);
        EXPECT_EQ(reply.state, ObjectState::Done) << std::hex << reply.abortCode;
        return value;
    }

    twin::Twin twin_;
    LosingLink link_;
    SegmentTool tool_;
};

TEST_F(LongObjects, AreWrittenAndReadAtEveryLength) {
    for (std::size_t i = 0; i < Lengths.size(); ++i) {
        const auto index = static_cast<std::uint16_t>(FirstIndex + i);
        const Bytes written = pattern(Lengths[i], static_cast<std::uint8_t>(i + 1));
        const auto reply = tool_.downloadLong(0, {index, 0}, written);
        ASSERT_EQ(reply.state, ObjectState::Done)
            << Lengths[i] << " bytes: " << std::hex << reply.abortCode;
        EXPECT_EQ(read(index), written) << Lengths[i] << " bytes";
    }
}

/// Lost is the frame on its way out, or the one that comes back and that the device has seen.
class LongObjectsWithALoss : public LongObjects, public testing::WithParamInterface<bool> {};

TEST_P(LongObjectsWithALoss, ArriveWhicheverFrameItIs) {
    const auto index = static_cast<std::uint16_t>(FirstIndex + 16);  // 350 bytes
    std::size_t frames = 60;
    for (std::size_t lost = 0; lost < frames; ++lost) {
        const Bytes written = pattern(350, static_cast<std::uint8_t>(lost));
        const std::size_t before = link_.sent();
        link_.loseFrame(lost, GetParam());
        const auto reply = tool_.downloadLong(0, {index, 0}, written);
        ASSERT_EQ(reply.state, ObjectState::Done) << "without frame " << lost;
        ASSERT_EQ(read(index), written) << "without frame " << lost;
        frames = std::max(frames, link_.sent() - before);
    }
}

INSTANTIATE_TEST_SUITE_P(OutAndBack, LongObjectsWithALoss, testing::Bool());

TEST_F(LongObjects, TellWhyTheyAreRefused) {
    Bytes value{1, 2, 3};
    EXPECT_EQ(tool_.uploadLong(0, {0x2EFF, 0}, value).abortCode, wire::abortcode::NoObject);
    EXPECT_EQ(value, (Bytes{1, 2, 3})) << "untouched";
    // Longer than the object: seen when the last segment has come.
    EXPECT_EQ(tool_.downloadLong(0, {FirstIndex, 0}, Bytes(300)).abortCode,
              wire::abortcode::LengthMismatch);
    EXPECT_EQ(tool_.downloadLong(0, {FirstIndex, 0}, {}).abortCode,
              wire::abortcode::LengthMismatch);
    // The next transfer is not disturbed.
    EXPECT_EQ(tool_.downloadLong(0, {FirstIndex + 16, 0}, pattern(350, 3)).state,
              ObjectState::Done);
    EXPECT_EQ(read(FirstIndex + 16), pattern(350, 3));
}

TEST_F(LongObjects, DoNotFitIntoAShortValue) {
    const auto reply = tool_.upload(0, {FirstIndex + 4, 0});
    EXPECT_EQ(reply.state, ObjectState::Failed);
    EXPECT_EQ(reply.abortCode, wire::abortcode::LengthTooHigh);
}

}  // namespace
