#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;
using axis::CommandKind;
using axis::CommandPhase;

namespace {

constexpr double kSpeed = 400.0;

/// A moving axis with one command in control and one in the queue.
struct Moving : Rig {
    explicit Moving(int at, const axis::AxisParams& params = testParams()) : Rig{params} {
        powerOn();
        active = send(moveTo(300.0, kSpeed));
        queued = send(buffered(moveTo(10.0)));
        cycles(at);
    }
    axis::CommandId active{};
    axis::CommandId queued{};
};

void expectError(Moving& rig, ErrorId id) {
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
    EXPECT_EQ(rig.x.error().id, id) << axis::errorInfo(rig.x.error().id).name;
    EXPECT_EQ(rig.status(rig.active).phase, CommandPhase::Error);
    EXPECT_EQ(rig.status(rig.active).error, id);
    EXPECT_EQ(rig.status(rig.queued).phase, CommandPhase::Error);
    EXPECT_EQ(rig.status(rig.queued).error, id);
    EXPECT_EQ(rig.refusal(moveTo(0.0)), ErrorId::AxisInErrorStop);
}

}  // namespace

class AxisFault : public testing::TestWithParam<int> {};

TEST_P(AxisFault, DriveFaultIsSeenInTheCycleItArrives) {
    Moving rig{GetParam()};
    rig.drive.faultCode = 0x8611;
    rig.cycle();  // the drive faults at this cycle's SYNC0 …
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion);
    rig.cycle();  // … and the frame of the next one tells
    expectError(rig, ErrorId::DriveFault);
    EXPECT_EQ(rig.x.error().driveError, 0x8611);
    EXPECT_EQ(rig.x.error().cycle + 1, rig.k);  // expectError took one more cycle
    EXPECT_EQ(rig.x.status().target, rig.drive.position);
}

TEST_P(AxisFault, PowerLossLeavesNoJumpBehind) {
    Moving rig{GetParam()};
    rig.drive.enableInput = false;
    rig.cycles(2);
    expectError(rig, ErrorId::PowerLost);
    rig.drive.enableInput = true;
    rig.cycles(100);
    // It does not come back by itself, and the set position rests on the actual one.
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
    EXPECT_TRUE(rig.x.isDisabled());
    EXPECT_EQ(rig.x.status().target, rig.drive.position);
    const auto worst = rig.drive.worstStep;
    const auto reset = rig.send(command(CommandKind::Reset));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill, 100));  // Enable is still TRUE
    EXPECT_EQ(rig.status(reset).phase, CommandPhase::Done);
    rig.cycles(10);
    EXPECT_EQ(rig.drive.worstStep, worst);
}

TEST_P(AxisFault, ToleratedFrameLossChangesNothing) {
    // The motor of this drive stands while no target comes: three cycles at 400 mm/s are 1.2 mm of
    // lag.
    auto p = testParams();
    p.supervision.followingError = core::Distance{3.0};
    Moving rig{GetParam(), p};
    Moving same{GetParam(), p};
    rig.drive.frameLost = true;
    rig.cycles(3);
    rig.drive.frameLost = false;
    same.cycles(3);
    for (int i = 0; i < 1000; ++i) {
        rig.cycle();
        same.cycle();
        ASSERT_EQ(rig.x.status().set.count(), same.x.status().set.count());
    }
    EXPECT_EQ(rig.x.error().id, ErrorId::None);
}

TEST_P(AxisFault, TooManyLostFramesRampDownAndStopTheDrive) {
    Moving rig{GetParam()};
    rig.drive.frameLost = true;
    rig.cycles(3);
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion);
    rig.cycle();
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
    EXPECT_EQ(rig.x.error().id, ErrorId::CommunicationLost);
    EXPECT_EQ(rig.x.error().numbers[0], 4.0);
    rig.cycles(400);
    EXPECT_TRUE(rig.x.isStopped());
    EXPECT_EQ(rig.x.status().controlword, 0x0002);
    rig.drive.frameLost = false;
    ASSERT_TRUE(rig.until([&] { return rig.x.isDisabled(); }, 200));
    rig.send(command(CommandKind::Reset));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill, 100));
}

