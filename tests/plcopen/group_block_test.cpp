#include <gtest/gtest.h>

#include <type_traits>

#include "../axis/group_rig.hpp"
#include "block_rig.hpp"

namespace takt::test {
namespace {

template <typename Block>
void expectRules(const Block& b) {
    if constexpr (std::is_same_v<Block, MC_GroupStop>) {
        // The lock after Done is shown by Active; see the block's own words.
        expectExclusive(b.Busy, b.Active && !b.Done, b.Done, b.Error, b.CommandAborted, b.ErrorID);
    } else if constexpr (requires { b.CommandAborted; }) {
        expectExclusive(b);
    } else {
        expectExclusive(b.Busy, false, b.Done, b.Error, false, b.ErrorID);
    }
}

/// A group rig whose program calls the blocks given, in this order, in every cycle.
class GroupBlocks : public testing::Test {
protected:
    template <typename... Blocks>
    void call(Blocks&... blocks) {
        rig.cycle([&] {
            (one(blocks), ...);
            status(group);
        });
    }
    template <typename Condition, typename... Blocks>
    [[nodiscard]] bool callUntil(Condition&& condition, Blocks&... blocks) {
        for (int i = 0; i < 20000 && !condition(); ++i) call(blocks...);
        return condition();
    }
    void SetUp() override {
        status.Enable = true;
        rig.powerOn();
        MC_GroupEnable enable;
        enable.Execute = true;
        call(enable);
        ASSERT_TRUE(enable.Done);
        ASSERT_TRUE(status.GroupStandby);
    }

