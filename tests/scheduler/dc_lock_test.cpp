#include <gtest/gtest.h>

#include <cmath>
#include <takt/scheduler/dc_lock.hpp>

namespace takt::scheduler {
namespace {

using core::Duration;
using namespace std::chrono_literals;

/// A perfect controller's clock and a reference that runs faster by `ppm`.
struct Plant {
    double phase;  ///< ns, how late the send is on the reference's grid
    double ppm;

    void cycle(DcLock& lock, double cycleNs) {
        const Duration shift = lock.update(Duration{std::llround(phase)});
        phase += (cycleNs + static_cast<double>(shift.count())) * (1 + ppm * 1e-6) - cycleNs;
    }
};

TEST(DcLock, FindsTheGridFromAnyPhaseAndLearnsTheDrift) {
    for (const double ppm : {-100.0, -12.0, 0.0, 100.0}) {
        for (const double start : {-400e3, -30e3, 0.0, 250e3}) {
            DcLock lock{DcLockParams{}, 1ms};
            Plant plant{start, ppm};
            for (int i = 0; i < 10000; ++i) plant.cycle(lock, 1e6);
            EXPECT_TRUE(lock.locked()) << ppm << " ppm from " << start;
            EXPECT_LT(std::abs(plant.phase), 5.0) << ppm << " ppm from " << start;
            EXPECT_NEAR(lock.driftPpm(), -ppm, 1.0);
        }
    }
}

TEST(DcLock, CorrectsAtMostOnePercentOfTheCycle) {
    DcLock lock{DcLockParams{}, 1ms};
    for (int i = 0; i < 1000; ++i) {
        EXPECT_LE(std::abs(lock.update(450us).count()), 10001);
    }
}

TEST(DcLock, IsNotLockedBeforeTheWindowHasHeldLongEnough) {
    DcLock lock{DcLockParams{}, 1ms};
    for (int i = 0; i < 99; ++i) {
        lock.update(100ns);
        EXPECT_FALSE(lock.locked());
    }
    lock.update(100ns);
    EXPECT_TRUE(lock.locked());
}

TEST(DcLock, GivesTheLockUpAfterThreeFarCyclesOnly) {
    DcLock lock{DcLockParams{}, 1ms};
    for (int i = 0; i < 200; ++i) lock.update(0ns);
    ASSERT_TRUE(lock.locked());
    lock.update(300us);
    lock.update(300us);
    EXPECT_TRUE(lock.locked());
    lock.update(300us);
    EXPECT_FALSE(lock.locked());
    EXPECT_EQ(lock.relocks(), 1U);
}

TEST(DcLock, CoastsWithTheLearntDrift) {
    DcLock lock{DcLockParams{}, 1ms};
    Plant plant{0.0, 40.0};
    for (int i = 0; i < 10000; ++i) plant.cycle(lock, 1e6);
    double given = 0;
    for (int i = 0; i < 100; ++i) given += static_cast<double>(lock.coast().count());
    EXPECT_NEAR(given / 100, -40.0, 1.0);
}

}  // namespace
}  // namespace takt::scheduler
