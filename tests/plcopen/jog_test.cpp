#include "block_rig.hpp"

using namespace takt;
using namespace takt::test;

namespace {

template <typename Block>
void expectOneSpeaks(const Block& b) {
    EXPECT_LE(int{b.Busy} + int{b.Done} + int{b.Error} + int{b.CommandAborted}, 1);
    EXPECT_TRUE(!b.Active || b.Busy);
    EXPECT_EQ(b.Error, b.ErrorID != ErrorId::None);
}

/// An axis that is on, with software limits at ±50 mm, and one block called in every cycle.
template <typename Block>
struct ButtonRig : BlockRig {
    ButtonRig() : BlockRig{limited()} {
        start();
        block.Velocity = 100.0;
    }
    static axis::AxisParams limited() {
        axis::AxisParams p = testParams();
        p.limits.softNegative = core::Position{-50.0};
        p.limits.softPositive = core::Position{50.0};
        return p;
    }
    void tick(int n = 1) {
        for (int i = 0; i < n; ++i) {
            call(block);
            expectOneSpeaks(block);
        }
    }
    bool tickUntil(const std::function<bool()>& condition) {
        for (int i = 0; i < 20000 && !condition(); ++i) tick();
        return condition();
    }
    [[nodiscard]] double set() const { return x.status().set.count(); }
    [[nodiscard]] double velocity() const { return x.status().setVelocity.count(); }

    Block block;
};

using JogRig = ButtonRig<MC_Jog>;
using InchRig = ButtonRig<MC_Inch>;

}  // namespace

TEST(Jog, MovesWhileTheButtonIsHeldAndRampsToStandstillWhenReleased) {
    JogRig rig;
    rig.block.JogForward = true;
    rig.tick();
    EXPECT_TRUE(rig.block.Active);
    EXPECT_TRUE(rig.status.ContinuousMotion);
    rig.tick(200);
    EXPECT_DOUBLE_EQ(rig.velocity(), 100.0);
    rig.block.JogForward = false;
    rig.tick();
    EXPECT_TRUE(rig.block.Busy);
    ASSERT_TRUE(rig.tickUntil([&] { return !rig.block.Busy; }));
    EXPECT_TRUE(rig.block.Done);
    EXPECT_TRUE(rig.status.Standstill);
    rig.tick();
    EXPECT_FALSE(rig.block.Done);  // for one call
}

TEST(Jog, StandsWhileBothButtonsAreDown) {
    JogRig rig;
    rig.block.JogForward = rig.block.JogBackward = true;
    rig.tick(100);
    EXPECT_EQ(rig.velocity(), 0.0);
    EXPECT_TRUE(rig.status.Standstill);
    EXPECT_FALSE(rig.block.Error);
}

TEST(Jog, StopsWhenTheSecondButtonIsPressedToo) {
    JogRig rig;
    rig.block.JogForward = true;
    rig.tick(200);
    rig.block.JogBackward = true;
    ASSERT_TRUE(rig.tickUntil([&] { return rig.status.Standstill; }));
    EXPECT_GT(rig.set(), 0.0);
}

TEST(Jog, BrakesThroughZeroWhenTheOtherButtonTakesOver) {
    JogRig rig;
    rig.block.JogForward = true;
    rig.tick(150);
    rig.block.JogForward = false;
    rig.tick(5);
    rig.block.JogBackward = true;  // during the ramp
    ASSERT_TRUE(rig.tickUntil([&] { return rig.velocity() == -100.0; }));
    EXPECT_TRUE(rig.block.Active);
}

TEST(Jog, FollowsAChangeOfVelocity) {
    JogRig rig;
    rig.block.Velocity = 20.0;
    rig.block.JogForward = true;
    rig.tick(200);
    EXPECT_DOUBLE_EQ(rig.velocity(), 20.0);
    rig.block.Velocity = 60.0;
    rig.tick(200);
    EXPECT_DOUBLE_EQ(rig.velocity(), 60.0);
    EXPECT_TRUE(rig.block.Active);
}

TEST(Jog, StopsOnTheSoftwareLimitWithoutAnAxisErrorAndGoesBack) {
    JogRig rig;
    rig.block.JogForward = true;
    ASSERT_TRUE(rig.tickUntil([&] { return rig.block.Error; }));
    EXPECT_EQ(rig.block.ErrorID, ErrorId::SWLimitReached);
    ASSERT_TRUE(rig.tickUntil([&] { return rig.status.Standstill; }));
    EXPECT_DOUBLE_EQ(rig.set(), 50.0);
    rig.tick(20);
    EXPECT_TRUE(rig.block.Error);  // the button is still down
    rig.block.JogForward = false;
    rig.tick();
    EXPECT_FALSE(rig.block.Error);
    rig.block.JogForward = true;
    rig.tick();
    EXPECT_EQ(rig.block.ErrorID, ErrorId::SWLimitReached);
    EXPECT_TRUE(rig.status.Standstill);
    rig.block.JogForward = false;
    rig.tick();
    rig.block.JogBackward = true;
    rig.tick(100);
    EXPECT_TRUE(rig.block.Active);
    EXPECT_LT(rig.set(), 50.0);
}