TEST_P(AxisFault, LeavingOperationalIsReportedWithItsCode) {
    Moving rig{GetParam()};
    rig.drive.health.operational = false;
    rig.drive.health.alStatusCode = 0x001B;
    rig.cycle();
    expectError(rig, ErrorId::SlaveNotOperational);
    EXPECT_EQ(rig.x.error().numbers[0], 0x1B);
    EXPECT_FALSE(rig.x.status().homed);
}

TEST_P(AxisFault, LagRampsDownAndKeepsPower) {
    Moving rig{GetParam()};
    rig.drive.blockedAt = rig.drive.position;
    ASSERT_TRUE(rig.untilState(AxisState::ErrorStop));
    EXPECT_EQ(rig.x.error().id, ErrorId::LagExceeded);
    EXPECT_GT(std::abs(rig.x.error().numbers[0]), 1.0);
    EXPECT_EQ(rig.x.error().numbers[1], 1.0);
    ASSERT_TRUE(rig.until([&] { return rig.x.isStopped(); }));
    EXPECT_TRUE(rig.x.status().powered);
    const auto held = rig.x.status().target;
    rig.cycles(100);
    EXPECT_EQ(rig.x.status().target, held);
    // The cause is still there.
    const auto refused = rig.send(command(CommandKind::Reset));
    rig.cycle();
    EXPECT_EQ(rig.status(refused).error, ErrorId::LagExceeded);
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
    rig.drive.blockedAt.reset();
    rig.cycles(10);
    const auto reset = rig.send(command(CommandKind::Reset));
    rig.cycle();
    EXPECT_EQ(rig.status(reset).phase, CommandPhase::Done);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
    EXPECT_EQ(rig.x.status().target, held);
}

TEST_P(AxisFault, EncoderJumpStopsTheDrive) {
    Moving rig{GetParam()};
    rig.drive.blockedAt = rig.drive.position + 50000;
    rig.cycles(2);
    expectError(rig, ErrorId::EncoderError);
    EXPECT_EQ(rig.x.status().controlword, 0x0002);
    EXPECT_FALSE(rig.x.status().homed);
    ASSERT_TRUE(rig.until([&] { return rig.x.isDisabled(); }, 200));
}

TEST_P(AxisFault, FirstCauseIsKept) {
    Moving rig{GetParam()};
    rig.drive.blockedAt = rig.drive.position;
    ASSERT_TRUE(rig.untilState(AxisState::ErrorStop));
    rig.drive.faultCode = 0x8611;
    rig.cycles(5);
    EXPECT_EQ(rig.x.error().id, ErrorId::LagExceeded);
    EXPECT_TRUE(rig.x.isDisabled());
}

INSTANTIATE_TEST_SUITE_P(Phases, AxisFault, testing::Values(20, 60, 110, 400, 770));

TEST(AxisLag, IsZeroForADriveThatFollowsWithItsDelay) {
    for (const std::uint32_t delay : {0U, 1U, 3U}) {
        auto p = testParams();
        p.supervision.driveDelayCycles = delay;
        Rig rig{p};
        rig.powerOn();
        rig.send(runAt(400.0));
        ASSERT_TRUE(rig.until([&] { return rig.x.view().inVelocity; }));
        rig.cycles(20);
        // The simulated drive has a delay of one cycle; 400 mm/s are 0.4 mm a cycle.
        EXPECT_NEAR(rig.x.status().lag.count(), 0.4 * (1.0 - delay), 0.003);
    }
}

TEST(AxisLag, WaitsForItsFilterTime) {
    auto p = testParams();
    p.supervision.followingErrorTime = std::chrono::milliseconds{10};
    Rig rig{p};
    rig.powerOn();
    rig.drive.blockedAt = 1000;  // 2 mm
    int n = 0;
    while (rig.x.state() != AxisState::ErrorStop && n < 100) {
        rig.cycle();
        ++n;
    }
    EXPECT_EQ(n, 2 + 10);
}

