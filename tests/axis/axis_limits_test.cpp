#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;
using axis::CommandKind;
using axis::CommandPhase;

namespace {

axis::AxisParams limited(double negative, double positive) {
    auto p = testParams();
    p.limits.softNegative = core::Position{negative};
    p.limits.softPositive = core::Position{positive};
    return p;
}

axis::AxisParams rotary() {
    auto p = testParams();
    p.unit = "deg";
    p.scaling.countsPerTurn = 36000;
    p.scaling.unitsPerTurnNumerator = 360;
    p.scaling.modulo = core::Distance{360.0};
    return p;
}

axis::Command turnTo(double position, axis::Direction direction, double velocity = 200.0) {
    auto c = moveTo(position, velocity);
    c.direction = direction;
    return c;
}

double folded(const Rig& rig) {
    return rig.x.view().folded(rig.x.status().set).count();
}

/// Distance travelled by one move from `from` to `to`, both in one turn, from standstill.
double travel(double from, double to, axis::Direction direction) {
    Rig rig{rotary()};
    rig.powerOn();
    rig.send(moveBy(from));
    EXPECT_TRUE(rig.untilState(AxisState::Standstill));
    const double start = rig.x.status().set.count();
    rig.send(turnTo(to, direction));
    rig.cycle();
    EXPECT_TRUE(rig.untilState(AxisState::Standstill));
    return rig.x.status().set.count() - start;
}

}  // namespace

class SoftLimitVelocity : public testing::TestWithParam<double> {};

TEST_P(SoftLimitVelocity, RunningVelocityMoveStopsExactlyAtTheLimit) {
    // Long and short ways: with cruise, and without ever reaching the velocity.
    for (const double sign : {1.0, -1.0}) {
        Rig rig{limited(-GetParam(), GetParam())};
        rig.powerOn();
        const auto id = rig.send(runAt(sign * 400.0));
        ASSERT_TRUE(rig.untilState(AxisState::Standstill));
        EXPECT_NEAR(rig.x.status().set.count(), sign * GetParam(), 1e-12);
        EXPECT_EQ(rig.status(id).phase, CommandPhase::Error);
        EXPECT_EQ(rig.status(id).error, ErrorId::SWLimitReached);
        EXPECT_EQ(rig.x.error().id, ErrorId::None);
        EXPECT_EQ(rig.refusal(runAt(sign * 10.0)), ErrorId::SWLimitReached);
        rig.send(runAt(-sign * 10.0));
        rig.cycles(200);
        EXPECT_LT(sign * rig.x.status().set.count(), GetParam());
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, SoftLimitVelocity, testing::Values(0.5, 7.0, 33.0, 90.0, 400.0));

TEST(SoftLimit, VelocityMoveIsNotBrakedEarlierThanNeeded) {
    Rig rig{limited(-1000.0, 200.0)};
    rig.powerOn();
    rig.send(runAt(400.0));
    ASSERT_TRUE(rig.until([&] { return rig.x.view().inVelocity; }));
    ASSERT_TRUE(rig.until([&] { return rig.x.state() == AxisState::DiscreteMotion; }));
    // v²/2a + v·a/2j with 400 mm/s, 4000 mm/s², 100000 mm/s³: 28 mm, and at most two cycles more.
    EXPECT_NEAR(rig.x.status().set.count(), 172.0, 2 * 0.4 + 0.01);
}

TEST(SoftLimit, MoveThatCannotBrakeGentlyEnoughIsStoppedHarder) {
    Rig rig{limited(-1000.0, 100.0)};
    rig.powerOn();
    rig.send(moveTo(100.0, 500.0));
    ASSERT_TRUE(rig.until([&] { return rig.x.status().set.count() > 40.0; }));
    auto gentle = moveTo(50.0, 500.0);
    gentle.dynamics.deceleration = core::Acceleration{200.0};  // would need 600 mm
    const auto id = rig.send(gentle);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.status(id).error, ErrorId::SWLimitReached);
    EXPECT_LE(rig.x.status().set.count(), 100.0);
    EXPECT_EQ(rig.x.error().id, ErrorId::None);
}

TEST(SoftLimit, GentleStopAndHaltStayInside) {
    for (const CommandKind kind : {CommandKind::Stop, CommandKind::Halt}) {
        Rig rig{limited(-1000.0, 100.0)};
        rig.powerOn();
        rig.send(moveTo(100.0, 500.0));
        ASSERT_TRUE(rig.until([&] { return rig.x.status().set.count() > 40.0; }));
        auto c = command(kind);
        c.dynamics.deceleration = core::Acceleration{200.0};
        const auto id = rig.send(c);
        ASSERT_TRUE(rig.until([&] { return rig.status(id).phase == CommandPhase::Done; }));
        EXPECT_LE(rig.x.status().set.count(), 100.0);
    }
}

