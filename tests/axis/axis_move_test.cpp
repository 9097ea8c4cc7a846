#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;
using axis::CommandPhase;

namespace {

/// Steps that the set position takes until it stands on `target`, counted from the call's cycle.
int stepsTo(Rig& rig, double target) {
    int steps = 1;  // the call's own cycle made the first one
    while (rig.x.status().set.count() != target && steps < 20000) {
        rig.cycle();
        ++steps;
    }
    return steps;
}

axis::AxisParams symmetric(double a, double j) {
    auto p = testParams();
    p.limits.acceleration = p.limits.deceleration = core::Acceleration{a};
    p.limits.jerk = core::Jerk{j};
    return p;
}

}  // namespace

TEST(AxisMove, RefusesAMoveWhileDisabled) {
    Rig rig;
    rig.cycles(3);
    EXPECT_EQ(rig.refusal(moveTo(10.0)), ErrorId::NotPowered);
}

TEST(AxisMove, EndsExactlyAtTheTarget) {
    Rig rig;
    rig.powerOn();
    const auto id = rig.send(moveTo(123.456));
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().set.count(), 123.456);
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Done);
    EXPECT_EQ(rig.x.status().target, 61728);
}

TEST(AxisMove, TakesTheStepsOfItsDurationRoundedUp) {
    // 100 mm at 100 mm/s, 1000 mm/s², 10000 mm/s³: v/a + a/j + s/v = 0.1 + 0.1 + 1.0 s = 1200
    // cycles.
    Rig rig{symmetric(1000.0, 10000.0)};
    rig.powerOn();
    rig.send(moveTo(100.0));
    EXPECT_EQ(stepsTo(rig, 100.0), 1200);
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion);
    rig.cycle();
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST(AxisMove, RoundsADurationThatIsNotWholeUp) {
    // 100.05 mm: 1.2005 s = 1201 steps of 1 ms.
    Rig rig{symmetric(1000.0, 10000.0)};
    rig.powerOn();
    rig.send(moveTo(100.05));
    EXPECT_EQ(stepsTo(rig, 100.05), 1201);
}

TEST(AxisMove, MovesInTheCycleOfTheCommand) {
    Rig rig;
    rig.powerOn();
    rig.send(moveTo(100.0));
    // Sample 1 of the profile: j·T³/6.
    EXPECT_NEAR(rig.x.status().set.count(), 100000.0 * 1e-9 / 6.0, 1e-12);
}

TEST(AxisMove, IsDoneAtOnceWhenItIsThereAlready) {
    Rig rig;
    rig.powerOn();
    const auto id = rig.send(moveTo(0.0));
    rig.cycle();
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Done);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST(AxisMove, FirstTargetAfterEnablingIsTheActualPosition) {
    Rig rig;
    rig.drive.position = 4711;
    rig.powerOn();
    rig.cycles(5);
    EXPECT_EQ(rig.drive.positionAtEnable, 4711);
    EXPECT_EQ(rig.drive.firstTargetAfterEnable, 4711);
    EXPECT_EQ(rig.x.status().target, 4711);
    EXPECT_EQ(rig.drive.worstStep, 0);
}

TEST(AxisMove, FirstTargetIsTheActualPositionOfAnAxisThatIsBeingPushed) {
    Rig rig;
    rig.drive.drift = 7;
    rig.powerOn();  // ends in the very cycle in which the axis reaches Standstill
    EXPECT_EQ(rig.x.status().target, rig.x.scaling().toCounts(rig.x.status().actual));
    const auto first = rig.x.status().target;
    rig.cycles(10);
    EXPECT_EQ(rig.x.status().target, first);
}

TEST(AxisMove, HoldsTheSetPointWhenTheMotorIsPushedAway) {
    Rig rig;
    rig.powerOn();
    rig.drive.blockedAt = 100;  // 0.2 mm, inside the lag limit
    rig.cycles(200);
    EXPECT_EQ(rig.x.status().target, 0);
    EXPECT_EQ(rig.x.status().set.count(), 0.0);
    EXPECT_NEAR(rig.x.status().lag.count(), -0.2, 1e-12);
}

