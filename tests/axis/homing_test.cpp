#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;
using axis::CommandKind;
using axis::CommandPhase;

namespace {

axis::Command home(double position) {
    auto c = command(CommandKind::Home);
    c.position = core::Position{position};
    return c;
}

axis::AxisParams impatient() {
    auto p = testParams();
    p.homing.timeout = std::chrono::milliseconds{300};
    return p;
}

}  // namespace

TEST(Homing, GivesTheReferenceItsPosition) {
    Rig rig;
    rig.drive.position = 123456;
    rig.drive.homingTravel = -3000;
    rig.powerOn();
    const auto id = rig.send(home(12.5));
    EXPECT_EQ(rig.x.state(), AxisState::Homing);
    EXPECT_FALSE(rig.x.status().homed);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Done);
    EXPECT_TRUE(rig.x.status().homed);
    EXPECT_EQ(rig.x.error().id, ErrorId::None);
    EXPECT_EQ(rig.x.status().actual.count(), 12.5);
    EXPECT_EQ(rig.x.status().set.count(), 12.5);
    EXPECT_EQ(rig.x.status().target, 0);
    EXPECT_EQ(rig.drive.mode, 8);
}

TEST(Homing, ReturnsToCyclicPositionWithoutABump) {
    Rig rig;
    rig.drive.position = 123456;
    rig.drive.homingTravel = -3000;
    rig.drive.homingZeroAt = 37;  // the drive stands a little off its reference
    rig.powerOn();
    rig.send(home(12.5));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    rig.cycles(10);
    EXPECT_EQ(rig.drive.worstStep, 0);  // in CSP the motor never moved
    EXPECT_EQ(rig.x.status().target, 37);
    EXPECT_NEAR(rig.x.status().set.count(), 12.5 + 37 * 0.002, 1e-12);
    rig.send(moveTo(0.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    rig.cycles(5);
    EXPECT_EQ(rig.drive.position, -6250);
}

TEST(Homing, StartsTheCountAnewAfterAWrapOfTheDrivesPosition) {
    Rig rig;
    rig.drive.position = 2147483647 - 2000;
    rig.powerOn();
    rig.send(moveBy(20.0));  // 10000 counts, over the wrap
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    rig.send(home(1.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().actual.count(), 1.0);
    rig.send(moveTo(-1.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().target, -1000);
}

TEST(Homing, HoldsBitFourUntilTheDriveIsDone) {
    Rig rig;
    rig.drive.homingTravel = 4000;  // 100 cycles
    rig.powerOn();
    rig.send(home(0.0));
    int high = 0;
    int falls = 0;
    std::uint16_t last = 0;
    while (rig.x.state() == AxisState::Homing) {
        rig.cycle();
        const std::uint16_t now = rig.x.status().controlword;
        if ((now & 0x10U) != 0) ++high;
        if ((last & 0x10U) != 0 && (now & 0x10U) == 0) ++falls;
        last = now;
    }
    EXPECT_GT(high, 100);
    EXPECT_EQ(falls, 1);
}

TEST(Homing, DoesNotBelieveTheResultOfTheLastTime) {
    Rig rig;
    rig.powerOn();
    rig.send(home(0.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    rig.send(moveTo(30.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    rig.drive.homingTravel = -15000;  // 375 cycles, far longer than the old result is shown
    rig.send(home(5.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().actual.count(), 5.0);
    EXPECT_EQ(rig.drive.position, 0);
}

TEST(Homing, DriveErrorEndsInStandstillNotHomed) {
    Rig rig;
    rig.powerOn();
    rig.drive.homingFails = true;
    const auto id = rig.send(home(0.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.status(id).error, ErrorId::HomingDriveError);
    EXPECT_FALSE(rig.x.status().homed);
    EXPECT_EQ(rig.x.error().id, ErrorId::None);
    // The next one is not taken for failed because the old bit is still shown.
    rig.drive.homingFails = false;
    const auto again = rig.send(home(1.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.status(again).phase, CommandPhase::Done);
}

TEST(Homing, TimesOut) {
    Rig rig{impatient()};
    rig.powerOn();
    rig.drive.homingNeverEnds = true;
    rig.drive.homingTravel = 2000;
    const auto id = rig.send(home(0.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill, 400));
    EXPECT_EQ(rig.status(id).error, ErrorId::HomingTimeout);
    EXPECT_FALSE(rig.x.status().homed);
    EXPECT_EQ(rig.drive.worstStep, 0);
    EXPECT_NEAR(rig.x.status().actual.count(), 4.0, 1e-9);
}

TEST(Homing, StopInterruptsIt) {
    Rig rig;
    rig.powerOn();
    rig.drive.homingTravel = 40000;
    const auto id = rig.send(home(0.0));
    rig.cycles(100);
    EXPECT_EQ(rig.refusal(moveTo(1.0)), ErrorId::InvalidState);
    EXPECT_EQ(rig.refusal(command(CommandKind::Halt)), ErrorId::InvalidState);
    const auto stop = rig.send(command(CommandKind::Stop));
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Aborted);
    ASSERT_TRUE(rig.until([&] { return rig.status(stop).phase == CommandPhase::Done; }, 100));
    EXPECT_FALSE(rig.x.status().homed);
    EXPECT_EQ(rig.x.status().mode, 8);
    EXPECT_EQ(rig.drive.worstStep, 0);
    EXPECT_EQ(rig.x.status().target, rig.drive.position);
}

TEST(Homing, PowerOffInterruptsIt) {
    for (const auto mode : {axis::PowerOffMode::Ramp, axis::PowerOffMode::Immediate}) {
        auto p = testParams();
        p.powerOff = mode;
        Rig rig{p};
        rig.powerOn();
        rig.drive.homingTravel = 40000;
        rig.send(home(0.0));
        rig.cycles(100);
        rig.send(command(CommandKind::PowerOff));
        ASSERT_TRUE(rig.untilState(AxisState::Disabled, 100));
        ASSERT_TRUE(rig.until([&] { return rig.x.isDisabled(); }, 20));
        EXPECT_FALSE(rig.x.status().homed);
        EXPECT_EQ(rig.x.error().id, ErrorId::None);
        rig.powerOn();
        EXPECT_EQ(rig.drive.worstStep, 0);
    }
}

TEST(Homing, DriveFaultEndsItInErrorStop) {
    Rig rig;
    rig.powerOn();
    rig.drive.homingTravel = 40000;
    const auto id = rig.send(home(0.0));
    rig.cycles(100);
    rig.drive.faultCode = 0x8611;
    rig.cycles(3);
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
    EXPECT_EQ(rig.status(id).error, ErrorId::DriveFault);
    rig.send(command(CommandKind::Reset));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill, 100));
    EXPECT_EQ(rig.drive.mode, 8);
}

TEST(Homing, LostFramesStopTheDrive) {
    Rig rig;
    rig.powerOn();
    rig.drive.homingTravel = 40000;
    rig.send(home(0.0));
    rig.cycles(100);
    rig.drive.frameLost = true;
    rig.cycles(6);
    EXPECT_EQ(rig.x.error().id, ErrorId::CommunicationLost);
    EXPECT_EQ(rig.x.status().controlword, 0x0002);
}

TEST(Homing, ModeThatNeverComesIsAnErrorOfTheBlock) {
    auto p = testParams();
    p.supervision.enableTimeout = std::chrono::milliseconds{50};
    Rig rig{p};
    rig.powerOn();
    rig.drive.fixedMode = 8;
    const auto id = rig.send(home(0.0));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill, 200));
    EXPECT_EQ(rig.status(id).error, ErrorId::ModeChangeFailed);
}

TEST(Homing, ADriveThatDoesNotComeBackIsStopped) {
    auto p = testParams();
    p.supervision.enableTimeout = std::chrono::milliseconds{50};
    Rig rig{p};
    rig.powerOn();
    rig.send(home(0.0));
    rig.cycles(3);
    rig.drive.fixedMode = 6;
    ASSERT_TRUE(rig.untilState(AxisState::ErrorStop, 300));
    EXPECT_EQ(rig.x.error().id, ErrorId::ModeChangeFailed);
    EXPECT_EQ(rig.x.status().controlword, 0x0002);
}

TEST(Homing, MoveMayWaitBehindIt) {
    Rig rig;
    rig.powerOn();
    rig.drive.homingTravel = 500;
    rig.send(home(10.0));
    const auto move = rig.send(buffered(moveTo(20.0)));
    EXPECT_EQ(rig.status(move).phase, CommandPhase::Queued);
    ASSERT_TRUE(rig.until([&] { return rig.status(move).phase == CommandPhase::Done; }));
    rig.cycles(5);
    EXPECT_EQ(rig.drive.position, 5000);
}

TEST(Homing, MayItselfWaitBehindAMove) {
    Rig rig;
    rig.powerOn();
    rig.send(moveTo(5.0));
    const auto id = rig.send(buffered(home(1.0)));
    ASSERT_TRUE(rig.until([&] { return rig.status(id).phase == CommandPhase::Done; }));
    EXPECT_EQ(rig.x.status().actual.count(), 1.0);
}

TEST(Homing, BehindAVelocityMoveIsRefusedAndTheAxisHalts) {
    Rig rig;
    rig.powerOn();
    rig.send(runAt(100.0));
    const auto id = rig.send(buffered(home(1.0)));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.status(id).error, ErrorId::InvalidState);
}

TEST(Homing, WorksThroughObjectsWhenTheModeIsNotMapped) {
    /// Answers each request three calls later, as a mailbox would.
    struct Objects : core::ObjectAccess {
        bool startRead(core::ObjectAddress) noexcept override { return false; }
        bool startWrite(core::ObjectAddress a, const core::ObjectValue& v) noexcept override {
            if (wait > 0) return false;
            address = a;
            value = v;
            wait = 3;
            return true;
        }
        core::ObjectReply reply() const noexcept override {
            return {wait > 0 ? core::ObjectState::Pending : core::ObjectState::Done, {}, 0};
        }
        core::ObjectAddress address{};
        core::ObjectValue value{};
        int wait{0};
    };
    Rig rig;
    Objects objects;
    auto bindings = SimDrive::bindings();
    bindings.modeOfOperation = {};
    rig.x.attach(rig.drive.image(), bindings, &objects);
    const auto cycle = [&] {
        rig.cycle();
        if (objects.wait > 0) --objects.wait;
        rig.drive.outputs[2] = objects.wait == 0 ? objects.value.bytes[0] : rig.drive.outputs[2];
    };
    cycle();
    rig.send(command(CommandKind::PowerOn));
    for (int i = 0; i < 60; ++i) cycle();
    ASSERT_EQ(rig.x.state(), AxisState::Standstill);
    EXPECT_EQ(objects.address.index, core::cia402::ModesOfOperation);
    const auto id = rig.send(home(3.0));
    for (int i = 0; i < 200; ++i) cycle();
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Done);
    EXPECT_EQ(rig.x.status().actual.count(), 3.0);
}