TEST(SoftLimit, RefusedTargetLeavesTheRunningMotionAlone) {
    Rig rig{limited(-10.0, 100.0)};
    Rig twin{limited(-10.0, 100.0)};
    for (Rig* r : {&rig, &twin}) {
        r->powerOn();
        r->send(moveTo(80.0));
        r->cycles(100);
    }
    EXPECT_EQ(rig.refusal(moveTo(101.0)), ErrorId::TargetOutsideSWLimit);
    twin.cycle();
    for (int i = 0; i < 1500; ++i) {
        ASSERT_EQ(rig.x.status().set.count(), twin.x.status().set.count());
        rig.cycle();
        twin.cycle();
    }
}

TEST(SoftLimit, AxisOutsideMayMoveIn) {
    auto p = limited(-10.0, 100.0);
    Rig rig{p};
    rig.drive.position = 60000;  // 120 mm
    rig.powerOn();
    rig.send(moveTo(90.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().set.count(), 90.0);
    EXPECT_EQ(rig.x.error().id, ErrorId::None);
}

TEST(Modulo, TravelsByDirection) {
    using axis::Direction;
    // At 350: shortest and positive +20, negative -340.
    EXPECT_NEAR(travel(350.0, 10.0, Direction::ShortestWay), 20.0, 1e-9);
    EXPECT_NEAR(travel(350.0, 10.0, Direction::Positive), 20.0, 1e-9);
    EXPECT_NEAR(travel(350.0, 10.0, Direction::Negative), -340.0, 1e-9);
    EXPECT_NEAR(travel(10.0, 350.0, Direction::ShortestWay), -20.0, 1e-9);
    EXPECT_NEAR(travel(10.0, 350.0, Direction::Current), 340.0, 1e-9);
}

TEST(Modulo, DoesNotMoveWhenItIsThere) {
    using axis::Direction;
    for (const auto d :
         {Direction::ShortestWay, Direction::Positive, Direction::Negative, Direction::Current}) {
        EXPECT_NEAR(travel(10.0, 10.0, d), 0.0, 1e-9);
        EXPECT_NEAR(travel(10.0, 370.0, d), 0.0, 1e-9);  // folded: no extra turn
    }
}

TEST(Modulo, ShortestWayGoesPositiveOnATie) {
    EXPECT_NEAR(travel(10.0, 190.0, axis::Direction::ShortestWay), 180.0, 1e-9);
}

TEST(Modulo, RoundingNeverCostsATurn) {
    // The set position after many turns folds to a value some rounding away from the target.
    Rig rig{rotary()};
    rig.powerOn();
    for (int i = 0; i < 20; ++i) {
        rig.send(turnTo(10.1, axis::Direction::Positive));
        ASSERT_TRUE(rig.untilState(AxisState::Standstill));
        const double before = rig.x.status().set.count();
        rig.send(turnTo(10.1, axis::Direction::Positive));
        rig.cycle();
        ASSERT_TRUE(rig.untilState(AxisState::Standstill));
        ASSERT_NEAR(rig.x.status().set.count(), before, 1e-6);
        rig.send(moveBy(360.0 * 3 + 77.7, 500.0));
        ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    }
}

TEST(Modulo, GoesOneMoreTurnWhenItCannotStopInTime) {
    Rig rig{rotary()};
    rig.powerOn();
    rig.send(runAt(400.0));
    ASSERT_TRUE(rig.until([&] { return rig.x.view().inVelocity; }));
    const double here = rig.x.status().set.count();
    rig.send(turnTo(folded(rig) + 5.0, axis::Direction::Positive, 400.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_NEAR(rig.x.status().set.count(), here + 365.0, 1.0);
    // Never backward.
}

TEST(Modulo, ShortestWayIsDecidedFromTheSetPosition) {
    Rig rig{rotary()};
    rig.powerOn();
    rig.send(runAt(400.0));
    ASSERT_TRUE(rig.until([&] { return rig.x.view().inVelocity; }));
    const double here = rig.x.status().set.count();
    rig.send(turnTo(folded(rig) + 5.0, axis::Direction::ShortestWay, 400.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_NEAR(rig.x.status().set.count(), here + 5.0, 1.0);
}

TEST(Modulo, ReportsTheFoldedPositionWithoutDriftOverManyTurns) {
    Rig rig{rotary()};
    rig.drive.position = 36000LL * 50000;  // 1.8e9 counts
    rig.powerOn();
    rig.send(runAt(500.0));
    ASSERT_TRUE(rig.until([&] { return rig.x.view().inVelocity; }));
    // Two million counts on, over the wrap at 2^31.
    for (int i = 0; i < 8000; ++i) {
        rig.cycle();
        const double f = rig.x.view().folded(rig.x.view().actual).count();
        ASSERT_GE(f, 0.0);
        ASSERT_LT(f, 360.0);
    }
    rig.send(turnTo(90.0, axis::Direction::Positive));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    rig.cycles(5);
    EXPECT_EQ(rig.drive.position % 36000, 9000);
}