TEST(AxisMove, ChainsRelativeMovesToTheExactSum) {
    Rig rig;
    rig.powerOn();
    for (int i = 0; i < 5; ++i) {
        rig.send(moveBy(0.25));
        ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    }
    EXPECT_EQ(rig.x.status().set.count(), 1.25);
}

TEST(AxisMove, AbortingMoveTakesOverWithoutAStep) {
    Rig rig;
    rig.powerOn();
    const auto first = rig.send(moveTo(200.0, 400.0));
    rig.cycles(150);
    const auto second = rig.send(moveTo(-50.0, 300.0));
    EXPECT_EQ(rig.status(first).phase, CommandPhase::Aborted);
    EXPECT_EQ(rig.status(second).phase, CommandPhase::Active);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().set.count(), -50.0);
    EXPECT_EQ(rig.status(second).phase, CommandPhase::Done);
}

TEST(AxisMove, KeepsItsLimitsWhenTakenOverAtEveryMoment) {
    // The rig checks the differences of every cycle.
    for (int at = 1; at < 400; at += 13) {
        Rig rig;
        rig.powerOn();
        rig.send(moveTo(100.0, 500.0));
        rig.cycles(at);
        auto c = moveTo(60.0, 120.0);
        c.dynamics.acceleration = core::Acceleration{1500.0};
        c.dynamics.deceleration = core::Acceleration{900.0};
        c.dynamics.jerk = core::Jerk{30000.0};
        rig.send(c);
        ASSERT_TRUE(rig.untilState(AxisState::Standstill)) << at;
        ASSERT_EQ(rig.x.status().set.count(), 60.0) << at;
    }
}

TEST(AxisMove, UsesItsOwnDecelerationWhenItHasToTurnBack) {
    // Aborting into a target that is too near: overshoot and return, never harder than asked.
    Rig rig;
    rig.powerOn();
    rig.send(runAt(400.0));
    ASSERT_TRUE(rig.until([&] { return rig.x.view().inVelocity; }));
    rig.cycles(1);
    const double here = rig.x.status().set.count();
    auto c = moveTo(here + 5.0, 400.0);
    c.dynamics.acceleration = core::Acceleration{3000.0};
    c.dynamics.deceleration = core::Acceleration{1000.0};
    rig.send(c);
    double farthest = here;
    double hardest = 0.0;
    while (rig.x.state() != AxisState::Standstill && rig.k < 20000) {
        rig.cycle();
        farthest = std::max(farthest, rig.x.status().set.count());
        hardest = std::max(hardest, std::abs(rig.x.status().setAcceleration.count()));
    }
    EXPECT_GT(farthest, here + 50.0);
    EXPECT_LE(hardest, 1000.0 * (1.0 + 1e-9));
    EXPECT_EQ(rig.x.status().set.count(), here + 5.0);
}

TEST(AxisMove, SlowsDownWithDecelerationAndSpeedsUpWithAcceleration) {
    for (const double target : {100.0, -100.0}) {
        Rig rig;
        rig.powerOn();
        auto c = moveTo(target, 200.0);
        c.dynamics.acceleration = core::Acceleration{2000.0};
        c.dynamics.deceleration = core::Acceleration{500.0};
        rig.send(c);
        double up = 0.0;
        double down = 0.0;
        const double sign = target < 0.0 ? -1.0 : 1.0;
        while (rig.x.state() != AxisState::Standstill && rig.k < 20000) {
            rig.cycle();
            up = std::max(up, sign * rig.x.status().setAcceleration.count());
            down = std::max(down, -sign * rig.x.status().setAcceleration.count());
        }
        EXPECT_NEAR(up, 2000.0, 1e-6);
        EXPECT_NEAR(down, 500.0, 1e-6);
    }
}

TEST(AxisMove, VelocityMoveReportsInVelocityInTheCycleAfterTheStep) {
    Rig rig{symmetric(1000.0, 10000.0)};
    rig.powerOn();
    rig.send(runAt(100.0));  // v/a + a/j = 0.2 s
    rig.cycles(199);
    EXPECT_EQ(rig.x.status().setVelocity.count(), 100.0);
    EXPECT_FALSE(rig.x.view().inVelocity);
    rig.cycle();
    EXPECT_TRUE(rig.x.view().inVelocity);
    EXPECT_EQ(rig.x.state(), AxisState::ContinuousMotion);
    rig.cycles(1000);
    EXPECT_EQ(rig.x.status().setVelocity.count(), 100.0);
    EXPECT_EQ(rig.x.state(), AxisState::ContinuousMotion);
}