TEST(Jog, NeedsANewPressAfterAnotherBlockTookTheAxis) {
    JogRig rig;
    rig.block.JogForward = true;
    rig.tick(50);
    MC_MoveAbsolute move;
    move.Position = 10.0;
    move.Velocity = 50.0;
    move.Execute = true;
    rig.call(move, rig.block);
    EXPECT_TRUE(rig.block.CommandAborted);
    ASSERT_TRUE(rig.callUntil([&] { return move.Done; }, move, rig.block));
    rig.calls(50, move, rig.block);
    EXPECT_TRUE(rig.status.Standstill);  // the button alone starts nothing
    rig.block.JogForward = false;
    rig.tick();
    EXPECT_FALSE(rig.block.CommandAborted);
    rig.block.JogForward = true;
    rig.tick();
    EXPECT_TRUE(rig.block.Active);
}

TEST(Jog, DoesNotRestartByItselfAfterAFaultAndReset) {
    JogRig rig;
    rig.block.JogForward = true;
    rig.tick(50);
    rig.drive.faultCode = 0x2310;
    rig.tick(5);
    EXPECT_EQ(rig.block.ErrorID, ErrorId::DriveFault);
    rig.drive.faultCode = 0;
    MC_Reset reset;
    reset.Execute = true;
    ASSERT_TRUE(rig.callUntil([&] { return reset.Done; }, reset, rig.block));
    ASSERT_TRUE(rig.callUntil([&] { return rig.status.Standstill; }, reset, rig.block));
    rig.calls(100, reset, rig.block);
    EXPECT_TRUE(rig.status.Standstill);
    EXPECT_TRUE(rig.block.Error);
}

TEST(Jog, RefusesAVelocityThatIsNotPositive) {
    JogRig rig;
    for (const double bad : {0.0, -5.0, std::numeric_limits<double>::quiet_NaN()}) {
        rig.block.Velocity = bad;
        rig.block.JogForward = true;
        rig.tick(3);
        EXPECT_EQ(rig.block.ErrorID, ErrorId::InvalidParameter);
        EXPECT_TRUE(rig.status.Standstill);
        rig.block.JogForward = false;
        rig.tick();
    }
}

TEST(Jog, StopsWhenTheVelocityBecomesInvalidWhileMoving) {
    JogRig rig;
    rig.block.JogForward = true;
    rig.tick(100);
    rig.block.Velocity = 1e6;  // above the axis' limit
    rig.tick();
    EXPECT_EQ(rig.block.ErrorID, ErrorId::LimitExceeded);
    ASSERT_TRUE(rig.tickUntil([&] { return rig.status.Standstill; }));
}

TEST(Jog, AnswersNotPoweredWhileTheAxisIsOff) {
    BlockRig rig;
    MC_Jog jog;
    jog.Velocity = 10.0;
    jog.JogForward = true;
    rig.call(jog);
    EXPECT_EQ(jog.ErrorID, ErrorId::NotPowered);
}

TEST(Jog, AnswersNullReferenceWithoutAnAxis) {
    MC_Jog jog;
    jog.Velocity = 10.0;
    jog.JogForward = true;
    jog(axis::AxisRef{});
    EXPECT_EQ(jog.ErrorID, ErrorId::NullReference);
}

TEST(Inch, MovesTheDistanceOnceHoweverLongTheButtonIsHeld) {
    InchRig rig;
    rig.block.Distance = 2.5;
    rig.block.InchForward = true;
    ASSERT_TRUE(rig.tickUntil([&] { return rig.block.Done; }));
    EXPECT_DOUBLE_EQ(rig.set(), 2.5);
    rig.tick(200);
    EXPECT_DOUBLE_EQ(rig.set(), 2.5);
    EXPECT_FALSE(rig.block.Busy);
}

TEST(Inch, EachPressMovesOnceMore) {
    InchRig rig;
    rig.block.Distance = 1.0;
    for (int press = 1; press <= 3; ++press) {
        rig.block.InchBackward = true;
        ASSERT_TRUE(rig.tickUntil([&] { return rig.block.Done; }));
        EXPECT_DOUBLE_EQ(rig.set(), -1.0 * press);
        rig.block.InchBackward = false;
        rig.tick();
    }
}

TEST(Inch, StopsEarlierWhenReleasedEarlier) {
    InchRig rig;
    rig.block.Distance = 40.0;
    rig.block.InchForward = true;
    rig.tick(150);
    rig.block.InchForward = false;
    ASSERT_TRUE(rig.tickUntil([&] { return rig.block.Done; }));
    EXPECT_TRUE(rig.status.Standstill);
    EXPECT_GT(rig.set(), 1.0);
    EXPECT_LT(rig.set(), 39.0);
}

TEST(Inch, RefusesATargetBeyondASoftwareLimit) {
    InchRig rig;
    rig.block.Distance = 60.0;
    rig.block.InchForward = true;
    rig.tick();
    EXPECT_EQ(rig.block.ErrorID, ErrorId::TargetOutsideSWLimit);
    EXPECT_TRUE(rig.status.Standstill);
}

TEST(Inch, RefusesADistanceThatIsNotPositive) {
    InchRig rig;
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
        rig.block.Distance = bad;
        rig.block.InchForward = true;
        rig.tick();
        EXPECT_EQ(rig.block.ErrorID, ErrorId::InvalidParameter);
        rig.block.InchForward = false;
        rig.tick();
    }
}
