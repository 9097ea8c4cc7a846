#include <limits>

#include "block_rig.hpp"

using namespace takt;
using namespace takt::test;

TEST(Execute, AnswersInTheCallOfTheEdge) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute move;
    setMove(move, 10.0);
    move.Execute = true;
    rig.call(move);
    EXPECT_TRUE(move.Busy);
    EXPECT_TRUE(move.Active);
    EXPECT_TRUE(rig.status.DiscreteMotion);  // called after it in the same cycle
    EXPECT_FALSE(rig.status.Standstill);
}

TEST(Execute, NothingHappensWithoutAnEdge) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute move;
    setMove(move, 10.0);
    rig.calls(10, move);
    EXPECT_FALSE(move.Busy || move.Done || move.Error || move.CommandAborted || move.Active);
    EXPECT_TRUE(rig.status.Standstill);
}

TEST(Execute, LevelAloneDoesNotStartAgain) {
    BlockRig rig;
    rig.start();
    MC_MoveRelative move;
    move.Distance = 5.0;
    move.Velocity = 100.0;
    move.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return move.Done; }, move));
    rig.calls(500, move);
    EXPECT_TRUE(move.Done);
    EXPECT_EQ(rig.x.status().set.count(), 5.0);
    move.Execute = false;
    rig.call(move);
    EXPECT_FALSE(move.Done);
}

TEST(Execute, InputsAreSampledAtTheEdge) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute move;
    setMove(move, 10.0);
    move.Execute = true;
    rig.call(move);
    setMove(move, 99.0, 300.0);
    ASSERT_TRUE(rig.callUntil([&] { return move.Done; }, move));
    EXPECT_EQ(rig.x.status().set.count(), 10.0);
}

TEST(Execute, DoneIsShownForExactlyOneCallAfterAnEarlyFall) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute move;
    setMove(move, 10.0);
    move.Execute = true;
    rig.call(move);
    move.Execute = false;
    rig.call(move);
    EXPECT_TRUE(move.Busy);
    int shown = 0;
    for (int i = 0; i < 3000; ++i) {
        rig.call(move);
        if (move.Done) ++shown;
    }
    EXPECT_EQ(shown, 1);
    EXPECT_EQ(rig.x.status().set.count(), 10.0);
}

TEST(Execute, ErrorIsShownForExactlyOneCallAfterAPulse) {
    BlockRig rig;  // Disabled
    MC_MoveAbsolute move;
    setMove(move, 10.0);
    move.Execute = true;
    rig.call(move);
    EXPECT_TRUE(move.Error);
    EXPECT_EQ(move.ErrorID, ErrorId::NotPowered);
    move.Execute = false;
    rig.call(move);
    EXPECT_FALSE(move.Error);
    EXPECT_EQ(move.ErrorID, ErrorId::None);
}

TEST(Execute, DoneComesInTheCycleAfterTheLastStep) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute move;
    setMove(move, 10.0);
    move.Execute = true;
    while (rig.x.status().set.count() != 10.0) {
        rig.call(move);
        ASSERT_TRUE(move.Busy);
    }
    rig.call(move);
    EXPECT_TRUE(move.Done);
    EXPECT_TRUE(rig.status.Standstill);
}

TEST(Execute, RetriggerWhileBusyStartsAnewWithoutAWordOfTheOld) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute move;
    setMove(move, 100.0);
    move.Execute = true;
    rig.calls(200, move);
    move.Execute = false;
    rig.call(move);
    setMove(move, 30.0);
    move.Execute = true;
    int done = 0;
    for (int i = 0; i < 3000; ++i) {
        rig.call(move);
        EXPECT_FALSE(move.CommandAborted);
        if (move.Done) ++done;
        if (i == 0) {
            EXPECT_TRUE(move.Busy);
        }
    }
    EXPECT_GT(done, 1);  // Execute stays TRUE, so Done stays
    EXPECT_EQ(rig.x.status().set.count(), 30.0);
}

TEST(Execute, BufferedRetriggerOfABusyInstanceIsRefused) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute move;
    setMove(move, 50.0);
    move.Execute = true;
    rig.call(move);
    move.Execute = false;
    rig.call(move);
    move.BufferMode = MC_BUFFER_MODE::mcBuffered;
    setMove(move, 80.0);
    move.Execute = true;
    rig.call(move);
    EXPECT_EQ(move.ErrorID, ErrorId::InstanceBusy);
    rig.calls(2000, move);
    EXPECT_EQ(rig.x.status().set.count(), 50.0);  // the running motion was left alone
}

TEST(Execute, AbortedInstanceCalledLaterShowsItInTheSameCycle) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute first;
    MC_MoveAbsolute second;
    setMove(first, 100.0);
    setMove(second, 20.0);
    first.Execute = true;
    rig.calls(50, second, first);
    second.Execute = true;
    rig.call(second, first);
    EXPECT_TRUE(second.Active);
    EXPECT_TRUE(first.CommandAborted);
}

