#include "block_rig.hpp"

using namespace takt;
using namespace takt::test;

namespace {

void setRelative(MC_MoveRelative& move, double distance, double velocity) {
    move.Distance = distance;
    move.Velocity = velocity;
}

}  // namespace

TEST(MoveAdditive, CountsFromTheTargetThatWasCommandedWhateverTheMoment) {
    for (const int later : {1, 100, 700, 1290, 1400}) {
        BlockRig rig;
        rig.start();
        MC_MoveRelative first;
        MC_MoveAdditive add;
        setRelative(first, 600.0, 500.0);
        add.Distance = 400.0;
        add.Velocity = 500.0;
        first.Execute = true;
        rig.calls(later, first, add);
        add.Execute = true;
        rig.call(first, add);
        EXPECT_TRUE(add.Active);
        EXPECT_TRUE(rig.status.DiscreteMotion);
        ASSERT_TRUE(rig.callUntil([&] { return add.Done; }, first, add));
        EXPECT_EQ(rig.x.status().set.count(), 1000.0) << later;
    }
}

TEST(MoveAdditive, CountsFromATargetOfTheSameCycle) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute first;
    MC_MoveAdditive add;
    setMove(first, 60.0);
    add.Distance = 40.0;
    add.Velocity = 100.0;
    first.Execute = add.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return add.Done; }, first, add));
    EXPECT_TRUE(first.CommandAborted);
    EXPECT_EQ(rig.x.status().set.count(), 100.0);
}

TEST(MoveAdditive, CountsFromTheSetPositionOfAContinuousMotion) {
    BlockRig rig;
    rig.start();
    MC_MoveVelocity run;
    MC_MoveAdditive add;
    run.Velocity = 100.0;
    run.Execute = true;
    rig.calls(1000, run, add);
    const double at = rig.x.status().set.count();
    add.Distance = 40.0;
    add.Velocity = 100.0;
    add.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return add.Done; }, run, add));
    EXPECT_EQ(rig.x.status().set.count(), at + 40.0);
}

TEST(MoveAdditive, BufferedAddsToTheEndOfTheMoveBefore) {
    for (const auto mode : {MC_BUFFER_MODE::mcBuffered, MC_BUFFER_MODE::mcBlendingHigh}) {
        BlockRig rig;
        rig.start();
        MC_MoveAbsolute first;
        MC_MoveAdditive add;
        setMove(first, 60.0);
        add.Distance = 40.0;
        add.Velocity = 100.0;
        add.BufferMode = mode;
        first.Execute = add.Execute = true;
        ASSERT_TRUE(rig.callUntil([&] { return add.Done; }, first, add));
        EXPECT_TRUE(first.Done);
        EXPECT_EQ(rig.x.status().set.count(), 100.0);
    }
}

TEST(MoveAdditive, RefusesASumBehindTheSoftwareLimit) {
    auto p = testParams();
    p.limits.softPositive = core::Position{90.0};
    BlockRig rig{p};
    rig.start();
    MC_MoveAbsolute first;
    MC_MoveAdditive add;
    setMove(first, 60.0);
    first.Execute = true;
    rig.calls(10, first, add);
    add.Distance = 40.0;
    add.Velocity = 100.0;
    add.Execute = true;
    rig.call(first, add);
    EXPECT_EQ(add.ErrorID, ErrorId::TargetOutsideSWLimit);
    EXPECT_TRUE(first.Active);
}

TEST(MoveContinuous, ReachesThePositionAtTheEndVelocityAndKeepsIt) {
    for (const double end : {20.0, 100.0, 250.0}) {  // below, at and above Velocity
        for (const double sign : {1.0, -1.0}) {
            BlockRig rig;
            rig.start();
            MC_MoveContinuousAbsolute move;
            move.Position = sign * 200.0;
            move.Velocity = 100.0;
            move.EndVelocity = sign * end;
            move.Execute = true;
            rig.call(move);
            EXPECT_TRUE(rig.status.ContinuousMotion);
            ASSERT_TRUE(rig.callUntil([&] { return move.InEndVelocity; }, move)) << end;
            // Seen in the call behind the first cycle at or past the position.
            const double past = sign * rig.x.status().set.count() - 200.0;
            EXPECT_GE(past, 0.0);
            EXPECT_LE(past, 2.0 * end * 0.001 * (1.0 + 1e-9));
            EXPECT_EQ(rig.x.status().setVelocity.count(), sign * end);
            const double from = rig.x.status().set.count();
            rig.calls(100, move);
            EXPECT_NEAR(rig.x.status().set.count() - from, sign * end * 0.1, 1e-9);
            EXPECT_TRUE(move.InEndVelocity && move.Busy && move.Active);
        }
    }
}

