#include <gtest/gtest.h>

#include <map>

#include "devices.hpp"
#include "sii_image.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

std::uint32_t word(const Bytes& image, std::size_t at) {
    return static_cast<std::uint32_t>(image[2 * at] | (image[2 * at + 1] << 8));
}

/// Category number → its content, walked as a master walks them.
std::map<std::uint32_t, Bytes> categories(const Bytes& image) {
    std::map<std::uint32_t, Bytes> result;
    for (std::size_t at = 64; word(image, at) != 0xFFFF;) {
        const std::size_t length = word(image, at + 1);
        const auto start = image.begin() + static_cast<std::ptrdiff_t>(2 * (at + 2));
        result[word(image, at)] = Bytes(start, start + static_cast<std::ptrdiff_t>(2 * length));
        at += 2 + length;
    }
    return result;
}

TEST(TwinSii, CarriesIdentityAndMailboxWords) {
    const Bytes image = buildSiiImage(*servoDescription("generic"));
    EXPECT_EQ(word(image, 8), 0xAFFEU);
    EXPECT_EQ(word(image, 10), 0x42U);
    EXPECT_EQ(word(image, 12), 0x0002U);
    EXPECT_EQ(word(image, 13), 0x0001U);
    EXPECT_EQ(word(image, 14), 0x5678U);
    EXPECT_EQ(word(image, 24), 0x1000U);
    EXPECT_EQ(word(image, 25), 128U);
    EXPECT_EQ(word(image, 26), 0x1080U);
    EXPECT_EQ(word(image, 27), 128U);
    EXPECT_EQ(word(image, 28), 0x0004U);
    EXPECT_EQ(word(image, 63), 1U);
    EXPECT_EQ((word(image, 62) + 1) * 1024 / 8, image.size());
}

TEST(TwinSii, HasTheChecksumOfItsFirstFourteenBytes) {
    // CRC-8 as a table-free long division over the bits, an independent way to the same number.
    const Bytes image = buildSiiImage(*servoDescription("generic"));
    std::uint32_t remainder = 0xFF;
    for (std::size_t bit = 0; bit < std::size_t{14} * 8; ++bit) {
        const std::uint32_t in = (image[bit / 8] >> (7 - bit % 8)) & 1U;
        const std::uint32_t out = (remainder >> 7) & 1U;
        remainder = (remainder << 1) & 0xFF;
        if ((in ^ out) != 0) remainder ^= 0x07;
    }
    EXPECT_EQ(word(image, 7), remainder);
}

TEST(TwinSii, DescribesSyncManagersFmmusAndPdos) {
    const auto all = categories(buildSiiImage(*servoDescription("generic")));
    EXPECT_EQ(all.at(40), (Bytes{1, 2, 3, 0}));
    const Bytes& sm = all.at(41);
    ASSERT_EQ(sm.size(), 32U);
    EXPECT_EQ(Bytes(sm.begin() + 16, sm.begin() + 24), (Bytes{0x00, 0x11, 7, 0, 0x64, 0, 1, 3}));
    const Bytes& tx = all.at(50);
    EXPECT_EQ(word(tx, 0), 0x1A00U);
    EXPECT_EQ(tx[2], 5);
    EXPECT_EQ(tx[3], 3);
    EXPECT_EQ(word(tx, 4 + 4), 0x6041U);  // second entry
    EXPECT_EQ(tx[8 + 8 + 5], 16);
    const Bytes& rx = all.at(51);
    EXPECT_EQ(word(rx, 0), 0x1600U);
    const Bytes& dc = all.at(60);
    ASSERT_EQ(dc.size(), 24U);
    EXPECT_EQ(word(dc, 7), 0x0300U);
}

TEST(TwinSii, RefersToStringsByNumbersFromOne) {
    const auto all = categories(buildSiiImage(*servoDescription("generic")));
    const Bytes& strings = all.at(10);
    const Bytes& general = all.at(30);
    std::vector<std::string> table{""};
    for (std::size_t at = 1; table.size() <= strings[0]; at += 1U + strings[at]) {
        table.emplace_back(strings.begin() + static_cast<std::ptrdiff_t>(at + 1),
                           strings.begin() + static_cast<std::ptrdiff_t>(at + 1 + strings[at]));
    }
    EXPECT_EQ(table.at(general[2]), "generic");
    EXPECT_EQ(table.at(general[3]), "Test servo");
    EXPECT_EQ(table.at(all.at(51)[5]), "Outputs");
}

TEST(TwinSii, EndsWithAnErasedRest) {
    const Bytes image = buildSiiImage(*servoDescription("generic"));
    EXPECT_EQ(image.back(), 0xFF);
    EXPECT_EQ(image.size() % 2048, 0U);
}

}  // namespace
}  // namespace takt::twin::test
