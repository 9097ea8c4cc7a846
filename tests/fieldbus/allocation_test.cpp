#include <cstdlib>
#include <new>
#include <takt/core/cycle_guard.hpp>

#include "master_fixture.hpp"

namespace {

thread_local bool armed = false;
thread_local std::size_t hits = 0;

}  // namespace

/// The hook of core::CycleGuard.
extern "C" void taktTrapArm(bool on) {
    armed = on;
}

// The sanitizers bring their own operators; there the cycle is checked for other things.
#ifndef __SANITIZE_ADDRESS__
void* operator new(std::size_t size) {
    if (armed) ++hits;
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc{};
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    if (armed) ++hits;
    return std::malloc(size == 0 ? 1 : size);
}
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void operator delete(void* memory) noexcept {
    if (armed) ++hits;
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    operator delete(memory);
}
void operator delete(void* memory, const std::nothrow_t&) noexcept {
    operator delete(memory);
}
#pragma GCC diagnostic pop
#endif

namespace {

using namespace takt;
using fieldbus::ethercat::NetworkState;

class MasterMemory : public test::MasterOnFake {
protected:
    void guardedCycles(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            const core::CycleGuard guard;
            cycle();
        }
    }
};

#ifndef __SANITIZE_ADDRESS__
TEST(AllocationTrap, SeesAnAllocation) {
    hits = 0;
    {
        const core::CycleGuard guard;
        const std::vector<int> v(1000);
        EXPECT_EQ(v.size(), 1000U);
    }
    EXPECT_EQ(hits, 2U);
}
#endif

TEST_F(MasterMemory, IsNotTouchedFromPreOpOverOpAndFaultsToInit) {
    build(test::exampleNetwork(3));
    ASSERT_THAT(bringUp(), testing::IsEmpty());
    hits = 0;
    wake = master->firstSend(clock.now());
    master->setClockLocked(true);
    master->requestOp();
    guardedCycles(300);
    ASSERT_EQ(master->state(), NetworkState::Op);
    ASSERT_TRUE(master->objects(1).startRead({0x6064, 0}));
    segment.devices[0].emergency(0x1234);
    segment.lose = {segment.frameNumber + 3, segment.frameNumber + 5};
    guardedCycles(20);
    segment.devices[2].state(0x14, 0x001B);
    guardedCycles(20);
    segment.devices[1].dead = true;
    guardedCycles(50);
    master->requestOp();
    guardedCycles(50);
    master->requestInit();
    guardedCycles(200);
    EXPECT_EQ(master->state(), NetworkState::Init);
    EXPECT_EQ(hits, 0U);
}

}  // namespace
