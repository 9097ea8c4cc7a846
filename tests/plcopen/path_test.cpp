#include <gtest/gtest.h>

#include <limits>

#include "../axis/group_rig.hpp"
#include "block_rig.hpp"

namespace takt::test {
namespace {

using axis::RouteDesk;

/// A group whose program calls blocks; ways are planned by the test.
class PathRig : public GroupRig {
public:
    PathRig() : tool{port} { start(); }

    void call(MC_MovePath& move, const MC_PATH_DATA_REF& path) {
        cycle([&] {
            move(tool, path);
            expectExclusive(move);
        });
    }
    void call(TK_PlanPath& plan, MC_PATH_DATA_REF& path) {
        cycle([&] {
            plan(tool, path);
            expectExclusive(plan.Busy, false, plan.Done, plan.Error, false, plan.ErrorID);
        });
    }
    bool callUntilDone(MC_MovePath& move, const MC_PATH_DATA_REF& path) {
        for (int i = 0; i < 10000 && !move.Done; ++i) call(move, path);
        return move.Done;
    }
    /// A square of 40 mm with corners rounded from 3 mm on.
    [[nodiscard]] static MC_PATH_DATA_REF square(double corner = 3.0) {
        MC_PATH_DATA_REF path;
        path.lineTo({40.0, 0.0, 0.0}, corner);
        path.lineTo({40.0, 40.0, 0.0}, corner);
        path.lineTo({0.0, 40.0, 0.0}, corner);
        path.lineTo({0.0, 0.0, 0.0});
        return path;
    }