TEST(MoveContinuous, RelativeCountsFromTheSetPosition) {
    BlockRig rig;
    rig.start();
    MC_MoveVelocity run;
    MC_MoveContinuousRelative move;
    run.Velocity = 100.0;
    run.Execute = true;
    rig.calls(500, run, move);
    const double at = rig.x.status().set.count();
    move.Distance = 50.0;
    move.Velocity = 100.0;
    move.EndVelocity = 40.0;
    move.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return move.InEndVelocity; }, run, move));
    EXPECT_TRUE(run.CommandAborted);
    const double past = rig.x.status().set.count() - (at + 50.0);
    EXPECT_GE(past, 0.0);
    EXPECT_LE(past, 0.08 + 1e-9);
}

TEST(MoveContinuous, PassesThePositionBackwardForAnEndVelocityAgainstTheWay) {
    BlockRig rig;
    rig.start();
    MC_MoveContinuousAbsolute move;
    move.Position = 100.0;
    move.Velocity = 100.0;
    move.EndVelocity = -30.0;
    move.Execute = true;
    double highest = 0.0;
    for (int i = 0; i < 5000 && !move.InEndVelocity; ++i) {
        rig.call(move);
        highest = std::max(highest, rig.x.status().set.count());
    }
    EXPECT_TRUE(move.InEndVelocity);
    EXPECT_GT(highest, 100.0);
    EXPECT_NEAR(rig.x.status().set.count(), 100.0, 0.07);
    EXPECT_EQ(rig.x.status().setVelocity.count(), -30.0);
}

TEST(MoveContinuous, RefusesAWayTooShortForItsEndVelocity) {
    BlockRig rig;
    rig.start();
    MC_MoveContinuousRelative move;
    move.Distance = 1.0;
    move.Velocity = 400.0;
    move.EndVelocity = 400.0;
    move.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return move.Error; }, move));
    EXPECT_EQ(move.ErrorID, ErrorId::ProfileNotFeasible);
    rig.calls(5, move);
    EXPECT_EQ(rig.x.status().set.count(), 0.0);
    EXPECT_TRUE(rig.status.Standstill);
}

TEST(MoveContinuous, RefusesAnEndVelocityThatIsNoneOrAboveTheLimit) {
    BlockRig rig;
    rig.start();
    MC_MoveContinuousAbsolute move;
    move.Position = 100.0;
    move.Velocity = 100.0;
    move.EndVelocity = 500.1;
    move.Execute = true;
    rig.call(move);
    EXPECT_EQ(move.ErrorID, ErrorId::LimitExceeded);
    move.Execute = false;
    rig.call(move);
    move.EndVelocity = std::numeric_limits<double>::quiet_NaN();
    move.Execute = true;
    rig.call(move);
    EXPECT_EQ(move.ErrorID, ErrorId::NotFinite);
}

TEST(MoveContinuous, TakesOverFromAMoveWithoutAStop) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute first;
    MC_MoveContinuousRelative move;
    setMove(first, 100.0);
    move.Distance = 100.0;
    move.Velocity = 50.0;
    move.EndVelocity = 30.0;
    move.BufferMode = MC_BUFFER_MODE::mcBlendingLow;
    first.Execute = move.Execute = true;
    double slowest = 1e9;
    for (int i = 0; i < 9000 && !move.InEndVelocity; ++i) {
        rig.call(first, move);
        const auto s = rig.x.status();
        if (s.set.count() > 50.0) slowest = std::min(slowest, s.setVelocity.count());
    }
    EXPECT_TRUE(first.Done && move.InEndVelocity);
    EXPECT_NEAR(slowest, 30.0, 1e-9);
}

TEST(MoveContinuous, StopsAtASoftwareLimit) {
    auto p = testParams();
    p.limits.softPositive = core::Position{150.0};
    BlockRig rig{p};
    rig.start();
    MC_MoveContinuousAbsolute move;
    move.Position = 100.0;
    move.Velocity = 100.0;
    move.EndVelocity = 60.0;
    move.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return move.Error; }, move));
    EXPECT_EQ(move.ErrorID, ErrorId::SWLimitReached);
    ASSERT_TRUE(rig.callUntil([&] { return rig.status.Standstill; }, move));
    EXPECT_EQ(rig.x.status().set.count(), 150.0);
}
