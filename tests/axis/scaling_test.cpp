#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <takt/axis/scaling.hpp>

using namespace takt;

namespace {

axis::ScalingParams gear(std::int64_t counts, std::int64_t motor, std::int64_t load,
                         std::int64_t units, std::int64_t parts = 1) {
    axis::ScalingParams p;
    p.countsPerTurn = counts;
    p.gearMotor = motor;
    p.gearLoad = load;
    p.unitsPerTurnNumerator = units;
    p.unitsPerTurnDenominator = parts;
    return p;
}

}  // namespace

TEST(Scaling, ConvertsByTheFormulaOfItsParameters) {
    const axis::Scaling s{gear(10000, 3, 2, 20)};
    EXPECT_DOUBLE_EQ(s.toUnits(15000).count(), 20.0);
    EXPECT_EQ(s.toCounts(core::Position{20.0}), 15000);
    EXPECT_DOUBLE_EQ(s.resolution().count(), 20.0 / 15000.0);
}

TEST(Scaling, TurnsTheCountingDirectionRoundWhenReversed) {
    auto p = gear(10000, 1, 1, 20);
    p.reversed = true;
    const axis::Scaling s{p};
    EXPECT_DOUBLE_EQ(s.toUnits(10000).count(), -20.0);
    EXPECT_EQ(s.toCounts(core::Position{20.0}), -10000);
    EXPECT_GT(s.resolution().count(), 0.0);
}

TEST(Scaling, RoundsToTheNearestCount) {
    const axis::Scaling s{gear(1, 1, 1, 1)};
    EXPECT_EQ(s.toCounts(core::Position{2.4}), 2);
    EXPECT_EQ(s.toCounts(core::Position{2.6}), 3);
    EXPECT_EQ(s.toCounts(core::Position{-2.4}), -2);
    EXPECT_EQ(s.toCounts(core::Position{-2.6}), -3);
}

TEST(Scaling, GivesEveryCountBackOverAThousandMillionCounts) {
    // 131072 counts, gear 7/3, 12.7 mm: nothing divides.
    const axis::Scaling s{gear(131072, 7, 3, 127, 10)};
    for (std::int64_t c = -1'000'000'000; c <= 1'000'000'000; c += 999'983) {
        ASSERT_EQ(s.toCounts(s.toUnits(c)), c);
    }
}

TEST(Scaling, DoesNotDriftWithARationalGear) {
    // One output turn = 7/3 motor turns. After 3e8 output turns the angle is exact, computed in
    // whole numbers.
    const axis::Scaling s{gear(10, 7, 3, 360)};
    const std::int64_t turns = 300'000'000;
    EXPECT_DOUBLE_EQ(s.toUnits(turns / 3 * 70).count(), static_cast<double>(turns) * 360.0);
    EXPECT_NEAR(s.toUnits(turns / 3 * 70 + 7).count() - s.toUnits(turns / 3 * 70).count(), 108.0,
                2e-5);
}

TEST(Scaling, ReadsTheOriginAsItsPosition) {
    axis::Scaling s{gear(10000, 1, 1, 20)};
    s.setOrigin(5000, core::Position{12.345});
    EXPECT_EQ(s.toUnits(5000).count(), 12.345);
    EXPECT_EQ(s.toCounts(core::Position{12.345}), 5000);
    EXPECT_DOUBLE_EQ(s.toUnits(15000).count(), 32.345);
}

TEST(Scaling, FoldsAModuloAxisIntoOnePeriod) {
    auto p = gear(3600, 1, 1, 360);
    p.modulo = core::Distance{360.0};
    const axis::Scaling s{p};
    EXPECT_DOUBLE_EQ(s.fold(core::Position{370.0}).count(), 10.0);
    EXPECT_DOUBLE_EQ(s.fold(core::Position{-10.0}).count(), 350.0);
    EXPECT_DOUBLE_EQ(s.fold(core::Position{0.0}).count(), 0.0);
    EXPECT_DOUBLE_EQ(s.fold(core::Position{360.0}).count(), 0.0);
    EXPECT_DOUBLE_EQ(s.fold(core::Position{-720.0}).count(), 0.0);
    for (const double tiny : {-1e-20, -5e-324, 359.99999999999997, 1e9 * 360.0}) {
        const double folded = s.fold(core::Position{tiny}).count();
        EXPECT_GE(folded, 0.0);
        EXPECT_LT(folded, 360.0);
    }
}

TEST(Scaling, LeavesALinearAxisUnfolded) {
    const axis::Scaling s{gear(3600, 1, 1, 360)};
    EXPECT_EQ(s.fold(core::Position{-370.0}).count(), -370.0);
}

TEST(Scaling, RefusesARatioThatIsNotPositive) {
    EXPECT_THROW(axis::Scaling{gear(0, 1, 1, 1)}, std::invalid_argument);
    EXPECT_THROW(axis::Scaling{gear(1, 1, 0, 1)}, std::invalid_argument);
    EXPECT_THROW(axis::Scaling{gear(1, 1, 1, -1)}, std::invalid_argument);
    auto p = gear(1, 1, 1, 1);
    p.modulo = core::Distance{0.0};
    EXPECT_THROW(axis::Scaling{p}, std::invalid_argument);
}
