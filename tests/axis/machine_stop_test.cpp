#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;

namespace {

/// An axis at 200 mm/s, and a machine stop that is asked for in every cycle from stop() on.
struct StopRig : Rig {
    explicit StopRig(const axis::AxisParams& params = testParams()) : Rig{params} {
        powerOn();
        run = send(runAt(200.0));
        cycles(200);
    }
    void stopped(int n = 1) {
        for (int i = 0; i < n; ++i) {
            cycle();
            x.machineStop();
        }
    }
    bool stoppedUntil(const std::function<bool()>& condition) {
        for (int i = 0; i < 5000 && !condition(); ++i) stopped();
        return condition();
    }
    axis::CommandId run{};
};

}  // namespace

TEST(MachineStop, RampsTheAxisDownThenSwitchesItOff) {
    StopRig rig;
    rig.stopped();
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
    EXPECT_GT(rig.x.status().setVelocity.count(), 150.0);
    ASSERT_TRUE(rig.stoppedUntil([&] { return rig.x.isDisabled(); }));
    EXPECT_EQ(rig.x.state(), AxisState::Disabled);
    rig.stopped();  // the port hears of it in the next cycle
    EXPECT_EQ(rig.status(rig.run).phase, axis::CommandPhase::Aborted);
}

TEST(MachineStop, RampsEvenWhereMcPowerWouldLetGoAtOnce) {
    axis::AxisParams params = testParams();
    params.powerOff = axis::PowerOffMode::Immediate;
    StopRig rig{params};
    rig.stopped(5);
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
    EXPECT_TRUE(rig.x.status().powered);
    ASSERT_TRUE(rig.stoppedUntil([&] { return rig.x.isDisabled(); }));
}

TEST(MachineStop, RefusesMotionAndPowerWhileItLasts) {
    StopRig rig;
    rig.stopped();
    EXPECT_EQ(rig.refusal(moveTo(0.0)), ErrorId::MachineStopped);
    ASSERT_TRUE(rig.stoppedUntil([&] { return rig.x.isDisabled(); }));
    EXPECT_EQ(rig.refusal(command(axis::CommandKind::PowerOn)), ErrorId::MachineStopped);
    EXPECT_EQ(rig.refusal(moveTo(0.0)), ErrorId::MachineStopped);
}

TEST(MachineStop, NeedsANewEnableEdgeAfterItsReset) {
    StopRig rig;
    ASSERT_TRUE(rig.stoppedUntil([&] { return rig.x.isDisabled(); }));
    rig.send(command(axis::CommandKind::PowerOff));  // Enable low during the stop is no edge
    rig.x.releaseMachineStop();
    EXPECT_EQ(rig.refusal(command(axis::CommandKind::PowerOn)), ErrorId::MachineStopped);
    rig.send(command(axis::CommandKind::PowerOff));
    rig.powerOn();
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST(MachineStop, CancelsAHomingAndSwitchesOff) {
    Rig rig;
    rig.powerOn();
    rig.send(command(axis::CommandKind::Home));
    rig.cycles(10);
    for (int i = 0; i < 5000 && !rig.x.isDisabled(); ++i) {
        rig.cycle();
        rig.x.machineStop();
    }
    EXPECT_TRUE(rig.x.isDisabled());
    EXPECT_FALSE(rig.x.status().homed);
}

TEST(MachineStop, SwitchesOffAnAxisThatIsInErrorStop) {
    StopRig rig;
    rig.drive.faultCode = 0x2310;
    rig.cycles(3);
    ASSERT_EQ(rig.x.state(), AxisState::ErrorStop);
    ASSERT_TRUE(rig.stoppedUntil([&] { return rig.x.isDisabled(); }));
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
}
