#include <limits>

#include "block_rig.hpp"

using namespace takt;
using namespace takt::test;

namespace {

void setMove(MC_MoveAbsolute& move, double position, double velocity = 100.0) {
    move.Position = position;
    move.Velocity = velocity;
}

}  // namespace

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

TEST(Read, PositionIsFoldedOnAModuloAxis) {
    auto p = testParams();
    p.scaling.countsPerTurn = 36000;
    p.scaling.unitsPerTurnNumerator = 360;
    p.scaling.modulo = core::Distance{360.0};
    BlockRig rig{p};
    rig.drive.position = -1000;
    rig.start();
    MC_ReadActualPosition read;
    read.Enable = true;
    rig.call(read);
    EXPECT_TRUE(read.Valid && read.Busy);
    EXPECT_NEAR(read.Position, 350.0, 1e-9);
    read.Enable = false;
    rig.call(read);
    EXPECT_FALSE(read.Valid || read.Busy);
    EXPECT_EQ(read.Position, 0.0);
}

TEST(Read, PositionIsNotValidWithoutABus) {
    BlockRig rig;
    rig.drive.health.operational = false;
    MC_ReadActualPosition read;
    read.Enable = true;
    rig.call(read);
    EXPECT_FALSE(read.Valid || read.Error);
    EXPECT_TRUE(read.Busy);
    rig.drive.health.operational = true;
    rig.call(read);
    EXPECT_TRUE(read.Valid);
}

TEST(Read, ExactlyOneStateIsTrueWhileValid) {
    BlockRig rig;
    rig.start();
    MC_MoveAbsolute move;
    setMove(move, 30.0);
    move.Execute = true;
    MC_Stop stop;
    for (int i = 0; i < 400; ++i) {
        if (i == 100) stop.Execute = true;
        if (i == 250) rig.drive.faultCode = 1;
        rig.call(move, stop);
        const auto& s = rig.status;
        ASSERT_TRUE(s.Valid);
        ASSERT_EQ(int{s.ErrorStop} + int{s.Disabled} + int{s.Stopping} + int{s.Homing} +
                      int{s.Standstill} + int{s.DiscreteMotion} + int{s.ContinuousMotion} +
                      int{s.SynchronizedMotion},
                  1);
    }
    EXPECT_TRUE(rig.status.ErrorStop);
}

TEST(Read, AWrongReferenceStaysAnErrorUntilEnableRisesAgain) {
    BlockRig rig;
    rig.start();
    MC_ReadStatus read;
    read.Enable = true;
    read(axis::AxisRef{});
    EXPECT_TRUE(read.Error);
    EXPECT_FALSE(read.Valid || read.Busy);
    read(rig.axisX);
    EXPECT_TRUE(read.Error);
    read.Enable = false;
    read(rig.axisX);
    EXPECT_FALSE(read.Error);
    read.Enable = true;
    read(rig.axisX);
    EXPECT_TRUE(read.Valid);
}

TEST(Read, AxisErrorNamesCauseAndDriveCode) {
    BlockRig rig;
    rig.start();
    MC_ReadAxisError read;
    read.Enable = true;
    rig.call(read);
    EXPECT_TRUE(read.Valid);
    EXPECT_EQ(read.ErrorID, ErrorId::None);
    rig.drive.faultCode = 0x7305;
    rig.calls(2, read);
    EXPECT_TRUE(read.Valid);
    EXPECT_FALSE(read.Error);
    EXPECT_EQ(read.ErrorID, ErrorId::DriveFault);
    EXPECT_EQ(read.AxisErrorID, 0x7305);
}
