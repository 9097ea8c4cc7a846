#include <gtest/gtest.h>

#include "group_rig.hpp"

namespace takt::test {
namespace {

using axis::CommandPhase;
using Kind = GroupCommandKind;

// --- states

TEST(Group, BeginsDisabledAndIsEnabledAtOnce) {
    GroupRig rig;
    EXPECT_EQ(rig.group.state(), GroupState::Disabled);
    rig.cycle([&] {
        const auto id = rig.port.submit(groupCommand(Kind::Enable));
        ASSERT_TRUE(id.ok());
        EXPECT_EQ(rig.phase(id.value()), CommandPhase::Done);
        EXPECT_EQ(rig.port.view().state, GroupState::Standby);
    });
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
}

TEST(Group, RefusesMotionWhileDisabled) {
    GroupRig rig;
    rig.powerOn();
    EXPECT_EQ(rig.refusal(lineTo({10.0})), ErrorId::GroupNotEnabled);
    EXPECT_EQ(rig.refusal(groupCommand(Kind::Stop)), ErrorId::GroupNotEnabled);
}

TEST(Group, RefusesMotionWithoutPower) {
    GroupRig rig;
    rig.enable();
    EXPECT_EQ(rig.refusal(lineTo({10.0})), ErrorId::NotPowered);
}

TEST(Group, RefusesMotionWhileAMemberMovesByItself) {
    GroupRig rig;
    rig.start();
    rig.sendAxis(1, moveTo(5.0));
    EXPECT_EQ(rig.refusal(lineTo({10.0})), ErrorId::MemberBusy);
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
}

TEST(Group, MovesALineFromTheFourthCycleAfterTheCommandOn) {
    GroupRig rig;
    rig.start();
    axis::CommandId id{};
    rig.cycle([&] {
        id = rig.port.submit(lineTo({30.0, 40.0, 0.0})).value();
        EXPECT_EQ(rig.phase(id), CommandPhase::Queued);
        EXPECT_EQ(rig.port.view().state, GroupState::Moving);
    });
    EXPECT_EQ(rig.x.state(), AxisState::SynchronizedMotion);
    for (int i = 1; i < 4; ++i) {
        rig.cycle([&] { EXPECT_EQ(rig.phase(id), CommandPhase::Queued) << i; });
        EXPECT_EQ(rig.set()[0], 0.0) << i;
    }
    rig.cycle([&] { EXPECT_EQ(rig.phase(id), CommandPhase::Active); });
    EXPECT_GT(rig.set()[0], 0.0);
}

TEST(Group, EndsALineExactlyWithDoneStandbyAndStandstillInOneCycle) {
    GroupRig rig;
    rig.start();
    const auto id = rig.send(lineTo({30.0, 40.0, 0.0}));
    for (int i = 0; i < 3000 && rig.phase(id) != CommandPhase::Done; ++i) {
        EXPECT_NE(rig.group.state(), GroupState::Standby);
        rig.cycle();
        const GroupPoint p = rig.set();
        EXPECT_NEAR(p[0] * 4.0, p[1] * 3.0, 1e-9);  // on the line
    }
    ASSERT_EQ(rig.phase(id), CommandPhase::Done);
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
    EXPECT_EQ(rig.set()[0], 30.0);
    EXPECT_EQ(rig.set()[1], 40.0);
    EXPECT_NEAR(rig.group.status().path.count(), 50.0, 1e-9);
}

TEST(Group, RefusesSingleAxisMotionOfAMemberWhileItMoves) {
    GroupRig rig;
    rig.start();
    const auto id = rig.send(lineTo({30.0, 0.0, 0.0}));
    rig.cycles(20);
    EXPECT_EQ(rig.axisRefusal(1, moveTo(5.0)), ErrorId::AxisInGroup);
    EXPECT_EQ(rig.axisRefusal(0, buffered(moveTo(5.0))), ErrorId::AxisInGroup);
    EXPECT_EQ(rig.axisRefusal(2, command(axis::CommandKind::Halt)), ErrorId::AxisInGroup);
    EXPECT_EQ(rig.axisRefusal(2, command(axis::CommandKind::Home)), ErrorId::AxisInGroup);
    EXPECT_TRUE(rig.until([&] { return rig.phase(id) == CommandPhase::Done; }));
}

TEST(Group, LetsMembersMoveByThemselvesInStandby) {
    GroupRig rig;
    rig.start();
    rig.sendAxis(1, moveTo(5.0));
    EXPECT_EQ(rig.y.state(), AxisState::DiscreteMotion);
    ASSERT_TRUE(rig.until([&] { return rig.y.state() == AxisState::Standstill; }));
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
    const auto id = rig.send(lineTo({0.0, 10.0, 0.0}));
    ASSERT_TRUE(rig.until([&] { return rig.phase(id) == CommandPhase::Done; }));
    EXPECT_EQ(rig.set()[1], 10.0);
}

TEST(Group, DisablesAfterAStopOnItsPath) {
    GroupRig rig;
    rig.start();
    const auto move = rig.send(lineTo({60.0, 0.0, 0.0}));
    rig.cycles(100);
    const auto disable = rig.send(groupCommand(Kind::Disable));
    EXPECT_EQ(rig.group.state(), GroupState::Stopping);
    rig.cycle();
    EXPECT_EQ(rig.phase(move), CommandPhase::Aborted);
    EXPECT_EQ(rig.phase(disable), CommandPhase::Active);
    ASSERT_TRUE(rig.untilState(GroupState::Disabled, 500));
    EXPECT_EQ(rig.phase(disable), CommandPhase::Done);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
    EXPECT_LT(rig.set()[0], 20.0);
}

// --- members

TEST(Group, TakesAxesByPlaceWhileDisabled) {
    axis::GroupParams params = testGroup();
    params.axes.clear();
    GroupRig rig{params};
    EXPECT_EQ(rig.refusal(groupCommand(Kind::Enable)), ErrorId::GroupIncomplete);
    GroupCommand add = groupCommand(Kind::AddAxis);
    add.axis = &rig.y.traits();
    rig.send(add);
    EXPECT_EQ(rig.refusal(add), ErrorId::InvalidParameter);  // already there
    add.axis = &rig.x.traits();
    add.place = 1;
    EXPECT_EQ(rig.refusal(add), ErrorId::InvalidParameter);  // taken
    add.place = 3;
    rig.send(add);
    EXPECT_EQ(rig.refusal(groupCommand(Kind::Enable)), ErrorId::GroupIncomplete);
    add.axis = &rig.z.traits();
    add.place = 0;
    rig.send(add);  // the free place 2
    rig.start();
    EXPECT_EQ(rig.refusal(add), ErrorId::InvalidState);
    const auto id = rig.send(lineTo({1.0, 2.0, 3.0}));
    ASSERT_TRUE(rig.until([&] { return rig.phase(id) == CommandPhase::Done; }));
    EXPECT_EQ(rig.set(), (GroupPoint{3.0, 1.0, 2.0}));
}

TEST(Group, RemovesAxesAndUngroups) {
    GroupRig rig;
    GroupCommand remove = groupCommand(Kind::RemoveAxis);
    remove.place = 4;
    EXPECT_EQ(rig.refusal(remove), ErrorId::InvalidParameter);
    remove.place = 3;
    rig.send(remove);
    rig.start();
    const auto id = rig.send(lineTo({1.0, 2.0, 3.0}));
    ASSERT_TRUE(rig.until([&] { return rig.phase(id) == CommandPhase::Done; }));
    EXPECT_EQ(rig.set(), (GroupPoint{1.0, 2.0, 0.0}));
    rig.send(groupCommand(Kind::UngroupAll));
    EXPECT_EQ(rig.group.state(), GroupState::Disabled);
    EXPECT_EQ(rig.refusal(groupCommand(Kind::Enable)), ErrorId::GroupIncomplete);
}

TEST(Group, RefusesAMemberOfAnotherGroupThatIsEnabled) {
    GroupRig rig;
    axis::GroupParams params = testGroup();
    params.axes = {2};
    axis::Group other{params, {&rig.x, &rig.y, &rig.z}, GroupRig::Cycle};
    axis::GroupPort port{1};
    rig.enable();
    other.readMembers(1);
    other.openPort(port);
    const auto refused = port.submit(groupCommand(Kind::Enable));
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error(), ErrorId::AxisInOtherGroup);
    rig.send(groupCommand(Kind::Disable));
    other.readMembers(2);
    other.openPort(port);
    EXPECT_TRUE(port.submit(groupCommand(Kind::Enable)).ok());
}

// --- parameters

TEST(Group, RefusesWhatItCannotDo) {
    GroupRig rig;
    rig.start();
    EXPECT_EQ(rig.refusal(lineTo({10.0}, 0.0)), ErrorId::InvalidParameter);
    EXPECT_EQ(rig.refusal(lineTo({10.0}, 301.0)), ErrorId::LimitExceeded);
    EXPECT_EQ(rig.refusal(lineTo({NAN})), ErrorId::NotFinite);
    GroupCommand line = lineTo({10.0});
    line.dynamics.jerk = core::Jerk{60001.0};
    EXPECT_EQ(rig.refusal(line), ErrorId::LimitExceeded);
    line = lineTo({10.0});
    line.coordSystem = axis::CoordSystem::Pcs;
    EXPECT_EQ(rig.refusal(line), ErrorId::CoordSystemNotSupported);
    line = blended(lineTo({10.0}), 0.1);
    line.transition.mode = axis::TransitionMode::ConstantVelocity;
    EXPECT_EQ(rig.refusal(line), ErrorId::TransitionNotSupported);
    EXPECT_EQ(rig.refusal(blended(lineTo({10.0}), 0.0)), ErrorId::TransitionNotSupported);
    EXPECT_EQ(rig.refusal(blended(directTo({10.0}), 0.1)), ErrorId::BlendingNotPossible);
    EXPECT_EQ(rig.refusal(arcTo(axis::CircMode::Border, {5.0}, {10.0})), ErrorId::ArcInvalid);
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST(Group, RefusesTargetsAndArcsOutsideASoftwareLimit) {
    axis::AxisParams params = testParams();
    params.limits.softPositive = core::Position{20.0};
    params.limits.softNegative = core::Position{-20.0};
    GroupRig rig{testGroup(), params};
    rig.start();
    EXPECT_EQ(rig.refusal(lineTo({20.1})), ErrorId::TargetOutsideSWLimit);
    // A half circle from 0 to 30 in Y over X = 15 or X = -15; one over X = 21 by way of the centre.
    EXPECT_EQ(rig.refusal(arcTo(axis::CircMode::Border, {15.0, 15.0}, {0.0, 30.0})),
              ErrorId::TargetOutsideSWLimit);
    EXPECT_EQ(rig.refusal(arcTo(axis::CircMode::Center, {0.0, 10.5}, {0.0, 0.0})),
              ErrorId::TargetOutsideSWLimit);
    EXPECT_EQ(rig.refusal(arcTo(axis::CircMode::Center, {0.0, 9.5}, {0.0, 0.0})), ErrorId::None);
    EXPECT_TRUE(rig.untilState(GroupState::Standby));
}

// --- queue

TEST(Group, RunsBufferedLinesWithAStopBetweenThem) {
    GroupRig rig;
    rig.start();
    const auto first = rig.send(lineTo({20.0, 0.0, 0.0}));
    const auto second = rig.send(buffered(lineTo({20.0, 20.0, 0.0})));
    ASSERT_TRUE(rig.until([&] { return rig.phase(first) == CommandPhase::Done; }));
    EXPECT_NEAR(rig.set()[0], 20.0, 1e-9);
    EXPECT_NEAR(rig.set()[1], 0.0, 1e-4);  // the first step of the second one
    EXPECT_EQ(rig.phase(second), CommandPhase::Active);
    ASSERT_TRUE(rig.until([&] { return rig.phase(second) == CommandPhase::Done; }));
    EXPECT_EQ(rig.set(), (GroupPoint{20.0, 20.0, 0.0}));
}

TEST(Group, BlendsACornerThatIsAskedForWhileMoving) {
    GroupRig rig;
    rig.start();
    const auto first = rig.send(lineTo({20.0, 0.0, 0.0}));
    rig.cycles(100);
    const auto second = rig.send(blended(lineTo({20.0, 20.0, 0.0}), 0.2));
    double nearest = 100.0;
    while (rig.phase(second) != CommandPhase::Done && rig.k < 5000) {
        rig.cycle();
        const GroupPoint p = rig.set();
        nearest = std::min(nearest, std::hypot(p[0] - 20.0, p[1]));
        if (p[0] < 18.0) {
            EXPECT_EQ(p[1], 0.0);
        }
    }
    EXPECT_EQ(rig.phase(first), CommandPhase::Done);
    EXPECT_EQ(rig.set(), (GroupPoint{20.0, 20.0, 0.0}));
    EXPECT_GT(nearest, 0.1);
    EXPECT_LE(nearest, 0.21);  // sampled: the nearest cycle is a little beside
}

TEST(Group, ShowsDoneOfASegmentWhenItsContourIsLeft) {
    GroupRig rig;
    rig.start();
    axis::CommandId first{};
    axis::CommandId second{};
    rig.cycle([&] {
        first = rig.port.submit(lineTo({20.0, 0.0, 0.0})).value();
        second = rig.port.submit(blended(lineTo({20.0, 20.0, 0.0}), 0.2)).value();
    });
    ASSERT_TRUE(rig.until([&] { return rig.phase(first) == CommandPhase::Done; }));
    EXPECT_EQ(rig.phase(second), CommandPhase::Active);
    EXPECT_NEAR(rig.set()[0], 20.0, 1e-6);  // the contour is behind it
    EXPECT_GT(rig.set()[1], 0.5);
}

TEST(Group, CountsRelativeMotionsFromTheEndOfTheOneBefore) {
    GroupRig rig;
    rig.start();
    axis::CommandId last{};
    rig.cycle([&] {
        static_cast<void>(rig.port.submit(relative(lineTo({10.0, 0.0, 0.0}))));
        static_cast<void>(rig.port.submit(relative(buffered(lineTo({0.0, 5.0, 0.0})))));
        last = rig.port.submit(relative(buffered(lineTo({-3.0, 0.0, 2.0})))).value();
    });
    ASSERT_TRUE(rig.until([&] { return rig.phase(last) == CommandPhase::Done; }));
    const GroupPoint end{7.0, 5.0, 2.0};
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(rig.set()[i], end[i], 1e-9);
}

TEST(Group, RefusesWhatDoesNotFitIntoItsQueue) {
    axis::GroupParams params = testGroup();
    params.queueDepth = 2;
    GroupRig rig{params};
    rig.start();
    rig.send(lineTo({20.0, 0.0, 0.0}));
    rig.cycles(5);
    rig.send(buffered(lineTo({0.0, 0.0, 0.0})));
    rig.send(buffered(lineTo({20.0, 0.0, 0.0})));
    EXPECT_EQ(rig.refusal(buffered(lineTo({0.0, 0.0, 0.0}))), ErrorId::BufferFull);
    EXPECT_TRUE(rig.untilState(GroupState::Standby));
    EXPECT_EQ(rig.set()[0], 20.0);
}

TEST(Group, RunsAWholeQueueInOneGo) {
    GroupRig rig;
    rig.start();
    axis::CommandId last{};
    rig.cycle([&] {
        for (int i = 0; i <= 32; ++i) {
            GroupCommand line = blended(lineTo({1.0 + i, 0.1 * (i % 3), 0.0}), 0.01);
            const auto r = rig.port.submit(i == 0 ? lineTo({1.0, 0.0, 0.0}) : line);
            ASSERT_TRUE(r.ok() || i == 33) << i;
            last = r.value();
        }
    });
    ASSERT_TRUE(rig.until([&] { return rig.phase(last) == CommandPhase::Done; }));
    EXPECT_EQ(rig.set()[0], 33.0);
}

TEST(Group, AMotionWithoutLengthIsDoneAtOnce) {
    GroupRig rig;
    rig.start();
    const auto id = rig.send(lineTo({0.0, 0.0, 0.0}));
    ASSERT_TRUE(rig.until([&] { return rig.phase(id) == CommandPhase::Done; }, 10));
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
    EXPECT_EQ(rig.x.state(), AxisState::Standstill);
}

TEST(Group, AnArcThatTurnsOutImpossibleEndsItselfAndWhatFollows) {
    GroupRig rig;
    rig.start();
    const auto first = rig.send(lineTo({20.0, 0.0, 0.0}));
    rig.cycles(30);
    // Aborting while it moves: where the arc begins is known only when the group has stopped.
    const auto arc = rig.send(arcTo(axis::CircMode::Center, {100.0, 0.0}, {20.0, 0.0, 0.0}));
    const auto last = rig.send(buffered(lineTo({0.0, 0.0, 0.0})));
    ASSERT_TRUE(rig.untilState(GroupState::Standby));
    EXPECT_EQ(rig.phase(first), CommandPhase::Aborted);
    EXPECT_EQ(rig.phase(arc), CommandPhase::Error);
    EXPECT_EQ(rig.port.status(arc).error, ErrorId::ArcInvalid);
    EXPECT_EQ(rig.phase(last), CommandPhase::Error);
}

// --- direct motion

TEST(Group, DirectMotionBeginsInItsCycleAndAllAxesArriveTogether) {
    GroupRig rig;
    rig.start();
    const auto id = rig.send(directTo({50.0, 5.0, -10.0}));
    EXPECT_GT(rig.set()[0], 0.0);
    EXPECT_EQ(rig.phase(id), CommandPhase::Active);
    while (rig.phase(id) != CommandPhase::Done && rig.k < 5000) {
        EXPECT_NE(rig.set()[1], 5.0);
        EXPECT_NE(rig.set()[2], -10.0);
        rig.cycle();
        if (rig.set()[0] == 50.0) break;
    }
    EXPECT_EQ(rig.set(), (GroupPoint{50.0, 5.0, -10.0}));
    rig.cycle();
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
}

TEST(Group, RunsDirectMotionsAndPathsOneAfterTheOther) {
    GroupRig rig;
    rig.start();
    axis::CommandId last{};
    rig.cycle([&] {
        static_cast<void>(rig.port.submit(directTo({20.0, 0.0, 0.0})));
        static_cast<void>(rig.port.submit(buffered(lineTo({20.0, 20.0, 0.0}))));
        static_cast<void>(rig.port.submit(relative(buffered(directTo({-20.0, 0.0, 5.0})))));
        last = rig.port.submit(buffered(lineTo({0.0, 0.0, 0.0}))).value();
    });
    ASSERT_TRUE(rig.until([&] { return rig.phase(last) == CommandPhase::Done; }));
    EXPECT_EQ(rig.set(), (GroupPoint{0.0, 0.0, 0.0}));
    EXPECT_EQ(rig.group.status().command, 4U);
}

// --- planning

TEST(Group, WaitsForALatePlanFromRest) {
    GroupRig rig;
    rig.start();
    rig.plannerSleeps = true;
    const auto id = rig.send(lineTo({20.0, 0.0, 0.0}));
    rig.cycles(30);
    EXPECT_EQ(rig.group.state(), GroupState::Moving);
    EXPECT_EQ(rig.set()[0], 0.0);
    EXPECT_EQ(rig.group.status().latePlans, 1U);
    rig.plannerSleeps = false;
    ASSERT_TRUE(rig.until([&] { return rig.phase(id) == CommandPhase::Done; }));
}

TEST(Group, StopsAtTheEndOfWhatIsPlannedWhenAPlanIsLateAndGoesOnWhenItComes) {
    GroupRig rig;
    rig.start();
    const auto first = rig.send(lineTo({20.0, 0.0, 0.0}));
    rig.cycles(50);
    rig.plannerSleeps = true;
    const auto second = rig.send(blended(lineTo({20.0, 20.0, 0.0}), 0.2));
    ASSERT_TRUE(rig.until([&] { return rig.phase(first) == CommandPhase::Done; }));
    rig.cycles(10);
    EXPECT_EQ(rig.set(), (GroupPoint{20.0, 0.0, 0.0}));
    rig.plannerSleeps = false;
    ASSERT_TRUE(rig.until([&] { return rig.phase(second) == CommandPhase::Done; }));
    EXPECT_EQ(rig.set(), (GroupPoint{20.0, 20.0, 0.0}));
    EXPECT_EQ(rig.group.status().latePlans, 1U);
}

TEST(Group, GivesASlowPlannerMoreTimeUntilItIsInTime) {
    GroupRig rig;
    rig.start();
    const auto first = rig.send(lineTo({100.0, 0.0, 0.0}));
    rig.cycles(50);
    rig.plannerSleeps = true;
    const auto second = rig.send(buffered(lineTo({100.0, 20.0, 0.0})));
    // It takes 30 cycles for each plan: too long for the first, not for the second.
    for (int plan = 0; plan < 2; ++plan) {
        ASSERT_TRUE(rig.until([&] { return rig.group.planner().wanted(); }, 100));
        rig.cycles(30);
        rig.group.planner().work();
    }
    rig.plannerSleeps = false;
    rig.cycles(60);
    EXPECT_EQ(rig.group.status().latePlans, 1U);
    EXPECT_EQ(rig.phase(first), CommandPhase::Active);
    ASSERT_TRUE(rig.until([&] { return rig.phase(second) == CommandPhase::Done; }));
    EXPECT_EQ(rig.group.status().latePlans, 1U);
}

TEST(Group, GivesUpWhenThePlanDoesNotComeForASecond) {
    GroupRig rig;
    rig.start();
    rig.plannerSleeps = true;
    const auto id = rig.send(lineTo({20.0, 0.0, 0.0}));
    ASSERT_TRUE(rig.untilState(GroupState::ErrorStop, 1100));
    EXPECT_EQ(rig.group.view().error.id, ErrorId::PlanningLate);
    EXPECT_EQ(rig.port.status(id).error, ErrorId::PlanningLate);
}

TEST(Group, ThrowsAPlanAwayWhoseMotionWasAborted) {
    GroupRig rig;
    rig.start();
    rig.plannerSleeps = true;
    const auto line = rig.send(lineTo({20.0, 0.0, 0.0}));
    const auto halt = rig.send(groupCommand(Kind::Halt));
    rig.plannerSleeps = false;
    ASSERT_TRUE(rig.until([&] { return rig.phase(halt) == CommandPhase::Done; }, 20));
    rig.cycles(20);
    EXPECT_EQ(rig.phase(line), CommandPhase::Aborted);
    EXPECT_EQ(rig.set()[0], 0.0);
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
}

}  // namespace
}  // namespace takt::test
