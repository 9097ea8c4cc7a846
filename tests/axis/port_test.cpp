#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;
using axis::CommandKind;
using axis::CommandPhase;

TEST(AxisPort, ShowsTheNewStateInTheSameCycle) {
    Rig rig;
    rig.powerOn();
    rig.cycle([&] {
        EXPECT_EQ(rig.port.view().state, AxisState::Standstill);
        const auto id = rig.port.submit(moveTo(10.0)).value();
        EXPECT_EQ(rig.port.view().state, AxisState::DiscreteMotion);
        EXPECT_EQ(rig.port.view().active, id);
        EXPECT_EQ(rig.port.status(id).phase, CommandPhase::Active);
    });
}

TEST(AxisPort, AnAbandonedProgramsCommandsAreNeverTaken) {
    Rig rig;
    rig.powerOn();
    // The program did not finish in time: takeCommands is not called.
    rig.drive.exchange();
    rig.x.readInputs(++rig.k);
    rig.x.openPort(rig.port);
    EXPECT_TRUE(rig.port.submit(moveTo(10.0)).ok());
    rig.x.step();
    rig.x.writeOutputs();
    EXPECT_TRUE(rig.port.submit(moveTo(20.0)).ok());  // writes on
    for (int i = 0; i < 100; ++i) {
        rig.drive.exchange();
        rig.x.readInputs(++rig.k);
        rig.x.step();
        rig.x.writeOutputs();
    }
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
    EXPECT_EQ(rig.x.status().set.count(), 0.0);
}

TEST(AxisPort, TellsAnotherProgramOfAnAbortInItsNextCycle) {
    Rig rig;
    rig.powerOn();
    axis::AxisPort other{2};
    const auto mine = rig.send(moveTo(50.0));
    rig.drive.exchange();
    rig.x.readInputs(++rig.k);
    rig.x.openPort(rig.port);
    rig.x.openPort(other);
    const auto theirs = other.submit(moveTo(-5.0)).value();
    rig.x.takeCommands(rig.port);
    rig.x.takeCommands(other);
    EXPECT_EQ(rig.status(mine).phase, CommandPhase::Active);
    rig.x.step();
    rig.x.writeOutputs();
    rig.cycle();
    EXPECT_EQ(rig.status(mine).phase, CommandPhase::Aborted);
    EXPECT_NE(mine, theirs);
    EXPECT_EQ(rig.x.view().active, theirs);
}

TEST(AxisPort, RefusesTheSlowerOfTwoProgramsInOneCycle) {
    Rig rig;
    rig.powerOn();
    axis::AxisPort other{2};
    rig.drive.exchange();
    rig.x.readInputs(++rig.k);
    rig.x.openPort(rig.port);
    rig.x.openPort(other);
    EXPECT_TRUE(rig.port.submit(command(CommandKind::Stop)).ok());
    const auto late = other.submit(moveTo(10.0)).value();  // its view was still Standstill
    rig.x.takeCommands(rig.port);
    rig.x.takeCommands(other);
    rig.x.step();
    rig.x.writeOutputs();
    rig.drive.exchange();
    rig.x.readInputs(++rig.k);
    rig.x.openPort(other);
    EXPECT_EQ(other.status(late).phase, CommandPhase::Error);
    EXPECT_EQ(other.status(late).error, ErrorId::AxisLocked);
    EXPECT_EQ(rig.x.state(), AxisState::Stopping);
}

TEST(AxisPort, RemembersAPendingCommandHoweverManyFollow) {
    Rig rig;
    rig.powerOn();
    const auto id = rig.send(runAt(1.0));
    for (int i = 0; i < 300; ++i) rig.send(command(CommandKind::Reset));
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Active);
}

TEST(AxisPort, ForgetsOutcomesThatAreTooOld) {
    Rig rig;
    rig.powerOn();
    const auto id = rig.send(moveTo(0.0));
    rig.cycles(2);
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Done);
    for (int i = 0; i < 64; ++i) rig.send(command(CommandKind::Reset));
    EXPECT_EQ(rig.status(id).phase, CommandPhase::Unknown);
}

TEST(AxisPort, ARarelyOpenedPortLearnsTheOutcomeInTheEnd) {
    Rig rig;
    rig.powerOn();
    axis::AxisPort slow{2};
    rig.drive.exchange();
    rig.x.readInputs(++rig.k);
    rig.x.openPort(slow);
    const auto id = slow.submit(moveTo(1.0)).value();
    rig.x.takeCommands(slow);
    rig.x.step();
    rig.x.writeOutputs();
    for (int i = 0; i < 100; ++i) {  // more events than the axis keeps
        rig.send(moveTo(i % 2 == 0 ? 0.1 : -0.1));
    }
    rig.cycle();
    rig.x.openPort(slow);
    EXPECT_EQ(slow.status(id).phase, CommandPhase::Unknown);
}

TEST(AxisPort, TakesABoundedNumberOfCommandsInOneCycle) {
    Rig rig;
    rig.powerOn();
    rig.cycle([&] {
        for (std::size_t i = 0; i < axis::AxisPort::MaxCommands; ++i) {
            ASSERT_TRUE(rig.port.submit(moveTo(1.0)).ok());
        }
        const auto r = rig.port.submit(moveTo(1.0));
        ASSERT_FALSE(r.ok());
        EXPECT_EQ(r.error(), ErrorId::BufferFull);
    });
    ASSERT_TRUE(rig.untilState(AxisState::Standstill));
    EXPECT_EQ(rig.x.status().set.count(), 1.0);
}

TEST(AxisRef, BecomesInvalidWithItsPort) {
    axis::AxisPort port{1};
    const axis::AxisRef ref{port};
    const axis::AxisRef copy = ref;
    EXPECT_TRUE(copy.valid());
    port.invalidate();
    EXPECT_FALSE(ref.valid());
    EXPECT_FALSE(copy.valid());
    EXPECT_TRUE(axis::AxisRef{port}.valid());
    EXPECT_FALSE(axis::AxisRef{}.valid());
}
