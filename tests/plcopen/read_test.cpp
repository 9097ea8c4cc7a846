#include "block_rig.hpp"

using namespace takt;
using namespace takt::test;

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
