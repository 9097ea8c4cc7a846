#include "axis_rig.hpp"

using namespace takt;
using namespace takt::test;

namespace {

/// An axis that has just begun a long move.
struct Starting : Rig {
    Starting() {
        powerOn();
        send(moveTo(300.0, 400.0));
    }
    /// The controller sleeps through a cycle; the drive does not, and gets no new target.
    void sleepThrough() {
        drive.frameLost = true;
        drive.exchange();
        drive.frameLost = false;
        drive.health.lostInRow = 0;
    }
    void missed(int count) {
        for (int i = 0; i < count; ++i) {
            sleepThrough();
            ++k;
            x.missCycle();
            continuity.add(x.status().set.count(), k);
        }
    }
};

}  // namespace

TEST(LostFrames, DoNotTurnTheErrorOfOneBridgeIntoTheSpeedOfTheNext) {
    Starting rig;
    rig.cycles(20);
    double worst = 0.0;
    // While the speed changes every bridge is a little wrong; two lost for each that comes.
    for (int i = 0; i < 60; ++i) {
        rig.drive.frameLost = i % 3 != 2;
        rig.cycle();
        const axis::AxisStatus s = rig.x.status();
        worst = std::max(worst, std::abs((s.actualVelocity - s.setVelocity).count()));
    }
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion) << axis::errorInfo(rig.x.error().id).name;
    // Some cycles old at 5000 mm/s^2: 5 mm/s for each.
    EXPECT_LT(worst, 60.0);
}

TEST(LostFrames, LeaveTheSpeedBehindThemAsItIs) {
    Starting rig;
    ASSERT_TRUE(rig.until([&] { return rig.x.status().actualVelocity.count() > 399.0; }));
    rig.cycles(10);
    rig.drive.frameLost = true;
    rig.cycles(3);
    rig.drive.frameLost = false;
    rig.cycle();
    // The drive stood while it heard nothing: three cycles of the four.
    EXPECT_GT(rig.x.status().actualVelocity.count(), 50.0);
    rig.cycles(6);
    EXPECT_NEAR(rig.x.status().actualVelocity.count(), 400.0, 2.0);
}

TEST(MissedCycles, TheMotionGoesOnAsIfTheyHadRun) {
    Starting late;
    Starting punctual;
    for (auto* rig : {&late, &punctual}) rig->cycles(30);
    ASSERT_EQ(late.k, punctual.k);
    late.missed(2);
    late.cycle();
    punctual.cycles(3);
    ASSERT_EQ(late.k, punctual.k);
    EXPECT_EQ(late.x.status().set, punctual.x.status().set);
    EXPECT_EQ(late.x.status().setVelocity, punctual.x.status().setVelocity);
    late.cycles(20);
    punctual.cycles(20);
    EXPECT_EQ(late.x.status().set, punctual.x.status().set);
    EXPECT_EQ(late.x.state(), AxisState::DiscreteMotion);
}

TEST(MissedCycles, AreNoJumpOfTheEncoder) {
    Starting rig;
    ASSERT_TRUE(rig.until([&] { return rig.x.status().setVelocity.count() > 399.0; }));
    rig.missed(2);
    rig.cycles(10);
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion) << axis::errorInfo(rig.x.error().id).name;
}

TEST(MissedCycles, ALongSleepIsNotMadeUpForInOneStep) {
    Starting rig;
    ASSERT_TRUE(rig.until([&] { return rig.x.status().setVelocity.count() > 399.0; }));
    const core::Position before = rig.x.status().set;
    for (int i = 0; i < 125; ++i) rig.sleepThrough();
    rig.x.standFor(125);
    rig.cycle();
    EXPECT_NEAR((rig.x.status().set - before).count(), 0.4, 0.001) << "400 mm/s in a millisecond";
    rig.cycles(10);
    EXPECT_EQ(rig.x.state(), AxisState::DiscreteMotion) << axis::errorInfo(rig.x.error().id).name;
}
