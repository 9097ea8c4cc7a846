#include <gmock/gmock.h>

#include <array>
#include <takt/wire/byte_io.hpp>

namespace {

using namespace takt::wire;
using testing::ElementsAre;

constexpr std::array<std::uint8_t, 9> Bytes{0x01, 0x82, 0x03, 0x84, 0x05, 0x86, 0x07, 0x88, 0x09};

TEST(ByteIo, LoadsTheLowByteFirst) {
    EXPECT_EQ(load8(Bytes, 3), 0x84);
    EXPECT_EQ(load16(Bytes, 0), 0x8201);
    EXPECT_EQ(load32(Bytes, 0), 0x84038201U);
    EXPECT_EQ(load64(Bytes, 0), 0x8807860584038201U);
}

TEST(ByteIo, LoadsFromOddAddresses) {
    EXPECT_EQ(load16(Bytes, 1), 0x0382);
    EXPECT_EQ(load32(Bytes, 1), 0x05840382U);
    EXPECT_EQ(load64(Bytes, 1), 0x0988078605840382U);
}

TEST(ByteIo, StoresTheLowByteFirstAndNothingElse) {
    std::array<std::uint8_t, 6> b{};
    store16(b, 1, 0xA1B2);
    EXPECT_THAT(b, ElementsAre(0, 0xB2, 0xA1, 0, 0, 0));
    store32(b, 1, 0x11223344);
    EXPECT_THAT(b, ElementsAre(0, 0x44, 0x33, 0x22, 0x11, 0));
    store8(b, 5, 0x99);
    EXPECT_THAT(b, ElementsAre(0, 0x44, 0x33, 0x22, 0x11, 0x99));
}

TEST(ByteIo, StoresEightBytes) {
    std::array<std::uint8_t, 8> b{};
    store64(b, 0, 0x0102030405060708);
    EXPECT_THAT(b, ElementsAre(8, 7, 6, 5, 4, 3, 2, 1));
}

}  // namespace