TEST(Execute, AbortedInstanceCalledEarlierShowsItInTheNextCycle) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute first;
    MC_MoveAbsolute second;
    setMove(first, 100.0);
    setMove(second, 20.0);
    first.Execute = true;
    rig.calls(50, first, second);
    second.Execute = true;
    rig.call(first, second);
    EXPECT_TRUE(first.Busy);
    EXPECT_TRUE(second.Active);
    rig.call(first, second);
    EXPECT_TRUE(first.CommandAborted);
}

TEST(Execute, AbortedIsShownForExactlyOneCallAfterAnEarlyFall) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute first;
    MC_MoveAbsolute second;
    setMove(first, 100.0);
    setMove(second, 20.0);
    first.Execute = true;
    rig.call(first, second);
    first.Execute = false;
    rig.calls(10, first, second);
    second.Execute = true;
    int shown = 0;
    for (int i = 0; i < 20; ++i) {
        rig.call(first, second);
        if (first.CommandAborted) ++shown;
    }
    EXPECT_EQ(shown, 1);
}

TEST(Execute, MotionGoesOnWhenTheInstanceIsNotCalled) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute move;
    setMove(move, 10.0);
    move.Execute = true;
    rig.call(move);
    rig.calls(2000);
    EXPECT_EQ(rig.x.status().set.count(), 10.0);
    rig.call(move);
    EXPECT_TRUE(move.Done);
}

TEST(Execute, AnInvalidReferenceIsAnError) {
    MC_MoveAbsolute move;
    MC_Stop stop;
    MC_Halt halt;
    MC_Home home;
    MC_Reset reset;
    MC_MoveVelocity velocity;
    const auto check = [](auto& block) {
        block.Execute = true;
        block(axis::AxisRef{});
        EXPECT_TRUE(block.Error);
        EXPECT_FALSE(block.Busy);
        EXPECT_EQ(block.ErrorID, ErrorId::NullReference);
        block.Execute = false;
        block(axis::AxisRef{});
        EXPECT_FALSE(block.Error);
    };
    check(move);
    check(stop);
    check(halt);
    check(home);
    check(reset);
    check(velocity);
}

TEST(Execute, AReferenceThatBecomesInvalidEndsTheBlock) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute move;
    setMove(move, 10.0);
    move.Execute = true;
    rig.call(move);
    rig.port.invalidate();
    rig.call(move);
    EXPECT_EQ(move.ErrorID, ErrorId::NullReference);
}

TEST(Execute, ErrorsOfABlockLeaveTheRunningMotionAlone) {
    BlockRig rig;
    BlockRig same;
    MC_MoveAbsolute run;
    MC_MoveAbsolute runSame;
    for (auto* pair : {&rig, &same}) pair->start();
    setMove(run, 80.0);
    setMove(runSame, 80.0);
    run.Execute = runSame.Execute = true;
    rig.calls(100, run);
    same.calls(100, runSame);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, inf, -inf, 1e300}) {
        MC_MoveAbsolute move;
        setMove(move, bad);
        move.Execute = true;
        rig.call(run, move);
        same.call(runSame);
        EXPECT_TRUE(move.Error) << bad;
        EXPECT_TRUE(run.Active);
        MC_MoveVelocity velocity;
        velocity.Velocity = bad;
        velocity.Execute = true;
        rig.call(run, velocity);
        same.call(runSame);
        EXPECT_TRUE(velocity.Error) << bad;
        MC_Halt halt;
        halt.Deceleration = bad;
        halt.Execute = true;
        rig.call(run, halt);
        same.call(runSame);
        EXPECT_TRUE(halt.Error) << bad;
    }
    for (int i = 0; i < 1500; ++i) {
        rig.call(run);
        same.call(runSame);
        ASSERT_EQ(rig.x.status().set.count(), same.x.status().set.count());
    }
    EXPECT_TRUE(run.Done);
}

TEST(Execute, AxisErrorIsShownInTheCycleItIsDetected) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute run;
    MC_MoveAbsolute queued;
    setMove(run, 80.0);
    setMove(queued, 90.0);
    queued.BufferMode = MC_BUFFER_MODE::mcBuffered;
    run.Execute = queued.Execute = true;
    rig.calls(100, run, queued);
    EXPECT_TRUE(run.Active);
    EXPECT_TRUE(queued.Busy && !queued.Active);
    rig.drive.faultCode = 0x8611;
    rig.call(run, queued);
    EXPECT_TRUE(run.Active);
    rig.call(run, queued);
    EXPECT_TRUE(run.Error);
    EXPECT_EQ(run.ErrorID, ErrorId::DriveFault);
    EXPECT_EQ(queued.ErrorID, ErrorId::DriveFault);
    EXPECT_TRUE(rig.status.ErrorStop);
}
