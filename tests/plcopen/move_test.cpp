#include "block_rig.hpp"

using namespace takt;
using namespace takt::test;

TEST(Buffered, SecondIsActiveInTheCycleTheFirstIsDone) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute first;
    MC_MoveAbsolute second;
    setMove(first, 10.0);
    setMove(second, 20.0);
    second.BufferMode = MC_BUFFER_MODE::mcBuffered;
    first.Execute = second.Execute = true;
    rig.call(first, second);
    EXPECT_TRUE(second.Busy);
    EXPECT_FALSE(second.Active);
    ASSERT_TRUE(rig.callUntil([&] { return first.Done; }, first, second));
    EXPECT_TRUE(second.Active);
    EXPECT_TRUE(rig.status.DiscreteMotion);
    ASSERT_TRUE(rig.callUntil([&] { return second.Done; }, first, second));
    EXPECT_EQ(rig.x.status().set.count(), 20.0);
}

TEST(Buffered, HaltBehindAMove) {
    BlockRig rig;
    rig.start();
    MC_MoveVelocity run;
    MC_Halt halt;
    run.Velocity = 100.0;
    halt.BufferMode = MC_BUFFER_MODE::mcBuffered;
    run.Execute = halt.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return halt.Done; }, run, halt));
    EXPECT_TRUE(run.CommandAborted);
    EXPECT_TRUE(rig.status.Standstill);
}

TEST(MoveVelocity, InVelocityIsIndependentOfExecute) {
    BlockRig rig;
    rig.start();
    MC_MoveVelocity run;
    run.Velocity = 100.0;
    run.Execute = true;
    rig.call(run);
    EXPECT_TRUE(rig.status.ContinuousMotion);
    run.Execute = false;
    ASSERT_TRUE(rig.callUntil([&] { return run.InVelocity; }, run));
    rig.calls(100, run);
    EXPECT_TRUE(run.InVelocity && run.Busy && run.Active);
    MC_MoveVelocity other;
    other.Velocity = 50.0;
    other.Execute = true;
    rig.call(other, run);
    EXPECT_TRUE(run.CommandAborted);
    EXPECT_FALSE(run.InVelocity);
    EXPECT_FALSE(other.InVelocity);
    rig.call(other, run);
    EXPECT_FALSE(run.CommandAborted);
    ASSERT_TRUE(rig.callUntil([&] { return other.InVelocity; }, other));
}

TEST(MoveVelocity, NegativeVelocityInNegativeDirectionIsPositive) {
    BlockRig rig;
    rig.start();
    MC_MoveVelocity run;
    run.Velocity = -10.0;
    run.Direction = MC_DIRECTION::mcNegativeDirection;
    run.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return run.InVelocity; }, run));
    EXPECT_EQ(rig.x.status().setVelocity.count(), 10.0);
}

TEST(MoveVelocity, ShortestWayIsAnError) {
    BlockRig rig;
    rig.start();
    MC_MoveVelocity run;
    run.Velocity = 10.0;
    run.Direction = MC_DIRECTION::mcShortestWay;
    run.Execute = true;
    rig.call(run);
    EXPECT_EQ(run.ErrorID, ErrorId::DirectionInvalid);
}

TEST(MoveVelocity, StoppedAtASoftwareLimitShowsWhy) {
    auto p = testParams();
    p.limits.softPositive = core::Position{50.0};
    BlockRig rig{p};
    rig.start();
    MC_MoveVelocity run;
    run.Velocity = 200.0;
    run.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return run.Error; }, run));
    EXPECT_EQ(run.ErrorID, ErrorId::SWLimitReached);
    ASSERT_TRUE(rig.callUntil([&] { return rig.status.Standstill; }, run));
    EXPECT_EQ(rig.x.status().set.count(), 50.0);
}

TEST(Home, HomesFromStandstillOnly) {
    BlockRig rig;
    rig.start();
    MC_MoveVelocity run;
    MC_Home home;
    home.Position = 7.0;
    run.Velocity = 10.0;
    run.Execute = true;
    rig.call(run, home);
    home.Execute = true;
    rig.call(run, home);
    EXPECT_EQ(home.ErrorID, ErrorId::InvalidState);
    home.Execute = false;
    MC_Halt halt;
    halt.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return halt.Done; }, run, home, halt));
    home.Execute = true;
    rig.call(run, home, halt);
    EXPECT_TRUE(home.Active);
    EXPECT_TRUE(rig.status.Homing);
    ASSERT_TRUE(rig.callUntil([&] { return home.Done; }, run, home, halt));
    EXPECT_TRUE(rig.status.Standstill);
    MC_ReadActualPosition read;
    read.Enable = true;
    rig.call(read);
    EXPECT_EQ(read.Position, 7.0);
}
