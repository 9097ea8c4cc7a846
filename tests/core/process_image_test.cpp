#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <takt/core/process_image.hpp>

namespace {

using takt::core::PdoSlot;
using takt::core::readSigned;
using takt::core::readUnsigned;
using takt::core::write;
using testing::ElementsAre;

TEST(ProcessImage, ReadsUnalignedLittleEndianNumbers) {
    const std::array<std::uint8_t, 6> image{0xFF, 0x78, 0x56, 0x34, 0x12, 0xFF};
    EXPECT_EQ(readUnsigned(image, {8, 32}), 0x12345678U);
    EXPECT_EQ(readUnsigned(image, {8, 16}), 0x5678U);
    EXPECT_EQ(readUnsigned(image, {16, 8}), 0x56U);
}

TEST(ProcessImage, ReadsBitsAcrossBytes) {
    const std::array<std::uint8_t, 2> image{0b1010'0000, 0b0000'0110};
    EXPECT_EQ(readUnsigned(image, {5, 6}), 0b110'101U);
    EXPECT_EQ(readUnsigned(image, {5, 1}), 1U);
    EXPECT_EQ(readUnsigned(image, {6, 1}), 0U);
}

TEST(ProcessImage, ExtendsTheSignFromTheSlotsOwnWidth) {
    const std::array<std::uint8_t, 4> image{0xFE, 0xFF, 0xFF, 0x7F};
    EXPECT_EQ(readSigned(image, {0, 8}), -2);
    EXPECT_EQ(readSigned(image, {0, 16}), -2);
    EXPECT_EQ(readSigned(image, {0, 32}), 0x7FFFFFFE);
    EXPECT_EQ(readSigned(image, {0, 1}), 0);
    EXPECT_EQ(readSigned(image, {1, 1}), -1);
}

TEST(ProcessImage, ReadsTheMostNegativeNumber) {
    const std::array<std::uint8_t, 4> image{0, 0, 0, 0x80};
    EXPECT_EQ(readSigned(image, {0, 32}), INT32_MIN);
}

TEST(ProcessImage, WritesOnlyItsOwnBits) {
    std::array<std::uint8_t, 3> image{0xFF, 0xFF, 0xFF};
    write(image, {6, 5}, 0);
    EXPECT_THAT(image, ElementsAre(0x3F, 0xF8, 0xFF));
    write(image, {6, 5}, 0xFFFFFFFF);
    EXPECT_THAT(image, ElementsAre(0xFF, 0xFF, 0xFF));
}

TEST(ProcessImage, ReturnsWhatWasWrittenAtEveryOffsetAndWidth) {
    for (std::uint8_t width = 1; width <= 32; ++width) {
        for (std::uint32_t offset = 0; offset < 16; ++offset) {
            std::array<std::uint8_t, 8> image{};
            image.fill(0xA5);
            const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << width) - 1);
            const std::uint32_t value = 0xC3965A3CU & mask;
            write(image, {offset, width}, value);
            EXPECT_EQ(readUnsigned(image, {offset, width}), value) << offset << ':' << int{width};
            // Bit by bit: the others still show the pattern.
            for (std::uint32_t bit = 0; bit < 64; ++bit) {
                if (bit >= offset && bit < offset + width) continue;
                EXPECT_EQ((image[bit / 8] >> (bit % 8)) & 1, (0xA5 >> (bit % 8)) & 1);
            }
        }
    }
}

TEST(ProcessImage, AnEmptySlotIsNotPresent) {
    EXPECT_FALSE(PdoSlot{}.present());
    EXPECT_TRUE((PdoSlot{0, 1}.present()));
}

}  // namespace