TEST(AxisLag, OffWhenTheLimitIsZero) {
    auto p = testParams();
    p.supervision.followingError = core::Distance{0.0};
    Rig rig{p};
    rig.powerOn();
    rig.drive.blockedAt = 1000;
    rig.cycles(500);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST(AxisReset, ClearsADriveFaultByAnEdge) {
    Rig rig;
    rig.powerOn();
    rig.drive.faultCode = 0x7305;
    rig.cycles(3);
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
    const auto reset = rig.send(command(CommandKind::Reset));
    EXPECT_EQ(rig.status(reset).phase, CommandPhase::Active);
    ASSERT_TRUE(rig.until([&] { return rig.status(reset).phase == CommandPhase::Done; }, 50));
    EXPECT_EQ(rig.drive.resetEdges, 1);
    EXPECT_EQ(rig.x.error().id, ErrorId::None);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill, 50));
}

TEST(AxisReset, EndsInDisabledWithoutEnable) {
    Rig rig;
    rig.powerOn();
    rig.drive.faultCode = 0x7305;
    rig.cycles(3);
    rig.send(command(CommandKind::PowerOff));
    rig.send(command(CommandKind::Reset));
    ASSERT_TRUE(rig.untilState(AxisState::Disabled, 50));
    rig.cycles(50);
    EXPECT_EQ(rig.x.state(), AxisState::Disabled);
}

TEST(AxisReset, FailsWhenTheFaultStays) {
    auto p = testParams();
    p.supervision.resetTimeout = std::chrono::milliseconds{100};
    Rig rig{p};
    rig.powerOn();
    rig.drive.faultCode = 0x7305;
    rig.drive.faultResettable = false;
    rig.cycles(3);
    const auto reset = rig.send(command(CommandKind::Reset));
    ASSERT_TRUE(rig.until([&] { return rig.status(reset).phase == CommandPhase::Error; }, 200));
    EXPECT_EQ(rig.status(reset).error, ErrorId::ResetFailed);
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
    // A later try works when the cause is gone.
    rig.drive.faultResettable = true;
    rig.send(command(CommandKind::Reset));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill, 100));
}

TEST(AxisReset, WaitsForTheRamp) {
    Moving rig{400};
    rig.drive.blockedAt = rig.drive.position;
    ASSERT_TRUE(rig.untilState(AxisState::ErrorStop));
    rig.drive.blockedAt.reset();
    const auto reset = rig.send(command(CommandKind::Reset));
    EXPECT_EQ(rig.status(reset).phase, CommandPhase::Active);
    EXPECT_NE(rig.x.status().setVelocity.count(), 0.0);
    ASSERT_TRUE(rig.until([&] { return rig.status(reset).phase == CommandPhase::Done; }, 400));
    EXPECT_EQ(rig.x.status().setVelocity.count(), 0.0);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST(AxisReset, IsRefusedWhileTheBusIsGone) {
    Moving rig{100};
    rig.drive.health.operational = false;
    rig.cycle();
    const auto reset = rig.send(command(CommandKind::Reset));
    rig.cycle();
    EXPECT_EQ(rig.status(reset).error, ErrorId::SlaveNotOperational);
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
}

TEST(AxisReset, IsDoneWithoutEffectWhenThereIsNoError) {
    Moving rig{100};
    const auto reset = rig.send(command(CommandKind::Reset));
    EXPECT_EQ(rig.status(reset).phase, CommandPhase::Done);
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion);
}

TEST(AxisPower, TimesOutWhenTheDriveDoesNotComeUp) {
    auto p = testParams();
    p.supervision.enableTimeout = std::chrono::milliseconds{50};
    Rig rig{p};
    rig.drive.refuseEnable = true;
    rig.send(command(CommandKind::PowerOn));
    ASSERT_TRUE(rig.untilState(AxisState::ErrorStop, 100));
    EXPECT_EQ(rig.x.error().id, ErrorId::EnableTimeout);
    EXPECT_NEAR(static_cast<double>(rig.x.error().cycle), 52.0, 3.0);
}

TEST(AxisPower, DoesNotTimeOutBeforeTheBusIsUp) {
    auto p = testParams();
    p.supervision.enableTimeout = std::chrono::milliseconds{50};
    Rig rig{p};
    rig.drive.health.operational = false;
    rig.send(command(CommandKind::PowerOn));
    rig.cycles(500);
    EXPECT_EQ(rig.x.state(), AxisState::Disabled);
    rig.drive.health.operational = true;
    ASSERT_TRUE(rig.untilState(AxisState::Standstill, 50));
}

