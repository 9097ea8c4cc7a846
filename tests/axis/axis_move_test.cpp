#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;
using axis::CommandPhase;

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