    axis::GroupRef tool;
};

void execute(MC_MovePath& move, double velocity = 100.0) {
    move.Velocity = velocity;
    move.Execute = true;
}

TEST(MovePath, RunsAllSegmentsAndIsDoneOnce) {
    PathRig rig;
    MC_MovePath move;
    execute(move);
    const MC_PATH_DATA_REF path = PathRig::square();
    rig.call(move, path);
    EXPECT_TRUE(move.Busy);
    EXPECT_FALSE(move.Active);
    double furthest = 0.0;
    int done = 0;
    bool active = false;
    for (int i = 0; i < 10000 && !move.Done; ++i) {
        rig.call(move, path);
        furthest = std::max(furthest, rig.set()[0] + rig.set()[1]);
        active = active || move.Active;
        done += move.Done ? 1 : 0;
    }
    EXPECT_EQ(done, 1);
    EXPECT_TRUE(active);
    // The far corner is passed within its triangle: 3 mm before it on either side, and not at it.
    EXPECT_GT(furthest, 80.0 - 3.0);
    EXPECT_LT(furthest, 80.0 - 0.5);
    EXPECT_EQ(rig.set()[0], 0.0);
    EXPECT_EQ(rig.set()[1], 0.0);
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
}

TEST(MovePath, IsActiveFromTheFirstSegmentOn) {
    PathRig rig;
    MC_MovePath move;
    execute(move);
    const MC_PATH_DATA_REF path = PathRig::square();
    rig.call(move, path);
    for (int i = 0; i < 5; ++i) rig.call(move, path);
    EXPECT_TRUE(move.Active);
    EXPECT_TRUE(move.Busy);
}

TEST(MovePath, GoesExactlyThroughItsCornersWithoutADistance) {
    PathRig rig;
    MC_MovePath move;
    execute(move);
    const MC_PATH_DATA_REF path = PathRig::square(0.0);
    double furthest = 0.0;
    for (int i = 0; i < 10000 && !move.Done; ++i) {
        rig.call(move, path);
        furthest = std::max(furthest, rig.set()[0] + rig.set()[1]);
    }
    EXPECT_NEAR(furthest, 80.0, 1e-9);
}

TEST(MovePath, RunsArcs) {
    PathRig rig;
    MC_MovePath move;
    execute(move);
    MC_PATH_DATA_REF path;
    axis::Arc arc;
    arc.mode = axis::CircMode::Center;
    arc.choice = axis::CircPathChoice::CounterClockwise;
    arc.tolerance = 0.001;
    arc.aux = {0.0, 20.0, 0.0};
    path.arcTo({0.0, 40.0, 0.0}, arc);
    double widest = 0.0;
    for (int i = 0; i < 10000 && !move.Done; ++i) {
        rig.call(move, path);
        widest = std::max(widest, rig.set()[0]);
    }
    EXPECT_TRUE(move.Done);
    EXPECT_NEAR(widest, 20.0, 0.01);
}

TEST(MovePath, IsRefusedWhereTheGroupIsNotAtItsStart) {
    PathRig rig;
    MC_MovePath move;
    execute(move);
    MC_PATH_DATA_REF path = PathRig::square();
    path.start = {0.0, 0.001, 0.0};
    rig.call(move, path);
    EXPECT_TRUE(move.Error);
    EXPECT_EQ(move.ErrorID, ErrorId::NotAtPathStart);
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
}

TEST(MovePath, IsRefusedAsAWholeWhenOneSegmentIs) {
    PathRig rig;
    MC_MovePath move;
    execute(move);
    MC_PATH_DATA_REF path = PathRig::square();
    path.lineTo({0.0, std::numeric_limits<double>::quiet_NaN(), 0.0});
    rig.call(move, path);
    EXPECT_TRUE(move.Error);
    EXPECT_EQ(move.ErrorID, ErrorId::NotFinite);
    EXPECT_EQ(rig.port.view().state, GroupState::Standby);
    for (int i = 0; i < 50; ++i) rig.cycle();
    EXPECT_EQ(rig.set()[0], 0.0);
    EXPECT_EQ(rig.group.state(), GroupState::Standby);
}

TEST(MovePath, DoesNotBlendIntoWhatWentBefore) {
    PathRig rig;
    MC_MovePath move;
    execute(move);
    move.BufferMode = MC_BUFFER_MODE::mcBlendingHigh;
    rig.call(move, PathRig::square());
    EXPECT_EQ(move.ErrorID, ErrorId::BlendingNotPossible);
}

TEST(MovePath, NeedsASegment) {
    PathRig rig;
    MC_MovePath move;
    execute(move);
    rig.call(move, {});
    EXPECT_EQ(move.ErrorID, ErrorId::InvalidParameter);
}

TEST(MovePath, WaitsForTheMotionBeforeItAndBeginsWhereThatEnds) {
    PathRig rig;
    rig.send(lineTo({10.0, 0.0, 0.0}));
    MC_MovePath move;
    execute(move);
    move.BufferMode = MC_BUFFER_MODE::mcBuffered;
    MC_PATH_DATA_REF path;
    path.start = {10.0, 0.0, 0.0};
    path.lineTo({10.0, 20.0, 0.0});
    EXPECT_TRUE(rig.callUntilDone(move, path));
    EXPECT_EQ(rig.set()[0], 10.0);
    EXPECT_EQ(rig.set()[1], 20.0);
}

TEST(MovePath, IsAbortedByAnotherMotion) {
    PathRig rig;
    MC_MovePath move;
    execute(move);
    const MC_PATH_DATA_REF path = PathRig::square();
    for (int i = 0; i < 100; ++i) rig.call(move, path);
    rig.send(groupCommand(GroupCommandKind::Halt));
    rig.call(move, path);
    EXPECT_TRUE(move.CommandAborted);
    EXPECT_FALSE(move.Busy);
}

/// Answers a desk as the machine would.
void answer(RouteDesk& desk, const RouteDesk::Answer& answer) {
    ASSERT_TRUE(desk.wanted());
    desk.finish(answer);
}

RouteDesk::Answer wayTo(const axis::GroupPoint& goal) {
    RouteDesk::Answer found;
    found.path.lineTo(goal);
    found.duration = 1.5;
    return found;
}

TEST(PlanPath, OrdersAWayFromWhereTheGroupStands) {
    PathRig rig;
    rig.port.routes().serve(10);
    rig.send(lineTo({5.0, 0.0, 0.0}));
    ASSERT_TRUE(rig.untilState(GroupState::Standby));
    TK_PlanPath plan;
    MC_PATH_DATA_REF path;
    plan.Goal = {7.0, 8.0, 9.0};
    plan.Rounding = 2.0;
    plan.Seed = 42;
    plan.Execute = true;
    rig.call(plan, path);
    EXPECT_TRUE(plan.Busy);
    ASSERT_TRUE(rig.port.routes().wanted());
    const RouteDesk::Order& order = rig.port.routes().order();
    EXPECT_EQ(order.start[0], 5.0);
    EXPECT_EQ(order.goal[2], 9.0);
    EXPECT_EQ(order.rounding, 2.0);
    EXPECT_EQ(order.seed, 42U);
    EXPECT_EQ(order.members[0], rig.x.view().traits);
}

TEST(PlanPath, OrdersAWayFromTheEndOfWhatIsQueued) {
    PathRig rig;
    rig.port.routes().serve(10);
    rig.send(lineTo({50.0, 0.0, 0.0}));
    TK_PlanPath plan;
    MC_PATH_DATA_REF path;
    plan.Execute = true;
    rig.call(plan, path);
    ASSERT_TRUE(rig.port.routes().wanted());
    EXPECT_EQ(rig.port.routes().order().start[0], 50.0);
}

TEST(PlanPath, ShowsTheAnswerAfterItsCyclesAndNeverEarlier) {
    PathRig rig;
    rig.port.routes().serve(10);
    TK_PlanPath plan;
    MC_PATH_DATA_REF path;
    plan.Execute = true;
    rig.call(plan, path);
    answer(rig.port.routes(), wayTo({1.0, 2.0, 3.0}));
    for (int i = 1; i < 10; ++i) {
        rig.call(plan, path);
        EXPECT_TRUE(plan.Busy) << i;
    }
    EXPECT_TRUE(path.segments.empty());
    rig.call(plan, path);
    EXPECT_TRUE(plan.Done);
    EXPECT_EQ(plan.Duration, 1.5);
    ASSERT_EQ(path.segments.size(), 1U);
    EXPECT_EQ(path.segments[0].point[1], 2.0);
}

TEST(PlanPath, ShowsALateAnswerWhenItIsThere) {
    PathRig rig;
    rig.port.routes().serve(3);
    TK_PlanPath plan;
    MC_PATH_DATA_REF path;
    plan.Execute = true;
    for (int i = 0; i < 50; ++i) rig.call(plan, path);
    EXPECT_TRUE(plan.Busy);
    answer(rig.port.routes(), wayTo({1.0, 2.0, 3.0}));
    rig.call(plan, path);
    EXPECT_TRUE(plan.Done);
}

TEST(PlanPath, SaysWhichKeepOutIsInTheWayAndLeavesThePathAsItWas) {
    PathRig rig;
    rig.port.routes().serve(1);
    TK_PlanPath plan;
    MC_PATH_DATA_REF path = PathRig::square();
    plan.Execute = true;
    rig.call(plan, path);
    RouteDesk::Answer refused;
    refused.error = ErrorId::GoalInKeepOut;
    refused.keepOut = 2;
    answer(rig.port.routes(), refused);
    rig.call(plan, path);
    EXPECT_TRUE(plan.Error);
    EXPECT_EQ(plan.ErrorID, ErrorId::GoalInKeepOut);
    EXPECT_EQ(plan.KeepOut, 2U);
    EXPECT_EQ(path.segments.size(), 4U);
    plan.Execute = false;
    rig.call(plan, path);
    EXPECT_FALSE(plan.Error);
}

TEST(PlanPath, ShowsDoneForOneCallWhenExecuteFellBefore) {
    PathRig rig;
    rig.port.routes().serve(2);
    TK_PlanPath plan;
    MC_PATH_DATA_REF path;
    plan.Execute = true;
    rig.call(plan, path);
    plan.Execute = false;
    answer(rig.port.routes(), wayTo({1.0}));
    rig.call(plan, path);
    EXPECT_TRUE(plan.Busy);
    rig.call(plan, path);
    EXPECT_TRUE(plan.Done);
    rig.call(plan, path);
    EXPECT_FALSE(plan.Done);
}

TEST(PlanPath, WaitsWhileTheDeskWorksForAnother) {
    PathRig rig;
    rig.port.routes().serve(1);
    TK_PlanPath first;
    TK_PlanPath second;
    MC_PATH_DATA_REF path;
    first.Execute = true;
    first.Seed = 1;
    rig.call(first, path);
    second.Execute = true;
    second.Seed = 2;
    rig.call(second, path);
    EXPECT_TRUE(second.Busy);
    EXPECT_EQ(rig.port.routes().order().seed, 1U);
    answer(rig.port.routes(), wayTo({1.0}));
    rig.call(first, path);
    EXPECT_TRUE(first.Done);
    rig.call(second, path);
    EXPECT_EQ(rig.port.routes().order().seed, 2U);
}

TEST(PlanPath, IsRefusedWhereNobodyKnowsTheKeepOuts) {
    PathRig rig;
    TK_PlanPath plan;
    MC_PATH_DATA_REF path;
    plan.Execute = true;
    rig.call(plan, path);
    EXPECT_EQ(plan.ErrorID, ErrorId::ObstaclesMissing);
}

TEST(PlanPath, IsRefusedWithoutAGroup) {
    TK_PlanPath plan;
    MC_PATH_DATA_REF path;
    plan.Execute = true;
    plan({}, path);
    EXPECT_EQ(plan.ErrorID, ErrorId::NullReference);
}

}  // namespace
}  // namespace takt::test