TEST(AxisPower, EnablesByThreeAcknowledgedSteps) {
    Rig rig;
    std::vector<std::uint16_t> words;
    rig.send(command(CommandKind::PowerOn));
    for (int i = 0; i < 50 && rig.x.state() != AxisState::Standstill; ++i) {
        rig.cycle();
        if (words.empty() || words.back() != rig.x.status().controlword) {
            words.push_back(rig.x.status().controlword);
        }
    }
    EXPECT_EQ(words, (std::vector<std::uint16_t>{0x06, 0x07, 0x0F}));
}

TEST(AxisPower, SwitchesOffInSteps) {
    Rig rig;
    rig.powerOn();
    std::vector<std::uint16_t> words;
    rig.send(command(CommandKind::PowerOff));
    EXPECT_EQ(rig.x.state(), AxisState::Disabled);
    for (int i = 0; i < 20; ++i) {
        if (words.empty() || words.back() != rig.x.status().controlword) {
            words.push_back(rig.x.status().controlword);
        }
        rig.cycle();
    }
    EXPECT_EQ(words, (std::vector<std::uint16_t>{0x07, 0x06}));
    EXPECT_TRUE(rig.x.isDisabled());
}

TEST(AxisPower, SetPointIsNotRetakenWhileTheOldPowerIsStillThere) {
    // Off and on again before the drive has left Operation enabled, with a motor pushed aside.
    Rig rig;
    rig.powerOn();
    rig.drive.blockedAt = 100;
    rig.cycles(5);
    rig.send(command(CommandKind::PowerOff));
    rig.send(command(CommandKind::PowerOn));
    bool left = false;
    for (int i = 0; i < 50; ++i) {
        rig.cycle();
        const bool enabled = rig.drive.state == core::cia402::DriveState::OperationEnabled;
        if (!enabled) left = true;
        if (enabled && !left) {
            EXPECT_EQ(rig.drive.target, 0);
        }
    }
    EXPECT_TRUE(left);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
    EXPECT_EQ(rig.x.status().target, 100);
}

TEST(AxisPower, ADriveFoundEnabledIsSwitchedOffFirst) {
    Rig rig;
    rig.drive.state = core::cia402::DriveState::OperationEnabled;
    rig.drive.position = 777;
    rig.drive.mode = 8;
    rig.cycles(1);
    rig.drive.state = core::cia402::DriveState::OperationEnabled;
    rig.cycles(3);
    EXPECT_EQ(rig.x.state(), AxisState::Disabled);
    EXPECT_EQ(rig.x.status().target, 777);
    ASSERT_TRUE(rig.until([&] { return rig.x.isDisabled(); }, 20));
    rig.powerOn();
    EXPECT_EQ(rig.x.status().target, 777);
}

TEST(AxisPower, AFaultAtStartIsAnAxisError) {
    Rig rig;
    rig.drive.faultCode = 0x1234;
    rig.cycles(3);
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
    EXPECT_EQ(rig.x.error().id, ErrorId::DriveFault);
}

TEST(AxisPower, WrongModeIsAnError) {
    Rig rig;
    rig.powerOn();
    rig.drive.fixedMode = 9;
    rig.cycles(3);
    EXPECT_EQ(rig.x.state(), AxisState::ErrorStop);
    EXPECT_EQ(rig.x.error().id, ErrorId::ModeChangeFailed);
    EXPECT_EQ(rig.x.error().numbers[1], 9.0);
}

TEST(AxisQuickStop, LetsTheDriveStopAndSwitchesItOff) {
    Moving rig{400};
    rig.cycle([&] { rig.x.quickStop(); });
    EXPECT_EQ(rig.x.status().controlword, 0x0002);
    EXPECT_EQ(rig.status(rig.active).phase, CommandPhase::Active);  // the port learns it next cycle
    rig.cycle();
    EXPECT_EQ(rig.status(rig.active).phase, CommandPhase::Aborted);
    ASSERT_TRUE(rig.until([&] { return rig.x.isDisabled(); }, 200));
    EXPECT_EQ(rig.x.state(), AxisState::Disabled);
}
