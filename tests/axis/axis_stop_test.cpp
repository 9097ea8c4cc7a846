#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;
using axis::CommandKind;
using axis::CommandPhase;

namespace {

/// A moving axis in one of the phases of a long move.
void run(Rig& rig, int cycles) {
    rig.powerOn();
    rig.send(moveTo(300.0, 400.0));
    rig.cycles(cycles);
}

axis::Command release(axis::CommandId stop) {
    auto c = command(CommandKind::ReleaseStop);
    c.replaces = stop;
    return c;
}

}  // namespace

class AxisStopPhases : public testing::TestWithParam<int> {};

TEST_P(AxisStopPhases, StopEndsAtRestAndHoldsTheAxisUntilReleased) {
    Rig rig;
    run(rig, GetParam());
    const auto stop = rig.send(command(CommandKind::Stop));
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
    ASSERT_TRUE(rig.until([&] { return rig.status(stop).phase == CommandPhase::Done; }));
    EXPECT_EQ(rig.x.status().setVelocity.count(), 0.0);
    rig.cycles(50);
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
    EXPECT_EQ(rig.refusal(moveTo(0.0)), ErrorId::AxisLocked);
    rig.send(release(stop));
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST_P(AxisStopPhases, ReleasedStopGoesToStandstillWithVelocityZero) {
    Rig rig;
    run(rig, GetParam());
    const auto stop = rig.send(command(CommandKind::Stop));
    rig.send(release(stop));
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().setVelocity.count(), 0.0);
    EXPECT_EQ(rig.status(stop).phase, CommandPhase::Done);
}

TEST_P(AxisStopPhases, HaltEndsInStandstill) {
    Rig rig;
    run(rig, GetParam());
    const auto halt = rig.send(command(CommandKind::Halt));
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.status(halt).phase, CommandPhase::Done);
}

TEST_P(AxisStopPhases, GentleStopKeepsTheVelocityLimit) {
    Rig rig;
    run(rig, GetParam());
    auto c = command(CommandKind::Stop);
    c.dynamics.deceleration = core::Acceleration{500.0};
    c.dynamics.jerk = core::Jerk{5000.0};
    const auto stop = rig.send(c);
    ASSERT_TRUE(rig.until([&] { return rig.status(stop).phase == CommandPhase::Done; }));
}

TEST_P(AxisStopPhases, PowerOffRampsDownThenDisables) {
    Rig rig;
    run(rig, GetParam());
    rig.send(command(CommandKind::PowerOff));
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
    EXPECT_EQ(rig.refusal(moveTo(0.0)), ErrorId::AxisLocked);
    ASSERT_TRUE(rig.untilState(AxisState::Disabled));
    EXPECT_EQ(rig.x.status().setVelocity.count(), 0.0);
    ASSERT_TRUE(rig.until([&] { return rig.x.isDisabled(); }, 20));
    EXPECT_LE(rig.drive.worstStep, 251);  // 500 mm/s
}

TEST_P(AxisStopPhases, ImmediatePowerOffDisablesAtOnce) {
    auto p = testParams();
    p.powerOff = axis::PowerOffMode::Immediate;
    Rig rig{p};
    run(rig, GetParam());
    rig.send(command(CommandKind::PowerOff));
    EXPECT_EQ(rig.x.state(), AxisState::Disabled);
    EXPECT_EQ(rig.x.status().controlword, 0x0000);
    ASSERT_TRUE(rig.until([&] { return rig.x.isDisabled(); }, 20));
    EXPECT_EQ(rig.x.state(), AxisState::Disabled);
}

TEST_P(AxisStopPhases, ProgramLossStopsTheAxisAndGivesItFree) {
    Rig rig;
    run(rig, GetParam());
    rig.cycle([&] { rig.x.stopByProgramLoss(); });
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_TRUE(rig.x.isStopped());
    EXPECT_LT(rig.x.status().set.count(), 300.0);
}

INSTANTIATE_TEST_SUITE_P(Phases, AxisStopPhases, testing::Values(1, 20, 60, 110, 400, 790, 850));