    GroupRig rig;
    axis::GroupRef group{rig.port};
    axis::AxisRef axisX{rig.portX};
    MC_GroupReadStatus status;

private:
    template <typename Block>
    void one(Block& block) {
        block(group);
        if constexpr (requires { block.Execute; }) expectRules(block);
    }
};

MC_MoveLinearAbsolute& to(MC_MoveLinearAbsolute& line, double x, double y, double z = 0.0) {
    line.Position = {x, y, z};
    line.Velocity = 100.0;
    line.Execute = true;
    return line;
}

TEST_F(GroupBlocks, ALineIsBusyAtOnceActiveWithItsFirstSetPointAndDoneAtItsEnd) {
    MC_MoveLinearAbsolute line;
    call(to(line, 12.0, 9.0));
    EXPECT_TRUE(line.Busy);
    EXPECT_FALSE(line.Active);
    EXPECT_TRUE(status.GroupMoving);
    for (int i = 0; i < 3; ++i) {
        call(line);
        EXPECT_FALSE(line.Active);
        EXPECT_EQ(rig.set()[0], 0.0);
    }
    call(line);
    EXPECT_TRUE(line.Active);
    EXPECT_GT(rig.set()[0], 0.0);
    ASSERT_TRUE(callUntil([&] { return line.Done; }, line));
    EXPECT_EQ(rig.set(), (GroupPoint{12.0, 9.0, 0.0}));
    EXPECT_TRUE(status.GroupStandby);
    line.Execute = false;
    call(line);
    EXPECT_FALSE(line.Done);
}

TEST_F(GroupBlocks, ABlockWhoseExecuteFellShowsItsEndForOneCall) {
    MC_MoveLinearAbsolute line;
    call(to(line, 3.0, 0.0));
    line.Execute = false;
    int done = 0;
    for (int i = 0; i < 1000; ++i) {
        call(line);
        done += line.Done ? 1 : 0;
    }
    EXPECT_EQ(done, 1);
}

TEST_F(GroupBlocks, RelativeLinesAddUp) {
    std::array<MC_MoveLinearRelative, 3> lines;
    for (auto& line : lines) {
        line.Distance = {2.0, -1.0, 0.5};
        line.Velocity = 50.0;
        line.BufferMode = MC_BUFFER_MODE::mcBuffered;
        line.Execute = true;
    }
    ASSERT_TRUE(callUntil([&] { return lines[2].Done; }, lines[0], lines[1], lines[2]));
    EXPECT_NEAR(rig.set()[0], 6.0, 1e-12);
    EXPECT_NEAR(rig.set()[1], -3.0, 1e-12);
    EXPECT_NEAR(rig.set()[2], 1.5, 1e-12);
}

TEST_F(GroupBlocks, CirclesByBorderCentreAndRadiusAreTheSameQuarter) {
    struct Case {
        MC_CIRC_MODE mode;
        plcopen::GroupArray aux;
        MC_CIRC_PATHCHOICE choice;
    };
    const double s = std::sqrt(0.5);
    // From (0, 0) round (0, 10) to (10, 10): seen from above to the left.
    const std::array<Case, 3> cases{
        {{MC_CIRC_MODE::mcBorder, {10.0 * s, 10.0 - 10.0 * s}, {}},
         {MC_CIRC_MODE::mcCenter, {0.0, 10.0}, MC_CIRC_PATHCHOICE::mcCounterClockwise},
         {MC_CIRC_MODE::mcRadius, {0.0, 0.0, 10.0}, MC_CIRC_PATHCHOICE::mcCounterClockwise}}};
    for (const Case& one : cases) {
        MC_MoveCircularAbsolute arc;
        arc.CircMode = one.mode;
        arc.AuxPoint = one.aux;
        arc.EndPoint = {10.0, 10.0};
        arc.PathChoice = one.choice;
        arc.Velocity = 80.0;
        arc.Execute = true;
        while (!arc.Done && !arc.Error && rig.k < 20000) {
            call(arc);
            const GroupPoint p = rig.set();
            EXPECT_NEAR(std::hypot(p[0], p[1] - 10.0), 10.0, 1e-9);
            EXPECT_GE(p[0], -1e-9);
            EXPECT_LE(p[1], 10.0 + 1e-9);
        }
        ASSERT_TRUE(arc.Done) << axis::errorInfo(arc.ErrorID).name;
        EXPECT_EQ(rig.set(), (GroupPoint{10.0, 10.0, 0.0}));
        MC_MoveDirectAbsolute home;
        home.Execute = true;
        ASSERT_TRUE(callUntil([&] { return home.Done; }, home));
    }
}

TEST_F(GroupBlocks, ARelativeCircleCountsBothPointsFromItsStart) {
    MC_MoveLinearAbsolute line;
    ASSERT_TRUE(callUntil([&] { return line.Done; }, to(line, 5.0, 5.0, 5.0)));
    MC_MoveCircularRelative arc;
    arc.CircMode = MC_CIRC_MODE::mcCenter;
    arc.AuxPoint = {0.0, 4.0, 0.0};
    arc.EndPoint = {0.0, 8.0, 0.0};
    arc.PathChoice = MC_CIRC_PATHCHOICE::mcClockwise;
    arc.Velocity = 50.0;
    arc.Execute = true;
    double leftmost = 5.0;
    while (!arc.Done && !arc.Error && rig.k < 20000) {
        call(arc);
        leftmost = std::min(leftmost, rig.set()[0]);
    }
    ASSERT_TRUE(arc.Done) << axis::errorInfo(arc.ErrorID).name;
    EXPECT_NEAR(leftmost, 1.0, 1e-3);
    EXPECT_NEAR(rig.set()[1], 13.0, 1e-12);
}

TEST_F(GroupBlocks, AnAbortingLineTakesControlAndTheFirstShowsCommandAborted) {
    MC_MoveLinearAbsolute first;
    MC_MoveLinearAbsolute second;
    call(to(first, 40.0, 0.0));
    for (int i = 0; i < 100; ++i) call(first);
    to(second, 0.0, 10.0);
    call(second, first);
    EXPECT_TRUE(second.Busy);
    EXPECT_TRUE(first.CommandAborted);
    ASSERT_TRUE(callUntil([&] { return second.Done; }, second, first));
    EXPECT_EQ(rig.set(), (GroupPoint{0.0, 10.0, 0.0}));
}

TEST_F(GroupBlocks, ABufferedLineOnABusyInstanceIsRefused) {
    MC_MoveLinearAbsolute line;
    call(to(line, 40.0, 0.0));
    line.Execute = false;
    call(line);
    line.BufferMode = MC_BUFFER_MODE::mcBuffered;
    line.Execute = true;
    call(line);
    EXPECT_TRUE(line.Error);
    EXPECT_EQ(line.ErrorID, ErrorId::InstanceBusy);
}

TEST_F(GroupBlocks, GroupStopHoldsTheGroupUntilItsExecuteFalls) {
    MC_MoveLinearAbsolute line;
    MC_MoveLinearAbsolute other;
    MC_GroupStop stop;
    call(to(line, 40.0, 0.0));
    for (int i = 0; i < 100; ++i) call(line);
    stop.Execute = true;
    call(stop, line);
    EXPECT_TRUE(stop.Busy);
    EXPECT_TRUE(status.GroupStopping);
    EXPECT_TRUE(line.CommandAborted);
    call(stop, to(other, 0.0, 0.0));
    EXPECT_EQ(other.ErrorID, ErrorId::GroupLocked);
    ASSERT_TRUE(callUntil([&] { return stop.Done; }, stop));
    EXPECT_TRUE(stop.Active);
    EXPECT_TRUE(status.GroupStopping);
    stop.Execute = false;
    call(stop);
    EXPECT_TRUE(status.GroupStandby);
}

TEST_F(GroupBlocks, GroupStopAtRestIsDoneInItsCall) {
    MC_GroupStop stop;
    stop.Execute = true;
    call(stop);
    EXPECT_TRUE(stop.Done);
    EXPECT_TRUE(status.GroupStopping);
    stop.Execute = false;
    call(stop);
    EXPECT_TRUE(status.GroupStandby);
}

TEST_F(GroupBlocks, GroupHaltIsDoneAtRestInStandby) {
    MC_MoveDirectAbsolute move;
    MC_GroupHalt halt;
    move.Position = {50.0, 20.0, 0.0};
    move.Execute = true;
    call(move);
    EXPECT_TRUE(move.Active);
    for (int i = 0; i < 60; ++i) call(move);
    halt.Execute = true;
    call(halt, move);
    EXPECT_TRUE(halt.Active);
    EXPECT_TRUE(move.CommandAborted);
    EXPECT_TRUE(status.GroupMoving);
    ASSERT_TRUE(callUntil([&] { return halt.Done; }, halt));
    EXPECT_TRUE(status.GroupStandby);
    EXPECT_LT(rig.set()[0], 50.0);
}

TEST_F(GroupBlocks, SingleAxisBlocksAreRefusedWhileTheGroupMoves) {
    MC_MoveLinearAbsolute line;
    MC_MoveAbsolute move;
    move.Position = 5.0;
    move.Velocity = 10.0;
    move.Execute = true;
    to(line, 20.0, 0.0);
    // In one cycle: the group is asked first or last, it has the axis.
    rig.cycle([&] {
        line(group);
        move(axisX);
    });
    rig.cycle([&] {
        line(group);
        move(axisX);
    });
    EXPECT_TRUE(move.Error);
    EXPECT_EQ(move.ErrorID, ErrorId::AxisInGroup);
    ASSERT_TRUE(callUntil([&] { return line.Done; }, line));
}

TEST_F(GroupBlocks, AddAndRemoveChangeTheMembersOfADisabledGroup) {
    MC_RemoveAxisFromGroup remove;
    MC_AddAxisToGroup add;
    MC_GroupDisable disable;
    MC_UngroupAllAxes ungroup;
    MC_GroupEnable enable;
    remove.IdentInGroup = 1;
    remove.Execute = true;
    call(remove);
    EXPECT_EQ(remove.ErrorID, ErrorId::InvalidState);
    disable.Execute = true;
    call(disable);
    EXPECT_TRUE(disable.Done);
    EXPECT_TRUE(status.GroupDisabled);
    remove.Execute = false;
    call(remove);
    remove.Execute = true;
    call(remove);
    EXPECT_TRUE(remove.Done);
    enable.Execute = true;
    call(enable);
    EXPECT_EQ(enable.ErrorID, ErrorId::GroupIncomplete);
    add.IdentInGroup = 1;
    add.Execute = true;
    rig.cycle([&] { add(group, axisX); });
    EXPECT_TRUE(add.Done);
    enable.Execute = false;
    call(enable);
    enable.Execute = true;
    call(enable);
    EXPECT_TRUE(enable.Done);
    ungroup.Execute = true;
    call(ungroup);
    EXPECT_TRUE(ungroup.Done);
    EXPECT_TRUE(status.GroupDisabled);
}

TEST_F(GroupBlocks, ReadBlocksShowPositionsStateAndError) {
    MC_MoveLinearAbsolute line;
    ASSERT_TRUE(callUntil([&] { return line.Done; }, to(line, 4.0, 6.0, 8.0)));
    for (int i = 0; i < 10; ++i) call(line);
    MC_GroupReadActualPosition position;
    MC_GroupReadError error;
    position.Enable = error.Enable = true;
    call(position, error);
    EXPECT_TRUE(position.Valid);
    EXPECT_NEAR(position.Position[0], 4.0, 0.01);
    EXPECT_NEAR(position.Position[2], 8.0, 0.01);
    EXPECT_EQ(error.ErrorID, ErrorId::None);
    rig.drives[1].faultCode = 0x7305;
    for (int i = 0; i < 5; ++i) call(error);
    EXPECT_TRUE(status.GroupErrorStop);
    EXPECT_TRUE(error.Valid);
    EXPECT_EQ(error.ErrorID, ErrorId::DriveFault);
    position.CoordSystem = MC_COORD_SYSTEM::mcPCS;
    call(position);
    EXPECT_TRUE(position.Error);
    EXPECT_EQ(position.ErrorID, ErrorId::CoordSystemNotSupported);
    position.Enable = false;
    call(position);
    EXPECT_FALSE(position.Error);
}

TEST_F(GroupBlocks, AReferenceToNothingIsAnError) {
    MC_MoveLinearAbsolute line;
    MC_GroupReadStatus read;
    read.Enable = true;
    to(line, 1.0, 0.0);
    rig.cycle([&] {
        line(axis::GroupRef{});
        read(axis::GroupRef{});
    });
    EXPECT_EQ(line.ErrorID, ErrorId::NullReference);
    EXPECT_EQ(read.ErrorID, ErrorId::NullReference);
}

TEST_F(GroupBlocks, ResetIsDoneWithTheGroupInStandby) {
    rig.drives[1].faultCode = 0x7305;
    ASSERT_TRUE(callUntil([&] { return status.GroupErrorStop; }));
    rig.drives[1].faultCode = 0;
    MC_GroupReset reset;
    reset.Execute = true;
    ASSERT_TRUE(callUntil([&] { return reset.Done; }, reset));
    EXPECT_TRUE(status.GroupStandby);
}

}  // namespace
}  // namespace takt::test