TEST(AxisMove, VelocityZeroStaysInContinuousMotion) {
    Rig rig;
    rig.powerOn();
    const auto id = rig.send(runAt(100.0));
    rig.cycles(500);
    const auto zero = rig.send(runAt(0.0));
    rig.cycles(500);
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Aborted);
    EXPECT_EQ(rig.status(zero).phase, CommandPhase::Active);
    EXPECT_EQ(rig.x.status().setVelocity.count(), 0.0);
    EXPECT_EQ(rig.x.state(), AxisState::ContinuousMotion);
    EXPECT_TRUE(rig.x.view().inVelocity);
}

TEST(AxisMove, VelocityMoveReversesThroughZero) {
    Rig rig;
    rig.powerOn();
    rig.send(runAt(300.0));
    rig.cycles(500);
    rig.send(runAt(-200.0));
    ASSERT_TRUE(rig.until([&] { return rig.x.view().inVelocity; }));
    EXPECT_EQ(rig.x.status().setVelocity.count(), -200.0);
}

TEST(AxisMove, CurrentDirectionKeepsTheDirectionOfThePresentMotion) {
    Rig rig;
    rig.powerOn();
    rig.send(runAt(-100.0));
    rig.cycles(500);
    auto c = runAt(50.0);
    c.direction = axis::Direction::Current;
    rig.send(c);
    rig.cycles(500);
    EXPECT_EQ(rig.x.status().setVelocity.count(), -50.0);
}

TEST(AxisMove, WaitsForTheInPositionWindow) {
    auto p = testParams();
    p.supervision.inPositionWindow = core::Distance{0.01};
    p.supervision.inPositionTime = std::chrono::milliseconds{5};
    Rig rig{p};
    rig.powerOn();
    const auto id = rig.send(moveTo(1.0));
    ASSERT_TRUE(rig.until([&] { return rig.x.status().set.count() == 1.0; }));
    rig.drive.blockedAt = 495;  // 0.99 mm: just outside
    rig.drive.blockedAt = 490;
    rig.cycles(100);
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Active);
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion);
    rig.drive.blockedAt = 500;
    // One cycle until the new position is read, then five cycles inside.
    rig.cycles(5);
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Active);
    rig.cycles(1);
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Done);
}

TEST(AxisMove, RunsOnAcrossTheWrapOfTheDrivesCounts) {
    Rig rig;
    rig.drive.position = 2147483647 - 2000;
    rig.powerOn();
    const double start = rig.x.status().set.count();
    rig.send(moveBy(20.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    rig.cycles(5);
    EXPECT_EQ(rig.drive.position, 2147483647LL - 2000 + 10000);
    EXPECT_LT(rig.x.status().target, 0);
    EXPECT_NEAR(rig.x.status().actual.count() - start, 20.0, 1e-9);
    rig.send(moveBy(-40.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    rig.cycles(5);
    EXPECT_EQ(rig.drive.position, 2147483647LL - 2000 - 10000);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST(AxisMove, KeepsMovingWhenNobodyCalls) {
    Rig rig;
    rig.powerOn();
    rig.send(moveTo(50.0));
    rig.cycles(1500);  // no program at all
    EXPECT_EQ(rig.x.status().set.count(), 50.0);
}

TEST(AxisMove, IsAPureFunctionOfItsInputs) {
    const auto run = [] {
        Rig rig;
        rig.powerOn();
        rig.send(moveTo(77.7, 333.0));
        rig.cycles(120);
        rig.send(moveTo(-3.3, 111.0));
        double hash = 0.0;
        for (int i = 0; i < 1500; ++i) {
            rig.cycle();
            hash = hash * 0.999 + rig.x.status().set.count() + rig.x.status().setVelocity.count();
        }
        return hash;
    };
    EXPECT_EQ(run(), run());
}
