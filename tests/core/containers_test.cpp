#include <gmock/gmock.h>

#include <cstdint>
#include <takt/core/fixed_vector.hpp>
#include <takt/core/spsc_ring.hpp>
#include <thread>
#include <vector>

namespace {

using takt::core::FixedVector;
using takt::core::SpscRing;
using testing::ElementsAre;

TEST(FixedVector, RefusesMoreThanItsCapacity) {
    FixedVector<int, 2> v;
    EXPECT_TRUE(v.push(1));
    EXPECT_TRUE(v.push(2));
    EXPECT_TRUE(v.full());
    EXPECT_FALSE(v.push(3));
    EXPECT_THAT((std::vector<int>(v.begin(), v.end())), ElementsAre(1, 2));
}

TEST(FixedVector, KeepsTheOrderWhenTheFirstIsTaken) {
    FixedVector<int, 3> v;
    for (const int i : {1, 2, 3}) v.push(i);
    v.popFront();
    EXPECT_THAT((std::vector<int>(v.begin(), v.end())), ElementsAre(2, 3));
    EXPECT_EQ(v.front(), 2);
    EXPECT_EQ(v.back(), 3);
    v.clear();
    EXPECT_TRUE(v.empty());
}

TEST(SpscRing, HasRoomForExactlyItsCapacity) {
    SpscRing<int> ring{3};
    for (const int i : {1, 2, 3}) EXPECT_TRUE(ring.push(i));
    EXPECT_FALSE(ring.push(4));
    int value = 0;
    EXPECT_TRUE(ring.pop(value));
    EXPECT_EQ(value, 1);
    EXPECT_TRUE(ring.push(4));
    for (const int expected : {2, 3, 4}) {
        EXPECT_TRUE(ring.pop(value));
        EXPECT_EQ(value, expected);
    }
    EXPECT_FALSE(ring.pop(value));
}

TEST(SpscRing, LosesAndReordersNothingBetweenTwoThreads) {
    SpscRing<std::uint32_t> ring{7};
    constexpr std::uint32_t count = 20'000;
    std::thread producer{[&ring] {
        for (std::uint32_t i = 0; i < count;) {
            if (ring.push(i)) {
                ++i;
            } else {
                std::this_thread::yield();
            }
        }
    }};
    std::uint32_t expected = 0;
    std::uint32_t wrong = 0;
    while (expected < count) {
        std::uint32_t value = 0;
        if (!ring.pop(value)) {
            std::this_thread::yield();
            continue;
        }
        wrong += value == expected ? 0 : 1;
        ++expected;
    }
    producer.join();
    EXPECT_EQ(wrong, 0U);
}

}  // namespace
