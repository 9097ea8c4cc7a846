#include "block_rig.hpp"

using namespace takt;
using namespace takt::test;

TEST(Power, StatusAndStandstillComeInTheSameCall) {
    BlockRig rig;
    rig.power.Enable = rig.status.Enable = true;
    for (int i = 0; i < 50 && !rig.power.Status; ++i) {
        rig.call();
        EXPECT_EQ(rig.power.Status, rig.status.Standstill);
        EXPECT_EQ(rig.power.Status, (rig.x.status().statusword & 0x6FU) == 0x27U);
    }
    EXPECT_TRUE(rig.power.Status && rig.power.Valid);
}

TEST(Power, OffAbortsTheRunningMoveAndEndsInDisabled) {
    BlockRig rig;
    rig.start();
    MC_MoveVelocity run;
    run.Velocity = 200.0;
    run.Execute = true;
    rig.calls(300, run);
    rig.power.Enable = false;
    rig.call(run);
    EXPECT_TRUE(run.CommandAborted);
    EXPECT_TRUE(rig.status.Stopping);
    EXPECT_TRUE(rig.power.Status);
    MC_MoveAbsolute move;
    move.Velocity = 10.0;
    move.Execute = true;
    rig.call(run, move);
    EXPECT_EQ(move.ErrorID, ErrorId::AxisLocked);
    ASSERT_TRUE(rig.callUntil([&] { return rig.status.Disabled; }, run));
    ASSERT_TRUE(rig.callUntil([&] { return !rig.power.Status; }, run));
    EXPECT_FALSE(rig.power.Error);
}

TEST(Power, LostPowerIsAnErrorUntilTheReset) {
    BlockRig rig;
    rig.start();
    rig.drive.enableInput = false;
    rig.calls(2);
    EXPECT_TRUE(rig.power.Error);
    EXPECT_FALSE(rig.power.Status);
    EXPECT_EQ(rig.power.ErrorID, ErrorId::PowerLost);
    EXPECT_TRUE(rig.status.ErrorStop);
    rig.drive.enableInput = true;
    rig.calls(100);
    EXPECT_TRUE(rig.status.ErrorStop);
    MC_Reset reset;
    reset.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return reset.Done; }, reset));
    EXPECT_TRUE(rig.status.Disabled || rig.status.Standstill);
    EXPECT_FALSE(rig.power.Error);
    ASSERT_TRUE(rig.callUntil([&] { return rig.status.Standstill; }, reset));
}

TEST(Power, TheLastOfSeveralInstancesWins) {
    BlockRig rig;
    rig.start();
    MC_Power second;
    second.Enable = false;
    rig.calls(20, second);  // called after rig.power
    EXPECT_TRUE(rig.status.Disabled);
}

TEST(Power, AnInvalidReferenceIsAnError) {
    MC_Power power;
    power.Enable = true;
    power(axis::AxisRef{});
    EXPECT_TRUE(power.Error);
    EXPECT_EQ(power.ErrorID, ErrorId::NullReference);
    power.Enable = false;
    power(axis::AxisRef{});
    EXPECT_FALSE(power.Error);
}

TEST(Reset, OutsideErrorStopIsDoneAtOnce) {
    BlockRig rig;
    rig.start();
    MC_Reset reset;
    reset.Execute = true;
    rig.call(reset);
    EXPECT_TRUE(reset.Done);
    EXPECT_TRUE(rig.status.Standstill);
}

TEST(Reset, TakesOneCycleWhenNothingHasToBeWaitedFor) {
    BlockRig rig;
    rig.start();
    rig.drive.blockedAt = 1000;  // 2 mm of lag
    ASSERT_TRUE(rig.callUntil([&] { return rig.status.ErrorStop; }));
    rig.drive.blockedAt = 0;
    rig.calls(10);
    MC_Reset reset;
    reset.Execute = true;
    rig.call(reset);
    EXPECT_TRUE(reset.Busy);
    rig.call(reset);
    EXPECT_TRUE(reset.Done);
    EXPECT_TRUE(rig.status.Standstill);
}

TEST(Reset, ShowsTheCauseThatIsStillThere) {
    BlockRig rig;
    rig.start();
    rig.drive.blockedAt = 1000;
    ASSERT_TRUE(rig.callUntil([&] { return rig.status.ErrorStop; }));
    rig.calls(10);
    MC_Reset reset;
    reset.Execute = true;
    rig.calls(2, reset);
    EXPECT_EQ(reset.ErrorID, ErrorId::LagExceeded);
    EXPECT_TRUE(rig.status.ErrorStop);
}

TEST(Power, SaysThatTheMachineStopBarsItUntilEnableFallsAndRisesAfterTheReset) {
    BlockRig rig;
    rig.start();
    const auto stopped = [&rig] {
        rig.call();
        rig.x.machineStop();
        return rig.x.isDisabled();
    };
    for (int i = 0; i < 100 && !stopped(); ++i) {
    }
    ASSERT_TRUE(rig.x.isDisabled());
    rig.call();
    EXPECT_EQ(rig.power.ErrorID, ErrorId::MachineStopped);
    rig.x.releaseMachineStop();
    rig.calls(50);
    EXPECT_EQ(rig.power.ErrorID, ErrorId::MachineStopped);  // the level alone switches nothing on
    EXPECT_FALSE(rig.power.Status);
    rig.power.Enable = false;
    rig.call();
    EXPECT_FALSE(rig.power.Error);
    rig.power.Enable = true;
    EXPECT_TRUE(rig.callUntil([&] { return rig.power.Status; }));
}
