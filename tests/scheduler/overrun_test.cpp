#include <gtest/gtest.h>

#include <takt/scheduler/overrun_guard.hpp>

namespace takt::scheduler {
namespace {

TEST(OverrunGuard, IsFineWhileNothingIsMissed) {
    OverrunGuard guard{{}};
    for (int i = 0; i < 5000; ++i) ASSERT_EQ(guard.update(0), OverrunVerdict::Fine);
    EXPECT_EQ(guard.overruns(), 0U);
}

TEST(OverrunGuard, ToleratesLessInARowThanTheLimit) {
    OverrunGuard guard{{}};
    EXPECT_EQ(guard.update(1), OverrunVerdict::Fine);
    EXPECT_EQ(guard.update(1), OverrunVerdict::Fine);
    EXPECT_EQ(guard.update(0), OverrunVerdict::Fine);
    EXPECT_EQ(guard.update(2), OverrunVerdict::Fine);
    EXPECT_EQ(guard.overruns(), 3U);
    EXPECT_EQ(guard.skipped(), 4U);
}

TEST(OverrunGuard, StopsOnPathAtTheLimitInARow) {
    OverrunGuard guard{{}};
    EXPECT_EQ(guard.update(1), OverrunVerdict::Fine);
    EXPECT_EQ(guard.update(2), OverrunVerdict::StopOnPath);
}

TEST(OverrunGuard, CountsEveryCycleOfOneLongGap) {
    OverrunGuard guard{{}};
    EXPECT_EQ(guard.update(10), OverrunVerdict::DriveStop);
}

TEST(OverrunGuard, BeginsAnewAfterACycleInTime) {
    OverrunGuard guard{{}};
    EXPECT_EQ(guard.update(2), OverrunVerdict::Fine);
    EXPECT_EQ(guard.update(0), OverrunVerdict::Fine);
    EXPECT_EQ(guard.inRow(), 0U);
    EXPECT_EQ(guard.update(2), OverrunVerdict::Fine);
}

TEST(OverrunGuard, StopsWhenTheRateIsExceeded) {
    OverrunGuard guard{{.rate = 0.01}};
    int missed = 0;
    for (int i = 0; i < 500; ++i) {
        const bool late = i % 20 == 0;
        missed += late ? 1 : 0;
        const OverrunVerdict verdict = guard.update(late ? 1 : 0);
        ASSERT_EQ(verdict == OverrunVerdict::Fine, missed <= 10) << "after " << missed;
    }
}

TEST(OverrunGuard, ForgetsWhatIsOlderThanTheStretch) {
    OverrunGuard guard{{.rate = 0.01}};
    for (int stretch = 0; stretch < 20; ++stretch) {
        for (int i = 0; i < 1000; ++i) {
            ASSERT_EQ(guard.update(i == 500 || i == 700 ? 1 : 0), OverrunVerdict::Fine);
        }
    }
}

TEST(OverrunGuard, OnlyCountsWhenToldTo) {
    OverrunGuard guard{{.policy = OverrunPolicy::Count}};
    for (int i = 0; i < 100; ++i) ASSERT_EQ(guard.update(50), OverrunVerdict::Fine);
    EXPECT_EQ(guard.overruns(), 100U);
    EXPECT_EQ(guard.skipped(), 5000U);
}

}  // namespace
}  // namespace takt::scheduler
