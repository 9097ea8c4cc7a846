#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <numeric>
#include <string>
#include <takt/record/pcapng_writer.hpp>
#include <thread>
#include <vector>

#include "temporary_file.hpp"

namespace takt::record {
namespace {

using std::chrono::nanoseconds;

std::uint32_t word(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value |= std::uint32_t{static_cast<std::uint8_t>(bytes.at(at + i))} << (8 * i);
    }
    return value;
}

struct Block {
    std::uint32_t type;
    std::size_t at;
    std::uint32_t length;
};

/// Walks over the blocks as the format says: type, length, body, the same length again.
std::vector<Block> blocksOf(const std::string& bytes) {
    std::vector<Block> blocks;
    for (std::size_t at = 0; at < bytes.size();) {
        const Block block{word(bytes, at), at, word(bytes, at + 4)};
        EXPECT_EQ(block.length % 4, 0U);
        EXPECT_EQ(word(bytes, at + block.length - 4), block.length);
        blocks.push_back(block);
        at += block.length;
    }
    return blocks;
}

std::vector<std::uint8_t> frame(std::size_t size, std::uint8_t first = 1) {
    std::vector<std::uint8_t> bytes(size);
    std::iota(bytes.begin(), bytes.end(), first);
    return bytes;
}

TEST(PcapngWriter, WritesOneSectionOneInterfaceAndItsPackets) {
    const test::TemporaryFile temporary{".pcapng"};
    OutputFile file{temporary.path()};
    PcapngWriter writer{file, "twin", 4096};
    EXPECT_TRUE(writer.packet(Direction::Outbound, core::HostTime{nanoseconds{5}}, frame(61)));
    EXPECT_TRUE(writer.packet(Direction::Inbound, core::HostTime{nanoseconds{6}}, frame(64)));
    EXPECT_TRUE(writer.finish());
    const auto blocks = blocksOf(temporary.content());
    ASSERT_EQ(blocks.size(), 4U);
    EXPECT_EQ(blocks[0].type, 0x0A0D0D0AU);
    EXPECT_EQ(blocks[1].type, 1U);
    EXPECT_EQ(blocks[2].type, 6U);
    EXPECT_EQ(blocks[3].type, 6U);
}

TEST(PcapngWriter, CarriesBytesTimeAndDirectionOfAPacket) {
    const test::TemporaryFile temporary{".pcapng"};
    OutputFile file{temporary.path()};
    PcapngWriter writer{file, "twin", 4096};
    writer.packet(Direction::Inbound, core::HostTime{nanoseconds{0x1122334455667788}},
                  frame(5, 0xA0));
    writer.finish();
    const std::string bytes = temporary.content();
    const Block packet = blocksOf(bytes).at(2);
    EXPECT_EQ(word(bytes, packet.at + 12), 0x11223344U);
    EXPECT_EQ(word(bytes, packet.at + 16), 0x55667788U);
    EXPECT_EQ(word(bytes, packet.at + 20), 5U);
    EXPECT_EQ(word(bytes, packet.at + 24), 5U);
    EXPECT_EQ(bytes.substr(packet.at + 28, 8), std::string("\xA0\xA1\xA2\xA3\xA4\0\0\0", 8));
    EXPECT_EQ(word(bytes, packet.at + 36), 0x00040002U);  // option epb_flags, four bytes
    EXPECT_EQ(word(bytes, packet.at + 40), 1U);           // inbound
}

TEST(PcapngWriter, KeepsPacketsWholeOverTheEndOfItsBuffer) {
    const test::TemporaryFile temporary{".pcapng"};
    OutputFile file{temporary.path()};
    PcapngWriter writer{file, "", 300};
    for (std::uint8_t i = 0; i < 50; ++i) {
        ASSERT_TRUE(writer.packet(Direction::Outbound, core::HostTime{}, frame(60 + i % 7, i)));
        if (i % 2 == 1) writer.drain();
    }
    writer.finish();
    const std::string bytes = temporary.content();
    const auto blocks = blocksOf(bytes);
    ASSERT_EQ(blocks.size(), 52U);
    for (std::uint8_t i = 0; i < 50; ++i) {
        const auto expected = frame(60 + i % 7, i);
        EXPECT_EQ(bytes.substr(blocks[i + 2U].at + 28, expected.size()),
                  std::string(expected.begin(), expected.end()));
    }
}

TEST(PcapngWriter, TakesPacketsFromAnotherThread) {
    const test::TemporaryFile temporary{".pcapng"};
    OutputFile file{temporary.path()};
    PcapngWriter writer{file, "", 1000};
    constexpr std::uint64_t Packets = 5000;
    std::thread producer{[&] {
        for (std::uint64_t i = 0; i < Packets;) {
            const auto bytes = frame(60 + i % 50, static_cast<std::uint8_t>(i));
            if (writer.packet(Direction::Outbound, core::HostTime{}, bytes)) {
                ++i;
            } else {
                std::this_thread::yield();
            }
        }
    }};
    while (writer.packets() < Packets) writer.drain();
    producer.join();
    writer.drain();
    EXPECT_TRUE(file.flush());
    const std::string bytes = temporary.content();
    const auto blocks = blocksOf(bytes);
    ASSERT_EQ(blocks.size(), Packets + 2);
    for (std::uint64_t i = 0; i < Packets; ++i) {
        const auto expected = frame(60 + i % 50, static_cast<std::uint8_t>(i));
        ASSERT_EQ(bytes.substr(blocks[i + 2].at + 28, expected.size()),
                  std::string(expected.begin(), expected.end()));
    }
}

TEST(PcapngWriter, CountsWhatItHadNoRoomForAndSaysSoAtTheEnd) {
    const test::TemporaryFile temporary{".pcapng"};
    OutputFile file{temporary.path()};
    PcapngWriter writer{file, "", 250};
    EXPECT_TRUE(writer.packet(Direction::Outbound, core::HostTime{}, frame(60)));
    EXPECT_TRUE(writer.packet(Direction::Outbound, core::HostTime{}, frame(60)));
    EXPECT_FALSE(writer.packet(Direction::Outbound, core::HostTime{}, frame(60)));
    EXPECT_FALSE(writer.finish());
    EXPECT_EQ(writer.packets(), 2U);
    EXPECT_EQ(writer.dropped(), 1U);
    EXPECT_EQ(blocksOf(temporary.content()).size(), 4U);
}

}  // namespace
}  // namespace takt::record
