#include "block_rig.hpp"

using namespace takt;
using namespace takt::test;

namespace {

struct Moving : BlockRig {
    Moving() {
        start();
        run.Velocity = 200.0;
        run.Execute = true;
        calls(300, run, stop);
    }
    MC_MoveVelocity run;
    MC_Stop stop;
};

}  // namespace

TEST(Stop, IsSeenAsStoppingInTheSameCycle) {
    Moving rig;
    rig.stop.Execute = true;
    rig.call(rig.run, rig.stop);
    EXPECT_TRUE(rig.stop.Busy);
    EXPECT_TRUE(rig.status.Stopping);
    EXPECT_TRUE(rig.run.Busy);  // called before the stop
    rig.call(rig.run, rig.stop);
    EXPECT_TRUE(rig.run.CommandAborted);
}

TEST(Stop, LocksTheAxisUntilExecuteFalls) {
    Moving rig;
    rig.stop.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return rig.stop.Done; }, rig.run, rig.stop));
    EXPECT_EQ(rig.x.status().setVelocity.count(), 0.0);
    EXPECT_FALSE(rig.stop.Busy);
    EXPECT_TRUE(rig.stop.Active);
    rig.calls(50, rig.run, rig.stop);
    EXPECT_TRUE(rig.status.Stopping);
    MC_MoveAbsolute move;
    move.Velocity = 10.0;
    move.Execute = true;
    rig.call(rig.stop, move);
    EXPECT_EQ(move.ErrorID, ErrorId::AxisLocked);
    rig.stop.Execute = false;
    rig.call(rig.stop, move);
    EXPECT_TRUE(rig.status.Standstill);  // in the very call in which Execute fell
    EXPECT_FALSE(rig.stop.Done || rig.stop.Active);
}

TEST(Stop, FirstMotionAfterTheLockMayBeInTheSameCycle) {
    Moving rig;
    rig.stop.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return rig.stop.Done; }, rig.run, rig.stop));
    rig.stop.Execute = false;
    MC_MoveRelative move;
    move.Distance = 1.0;
    move.Velocity = 10.0;
    move.Execute = true;
    rig.call(rig.stop, move);
    EXPECT_TRUE(move.Active);
    ASSERT_TRUE(rig.callUntil([&] { return move.Done; }, rig.stop, move));
}

TEST(Stop, ReleasedEarlyShowsDoneForOneCallAndEndsInStandstill) {
    Moving rig;
    rig.stop.Execute = true;
    rig.call(rig.run, rig.stop);
    rig.stop.Execute = false;
    int done = 0;
    for (int i = 0; i < 400; ++i) {
        rig.call(rig.run, rig.stop);
        if (rig.stop.Done) ++done;
    }
    EXPECT_EQ(done, 1);
    EXPECT_TRUE(rig.status.Standstill);
}

TEST(Stop, FromStandstillIsDoneInTheSameCall) {
    BlockRig rig;
    rig.start();
    MC_Stop stop;
    stop.Execute = true;
    rig.call(stop);
    EXPECT_TRUE(stop.Done);
    EXPECT_TRUE(rig.status.Stopping);
    stop.Execute = false;
    rig.call(stop);
    EXPECT_TRUE(rig.status.Standstill);
}

TEST(Stop, FromDisabledIsAnError) {
    BlockRig rig;
    MC_Stop stop;
    stop.Execute = true;
    rig.call(stop);
    EXPECT_EQ(stop.ErrorID, ErrorId::InvalidState);
}

TEST(Stop, SecondInstanceIsLockedOut) {
    Moving rig;
    MC_Stop other;
    rig.stop.Execute = other.Execute = true;
    rig.call(rig.stop, other);
    EXPECT_TRUE(rig.stop.Busy);
    EXPECT_EQ(other.ErrorID, ErrorId::AxisLocked);
    other.Execute = false;  // and its falling edge unlocks nothing
    ASSERT_TRUE(rig.callUntil([&] { return rig.stop.Done; }, rig.stop, other));
    EXPECT_TRUE(rig.status.Stopping);
}

TEST(Stop, RetriggerOfTheSameInstanceTakesTheNewDeceleration) {
    Moving rig;
    rig.stop.Deceleration = 100.0;
    rig.stop.Execute = true;
    rig.calls(10, rig.stop);
    rig.stop.Execute = false;
    rig.call(rig.stop);
    rig.stop.Deceleration = 0.0;
    rig.stop.Execute = true;
    int n = 0;
    while (!rig.stop.Done && n < 1000) {
        rig.call(rig.stop);
        EXPECT_FALSE(rig.stop.CommandAborted);
        ++n;
    }
    EXPECT_LT(n, 100);
    rig.calls(10, rig.stop);
    EXPECT_TRUE(rig.status.Stopping);  // Execute is TRUE: locked
}

TEST(Stop, PowerOffAbortsIt) {
    Moving rig;
    rig.stop.Execute = true;
    rig.calls(3, rig.stop);
    rig.power.Enable = false;
    rig.calls(1, rig.stop);
    EXPECT_TRUE(rig.stop.CommandAborted);
    ASSERT_TRUE(rig.callUntil([&] { return rig.status.Disabled; }, rig.stop));
}

TEST(Stop, AxisErrorIsAnErrorOfTheBlock) {
    Moving rig;
    rig.stop.Execute = true;
    rig.calls(3, rig.stop);
    rig.drive.faultCode = 1;
    rig.calls(2, rig.stop);
    EXPECT_EQ(rig.stop.ErrorID, ErrorId::DriveFault);
}

TEST(Halt, IsDoneInStandstillAtOnce) {
    BlockRig rig;
    rig.start();
    MC_Halt halt;
    halt.Execute = true;
    rig.call(halt);
    EXPECT_TRUE(halt.Done);
    EXPECT_TRUE(rig.status.Standstill);
}

TEST(Halt, MovesThroughDiscreteMotionToStandstill) {
    Moving rig;
    MC_Halt halt;
    halt.Execute = true;
    rig.call(rig.run, halt);
    EXPECT_TRUE(halt.Active);
    EXPECT_TRUE(rig.status.DiscreteMotion);
    ASSERT_TRUE(rig.callUntil([&] { return halt.Done; }, rig.run, halt));
    EXPECT_TRUE(rig.status.Standstill);
    EXPECT_EQ(rig.x.status().setVelocity.count(), 0.0);
}

TEST(Halt, IsAbortedByAMoveBeforeVelocityZero) {
    Moving rig;
    MC_Halt halt;
    halt.Execute = true;
    rig.calls(20, rig.run, halt);
    MC_MoveVelocity again;
    again.Velocity = 200.0;
    again.Execute = true;
    rig.call(again, halt);
    EXPECT_TRUE(halt.CommandAborted);
    double slowest = 1e9;
    for (int i = 0; i < 200; ++i) {
        rig.call(again, halt);
        slowest = std::min(slowest, rig.x.status().setVelocity.count());
    }
    EXPECT_GT(slowest, 0.0);
    EXPECT_TRUE(again.InVelocity);
}
