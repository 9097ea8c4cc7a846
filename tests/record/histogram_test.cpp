#include <gtest/gtest.h>

#include <limits>
#include <takt/record/histogram.hpp>

namespace takt::record {
namespace {

TEST(Histogram, PutsAValueIntoTheBinOfItsHighestBit) {
    Histogram histogram;
    for (const std::int64_t value : {0, 1, 2, 3, 4, 7, 8}) histogram.add(value);
    EXPECT_EQ(histogram.bin(0), 1U);
    EXPECT_EQ(histogram.bin(1), 1U);
    EXPECT_EQ(histogram.bin(2), 2U);
    EXPECT_EQ(histogram.bin(3), 2U);
    EXPECT_EQ(histogram.bin(4), 1U);
}

TEST(Histogram, KnowsSmallestLargestAndMean) {
    Histogram histogram;
    for (const std::int64_t value : {30, 10, 20}) histogram.add(value);
    EXPECT_EQ(histogram.min(), 10U);
    EXPECT_EQ(histogram.max(), 30U);
    EXPECT_EQ(histogram.mean(), 20U);
}

TEST(Histogram, BoundsAShareOfTheValues) {
    Histogram histogram;
    for (int i = 0; i < 99; ++i) histogram.add(100);
    histogram.add(5000);
    EXPECT_EQ(histogram.atMost(500), 127U);
    EXPECT_EQ(histogram.atMost(990), 127U);
    EXPECT_EQ(histogram.atMost(1000), 5000U);
}

TEST(Histogram, CountsANegativeValueAsZero) {
    Histogram histogram;
    histogram.add(-5);
    EXPECT_EQ(histogram.bin(0), 1U);
    EXPECT_EQ(histogram.max(), 0U);
}

TEST(Histogram, TakesTheLargestNumber) {
    Histogram histogram;
    histogram.add(std::numeric_limits<std::int64_t>::max());
    EXPECT_EQ(histogram.bin(63), 1U);
    EXPECT_EQ(histogram.atMost(1000),
              static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()));
}

TEST(Histogram, IsAllZeroWhenEmpty) {
    const Histogram histogram;
    EXPECT_EQ(histogram.mean(), 0U);
    EXPECT_EQ(histogram.atMost(500), 0U);
}

}  // namespace
}  // namespace takt::record