TEST(AxisStop, IsDoneAtOnceInStandstillAndLocks) {
    Rig rig;
    rig.powerOn();
    const auto stop = rig.send(command(CommandKind::Stop));
    EXPECT_EQ(rig.status(stop).phase, CommandPhase::Done);
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
    rig.send(release(stop));
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST(AxisStop, RefusesASecondInstance) {
    Rig rig;
    run(rig, 200);
    rig.send(command(CommandKind::Stop));
    EXPECT_EQ(rig.refusal(command(CommandKind::Stop)), ErrorId::AxisLocked);
}

TEST(AxisStop, SameInstanceMayStopHarder) {
    Rig rig;
    run(rig, 300);
    auto gentle = command(CommandKind::Stop);
    gentle.dynamics.deceleration = core::Acceleration{500.0};
    const auto first = rig.send(gentle);
    rig.cycles(5);
    auto hard = command(CommandKind::Stop);
    hard.replaces = first;
    const auto second = rig.send(hard);
    int n = 0;
    while (rig.status(second).phase != CommandPhase::Done && n < 1000) {
        rig.cycle();
        ++n;
    }
    EXPECT_LT(n, 100);  // 400 mm/s at 8000 mm/s² = 50 ms and the jerk; 800 ms at 500 mm/s²
}

TEST(AxisStop, OfAnotherInstanceIsNotReleased) {
    Rig rig;
    run(rig, 300);
    const auto stop = rig.send(command(CommandKind::Stop));
    ASSERT_TRUE(rig.until([&] { return rig.status(stop).phase == CommandPhase::Done; }));
    rig.send(release(axis::CommandId{12345}));
    rig.send(release(axis::CommandId::None));
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
}

TEST(AxisStop, AbortsTheQueue) {
    Rig rig;
    run(rig, 100);
    const auto queued = rig.send(buffered(moveTo(10.0)));
    EXPECT_EQ(rig.status(queued).phase, CommandPhase::Queued);
    rig.send(command(CommandKind::Stop));
    EXPECT_EQ(rig.status(queued).phase, CommandPhase::Aborted);
}

TEST(AxisStop, PowerOffAbortsAnMcStopThatIsStillBraking) {
    Rig rig;
    run(rig, 300);
    const auto stop = rig.send(command(CommandKind::Stop));
    rig.cycles(2);
    rig.send(command(CommandKind::PowerOff));
    EXPECT_EQ(rig.status(stop).phase, CommandPhase::Aborted);
    ASSERT_TRUE(rig.untilState(AxisState::Disabled));
}

TEST(AxisStop, EnableDuringTheSwitchOffRampEndsInStandstill) {
    Rig rig;
    run(rig, 300);
    rig.send(command(CommandKind::PowerOff));
    rig.cycles(5);
    rig.send(command(CommandKind::PowerOn));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_TRUE(rig.x.status().powered);
}

TEST(AxisStop, HaltedAxisCanBeTakenBeforeItRests) {
    Rig rig;
    run(rig, 300);
    const auto halt = rig.send(command(CommandKind::Halt));
    rig.cycles(20);
    rig.send(runAt(300.0));
    EXPECT_EQ(rig.status(halt).phase, CommandPhase::Aborted);
    double slowest = 1e9;
    for (int i = 0; i < 300; ++i) {
        rig.cycle();
        slowest = std::min(slowest, rig.x.status().setVelocity.count());
    }
    EXPECT_GT(slowest, 0.0);
}

TEST(AxisQueue, BufferedMoveStartsFromRestAtTheFirstTarget) {
    Rig rig;
    rig.powerOn();
    const auto first = rig.send(moveTo(50.0));
    const auto second = rig.send(buffered(moveTo(80.0)));
    ASSERT_TRUE(rig.until([&] { return rig.x.status().set.count() == 50.0; }));
    EXPECT_EQ(rig.x.status().setVelocity.count(), 0.0);
    rig.cycle();  // no dwell: the next step belongs to the second move
    EXPECT_EQ(rig.status(first).phase, CommandPhase::Done);
    EXPECT_EQ(rig.status(second).phase, CommandPhase::Active);
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion);
    EXPECT_GT(rig.x.status().set.count(), 50.0);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().set.count(), 80.0);
}

TEST(AxisQueue, RelativeMovesCountFromWhereTheyTakeControl) {
    Rig rig;
    rig.powerOn();
    rig.send(moveTo(10.0));
    rig.send(buffered(moveBy(5.0)));
    rig.send(buffered(moveBy(5.0)));
    rig.send(buffered(moveBy(-2.5)));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().set.count(), 17.5);
}

TEST(AxisQueue, FollowsAVelocityMoveWhenTheVelocityIsReached) {
    Rig rig;
    rig.powerOn();
    const auto v = rig.send(runAt(200.0));
    const auto next = rig.send(buffered(moveBy(100.0, 200.0)));
    ASSERT_TRUE(rig.until([&] { return rig.status(next).phase == CommandPhase::Active; }));
    EXPECT_EQ(rig.status(v).phase, CommandPhase::Aborted);
    EXPECT_GT(rig.x.status().setVelocity.count(), 150.0);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
}

TEST(AxisQueue, TakesAsManyAsItsDepth) {
    auto p = testParams();
    p.queueDepth = 3;
    Rig rig{p};
    rig.powerOn();
    rig.send(moveTo(50.0));
    for (int i = 0; i < 3; ++i) rig.send(buffered(moveBy(1.0)));
    EXPECT_EQ(rig.refusal(buffered(moveBy(1.0))), ErrorId::BufferFull);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().set.count(), 53.0);
}

TEST(AxisQueue, AbortingCommandClearsIt) {
    Rig rig;
    rig.powerOn();
    rig.send(moveTo(50.0));
    const auto queued = rig.send(buffered(moveTo(80.0)));
    rig.send(moveTo(20.0));
    EXPECT_EQ(rig.status(queued).phase, CommandPhase::Aborted);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().set.count(), 20.0);
}

TEST(AxisQueue, SkipsACommandThatIsImpossibleAtItsTurn) {
    auto p = testParams();
    p.limits.softPositive = core::Position{60.0};
    Rig rig{p};
    rig.powerOn();
    rig.send(moveTo(50.0));
    const auto bad = rig.send(buffered(moveBy(20.0)));  // 70 mm: known only when it starts
    const auto good = rig.send(buffered(moveBy(5.0)));
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.status(bad).phase, CommandPhase::Error);
    EXPECT_EQ(rig.status(bad).error, ErrorId::TargetOutsideSWLimit);
    EXPECT_EQ(rig.status(good).phase, CommandPhase::Done);
    EXPECT_EQ(rig.x.status().set.count(), 55.0);
}

TEST(AxisQueue, LastOfSeveralAbortingCommandsInACycleWins) {
    Rig rig;
    rig.powerOn();
    axis::CommandId a{};
    axis::CommandId b{};
    rig.cycle([&] {
        a = rig.port.submit(moveTo(10.0)).value();
        b = rig.port.submit(moveTo(-10.0)).value();
    });
    EXPECT_EQ(rig.status(a).phase, CommandPhase::Aborted);
    EXPECT_EQ(rig.status(b).phase, CommandPhase::Active);
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().set.count(), -10.0);
}
