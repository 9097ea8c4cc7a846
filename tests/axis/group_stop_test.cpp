#include <gtest/gtest.h>

#include "group_rig.hpp"

namespace takt::test {
namespace {

using axis::CommandPhase;
using Kind = GroupCommandKind;

constexpr double Radius = 20.0;

/// Distance from the circle on which the group goes in these tests.
double offCircle(const GroupPoint& p) {
    return std::abs(std::hypot(p[0], p[1] - Radius) - Radius) + std::abs(p[2]);
}

/// On a full circle in XY about (0, 20), somewhere in the middle of it.
class OnACircle : public testing::Test {
protected:
    void SetUp() override {
        rig.start();
        circle = rig.send(arcTo(axis::CircMode::Center, {0.0, Radius}, {0.0, 0.0, 0.0}));
        rig.cycles(250);
        ASSERT_EQ(rig.phase(circle), CommandPhase::Active);
        ASSERT_GT(rig.group.status().velocity.count(), 50.0);
    }
    /// Runs until `condition`, and never leaves the circle.
    template <typename Condition>
    bool untilOnCircle(Condition&& condition) {
        for (int i = 0; i < 1000 && !condition(); ++i) {
            rig.cycle();
            EXPECT_LT(offCircle(rig.set()), 1e-9) << "cycle " << rig.k;
        }
        return condition();
    }
    bool atRest() {
        const bool moved = rig.set() != last_;
        last_ = rig.set();
        return !moved;
    }
    GroupRig rig;
    axis::CommandId circle{};

private:
    GroupPoint last_{};
};

TEST_F(OnACircle, GroupStopStaysOnThePathAndHoldsTheGroup) {
    GroupCommand stop = groupCommand(Kind::Stop);
    const auto id = rig.send(stop);
    EXPECT_EQ(rig.group.state(), GroupState::Stopping);
    rig.cycle();
    EXPECT_EQ(rig.phase(circle), CommandPhase::Aborted);
    ASSERT_TRUE(untilOnCircle([&] { return rig.phase(id) == CommandPhase::Done; }));
    EXPECT_EQ(rig.group.state(), GroupState::Stopping);
    EXPECT_EQ(rig.refusal(lineTo({0.0, 0.0, 0.0})), ErrorId::GroupLocked);
    EXPECT_EQ(rig.refusal(groupCommand(Kind::Stop)), ErrorId::GroupLocked);
    GroupCommand release = groupCommand(Kind::ReleaseStop);
    release.replaces = id;
    rig.send(release);
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST_F(OnACircle, AHaltMayBeAbortedByAnotherMotion) {
    const auto halt = rig.send(groupCommand(Kind::Halt));
    EXPECT_EQ(rig.group.state(), GroupState::Moving);
    rig.cycles(5);
    EXPECT_EQ(rig.phase(circle), CommandPhase::Aborted);
    EXPECT_EQ(rig.phase(halt), CommandPhase::Active);
    const auto line = rig.send(lineTo({0.0, 0.0, 0.0}));
    rig.cycle();
    EXPECT_EQ(rig.phase(halt), CommandPhase::Aborted);
    ASSERT_TRUE(untilOnCircle([&] { return atRest(); }));
    ASSERT_TRUE(rig.until([&] { return rig.phase(line) == CommandPhase::Done; }));
    EXPECT_EQ(rig.set(), (GroupPoint{0.0, 0.0, 0.0}));
}

TEST_F(OnACircle, AHaltEndsInStandby) {
    const auto halt = rig.send(groupCommand(Kind::Halt));
    ASSERT_TRUE(untilOnCircle([&] { return rig.phase(halt) == CommandPhase::Done; }));
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
}

TEST_F(OnACircle, AnAbortingMotionBeginsWhereThePathWasLeft) {
    const auto line = rig.send(lineTo({0.0, 0.0, 5.0}));
    rig.cycle();
    EXPECT_EQ(rig.phase(circle), CommandPhase::Aborted);
    EXPECT_EQ(rig.phase(line), CommandPhase::Queued);
    ASSERT_TRUE(untilOnCircle([&] { return atRest(); }));
    ASSERT_TRUE(rig.until([&] { return rig.phase(line) == CommandPhase::Done; }));
    EXPECT_EQ(rig.set(), (GroupPoint{0.0, 0.0, 5.0}));
}

TEST_F(OnACircle, AFaultOfAMemberStopsTheOthersOnThePath) {
    rig.drives[2].faultCode = 0x7305;  // Z, which does not move here
    rig.cycles(4);
    EXPECT_EQ(rig.group.state(), GroupState::ErrorStop);
    EXPECT_EQ(rig.group.view().error.id, ErrorId::DriveFault);
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
    EXPECT_EQ(rig.x.view().error.id, ErrorId::GroupFault);
    EXPECT_EQ(rig.port.status(circle).error, ErrorId::DriveFault);
    ASSERT_TRUE(untilOnCircle([&] { return atRest(); }));
    EXPECT_EQ(rig.refusal(lineTo({0.0, 0.0, 0.0})), ErrorId::GroupInErrorStop);
}

TEST_F(OnACircle, AMemberThatLagsStopsWithTheGroupOnThePath) {
    rig.drives[0].blockedAt = rig.drives[0].position;
    ASSERT_TRUE(rig.untilState(GroupState::ErrorStop, 200));
    EXPECT_EQ(rig.group.view().error.id, ErrorId::LagExceeded);
    EXPECT_TRUE(rig.x.view().grouped);
    ASSERT_TRUE(untilOnCircle([&] { return atRest(); }));
    EXPECT_EQ(rig.y.view().error.id, ErrorId::GroupFault);
}

TEST_F(OnACircle, ResetBringsGroupAndMembersBack) {
    rig.drives[2].faultCode = 0x7305;
    ASSERT_TRUE(rig.untilState(GroupState::ErrorStop, 10));
    ASSERT_TRUE(untilOnCircle([&] { return atRest(); }));
    rig.drives[2].faultCode = 0;
    const auto reset = rig.send(groupCommand(Kind::Reset));
    ASSERT_TRUE(rig.until([&] { return rig.phase(reset) == CommandPhase::Done; }, 4000));
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
    ASSERT_TRUE(rig.until([&] { return rig.z.state() == AxisState::Standstill; }, 4000));
    const auto line = rig.send(lineTo({0.0, 0.0, 0.0}));
    ASSERT_TRUE(rig.until([&] { return rig.phase(line) == CommandPhase::Done; }));
}

TEST_F(OnACircle, AResetWhoseCauseIsStillThereFails) {
    rig.drives[2].faultCode = 0x7305;
    rig.drives[2].faultResettable = false;
    ASSERT_TRUE(rig.untilState(GroupState::ErrorStop, 10));
    ASSERT_TRUE(untilOnCircle([&] { return atRest(); }));
    const auto reset = rig.send(groupCommand(Kind::Reset));
    ASSERT_TRUE(rig.until([&] { return rig.phase(reset) == CommandPhase::Error; }, 5000));
    EXPECT_EQ(rig.port.status(reset).error, ErrorId::ResetFailed);
    EXPECT_EQ(rig.group.state(), GroupState::ErrorStop);
}

TEST_F(OnACircle, StoppingAMemberStopsTheGroupOnThePath) {
    const auto stop = rig.sendAxis(0, command(axis::CommandKind::Stop));
    EXPECT_EQ(rig.group.state(), GroupState::Stopping);
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
    EXPECT_EQ(rig.y.state(), AxisState::SynchronizedMotion);
    rig.cycle();
    EXPECT_EQ(rig.phase(circle), CommandPhase::Aborted);
    ASSERT_TRUE(untilOnCircle([&] { return rig.group.state() == GroupState::Standby; }));
    rig.cycle();
    EXPECT_EQ(rig.portX.status(stop).phase, CommandPhase::Done);
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);  // locked until Execute falls
    EXPECT_EQ(rig.y.state(), AxisState::Standstill);
}

TEST_F(OnACircle, SwitchingAMemberOffStopsTheGroupOnThePathFirst) {
    rig.cycle([&] { ASSERT_TRUE(rig.portY.submit(command(axis::CommandKind::PowerOff)).ok()); });
    EXPECT_EQ(rig.y.state(), AxisState::Stopping);
    EXPECT_EQ(rig.group.state(), GroupState::Stopping);
    ASSERT_TRUE(untilOnCircle([&] { return rig.group.state() == GroupState::Standby; }));
    ASSERT_TRUE(rig.until([&] { return rig.y.state() == AxisState::Disabled; }, 50));
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST_F(OnACircle, TheMachineStopStopsOnThePathAndSwitchesOff) {
    for (int i = 0; i < 500; ++i) {
        rig.cycle([&] {
            for (axis::Axis* axis : rig.axes) axis->machineStop();
        });
        if (!rig.x.view().powered) break;
        EXPECT_LT(offCircle(rig.set()), 1e-9) << "cycle " << rig.k;
    }
    EXPECT_FALSE(rig.x.view().powered);
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
    EXPECT_EQ(rig.refusal(lineTo({0.0, 0.0, 0.0})), ErrorId::MachineStopped);
}

TEST_F(OnACircle, TheLossOfTheProgramStopsOnThePath) {
    rig.cycle([&] { rig.group.stopByProgramLoss(); });
    EXPECT_EQ(rig.group.state(), GroupState::Stopping);
    ASSERT_TRUE(untilOnCircle([&] { return rig.group.state() == GroupState::Standby; }));
}

TEST_F(OnACircle, AFaultWhileAlreadyHaltingStopsHarder) {
    GroupCommand halt = groupCommand(Kind::Halt);
    halt.dynamics.deceleration = core::Acceleration{200.0};
    rig.send(halt);
    rig.cycles(5);
    rig.drives[2].faultCode = 0x7305;
    rig.cycles(4);
    ASSERT_EQ(rig.group.state(), GroupState::ErrorStop);
    const auto began = rig.k;
    ASSERT_TRUE(untilOnCircle([&] { return atRest(); }));
    EXPECT_LT(rig.k - began, 120U);  // 100 mm/s at 200 mm/s² would take half a second
}

}  // namespace
}  // namespace takt::test
