#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <takt/core/seq_lock.hpp>
#include <thread>

namespace takt::core {
namespace {

struct Odd {
    std::uint8_t a{7};
    std::uint16_t b{8};
    std::array<std::uint8_t, 5> c{1, 2, 3, 4, 5};
};

TEST(SeqLock, ShowsTheDefaultValueBeforeTheFirstWrite) {
    const SeqLock<Odd> lock;
    EXPECT_EQ(lock.read().a, 7);
    EXPECT_EQ(lock.read().c[4], 5);
}

TEST(SeqLock, GivesBackEveryByteOfAValueWhoseSizeIsNoMultipleOfAWord) {
    SeqLock<Odd> lock;
    lock.write({1, 0xBEEF, {9, 8, 7, 6, 5}});
    const Odd read = lock.read();
    EXPECT_EQ(read.a, 1);
    EXPECT_EQ(read.b, 0xBEEF);
    EXPECT_EQ(read.c, (std::array<std::uint8_t, 5>{9, 8, 7, 6, 5}));
}

TEST(SeqLock, NeverShowsHalfAWrite) {
    struct Wide {
        std::array<std::uint64_t, 16> same{};
    };
    SeqLock<Wide> lock;
    constexpr std::uint64_t Writes = 20000;
    std::thread writer{[&lock] {
        for (std::uint64_t i = 1; i <= Writes; ++i) {
            Wide wide;
            wide.same.fill(i);
            lock.write(wide);
        }
    }};
    std::uint64_t last = 0;
    bool whole = true;
    while (last != Writes) {
        const Wide wide = lock.read();
        for (const std::uint64_t word : wide.same) whole = whole && word == wide.same[0];
        whole = whole && wide.same[0] >= last;
        last = wide.same[0];
    }
    writer.join();
    EXPECT_TRUE(whole);
}

}  // namespace
}  // namespace takt::core
