#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <takt/bridge/broadcast_ring.hpp>
#include <thread>

namespace takt::bridge {
namespace {

/// Every part says the same, or the value was torn.
struct Sample {
    std::uint64_t first{0};
    std::array<std::uint64_t, 20> middle{};
    std::uint64_t last{0};
};

Sample sampleOf(std::uint64_t number) {
    Sample sample{.first = number, .last = number};
    sample.middle.fill(number);
    return sample;
}

bool isWhole(const Sample& sample) {
    for (const std::uint64_t word : sample.middle) {
        if (word != sample.first) return false;
    }
    return sample.first == sample.last;
}

template <typename T>
struct Memory {
    explicit Memory(std::size_t depth)
        : bytes{static_cast<std::byte*>(
              ::operator new (RingLayout<T>::bytes(depth), std::align_val_t{64}))} {}
    ~Memory() { ::operator delete (bytes, std::align_val_t{64}); }
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    std::byte* bytes;
};

using Reader = RingReader<Sample>;

TEST(BroadcastRing, GivesEveryReaderAllThatWasWrittenInOrder) {
    const Memory<Sample> memory{8};
    RingWriter<Sample> writer{memory.bytes, 8};
    Reader one{memory.bytes, 8, Reader::From::Oldest};
    Reader two{memory.bytes, 8, Reader::From::Oldest};
    for (std::uint64_t i = 0; i < 6; ++i) writer.push(sampleOf(i));
    for (Reader* reader : {&one, &two}) {
        Sample sample;
        for (std::uint64_t i = 0; i < 6; ++i) {
            ASSERT_TRUE(reader->next(sample));
            EXPECT_EQ(sample.first, i);
        }
        EXPECT_FALSE(reader->next(sample));
        EXPECT_EQ(reader->missed(), 0U);
    }
}

TEST(BroadcastRing, TellsAReaderThatFellBehindHowManyItMissed) {
    const Memory<Sample> memory{8};
    RingWriter<Sample> writer{memory.bytes, 8};
    Reader reader{memory.bytes, 8, Reader::From::Oldest};
    for (std::uint64_t i = 0; i < 100; ++i) writer.push(sampleOf(i));
    Sample sample;
    std::uint64_t read = 0;
    std::uint64_t before = 0;
    while (reader.next(sample)) {
        EXPECT_GT(sample.first + 1, before);
        before = sample.first;
        ++read;
    }
    EXPECT_EQ(sample.first, 99U);
    EXPECT_EQ(read + reader.missed(), 100U);
}

TEST(BroadcastRing, BeginsWithTheNewestWhenAsked) {
    const Memory<Sample> memory{8};
    RingWriter<Sample> writer{memory.bytes, 8};
    for (std::uint64_t i = 0; i < 20; ++i) writer.push(sampleOf(i));
    Reader reader{memory.bytes, 8, Reader::From::Newest};
    Sample sample;
    ASSERT_TRUE(reader.next(sample));
    EXPECT_EQ(sample.first, 19U);
    EXPECT_FALSE(reader.next(sample));
}

TEST(BroadcastRing, BeginsWithTheOldestThatIsKeptWhenAsked) {
    const Memory<Sample> memory{8};
    RingWriter<Sample> writer{memory.bytes, 8};
    for (std::uint64_t i = 0; i < 20; ++i) writer.push(sampleOf(i));
    Reader reader{memory.bytes, 8, Reader::From::Oldest};
    Sample sample;
    ASSERT_TRUE(reader.next(sample));
    EXPECT_EQ(sample.first, 12U);
    EXPECT_EQ(reader.missed(), 0U);
}

TEST(BroadcastRing, NeverShowsATornSampleNorStopsTheWriter) {
    constexpr std::uint64_t count = 200'000;
    const Memory<Sample> memory{4};
    RingWriter<Sample> writer{memory.bytes, 4};
    std::atomic<bool> done{false};
    Reader reader{memory.bytes, 4, Reader::From::Oldest};
    std::thread reading{[&] {
        std::uint64_t read = 0;
        std::uint64_t next = 0;
        Sample sample;
        for (bool last = false; !last;) {
            last = done.load();
            while (reader.next(sample)) {
                EXPECT_TRUE(isWhole(sample));
                EXPECT_GE(sample.first, next);
                next = sample.first + 1;
                ++read;
            }
        }
        EXPECT_EQ(next, count);
        EXPECT_EQ(read + reader.missed(), count);
    }};
    for (std::uint64_t i = 0; i < count; ++i) writer.push(sampleOf(i));
    done = true;
    reading.join();
}

}  // namespace
}  // namespace takt::bridge
