#include "block_rig.hpp"

using namespace takt;
using namespace takt::test;

namespace {

axis::AxisParams roomy() {
    auto p = testParams();
    p.limits.acceleration = p.limits.deceleration = core::Acceleration{1000.0};
    p.limits.jerk = core::Jerk{10000.0};
    return p;
}

/// Runs two moves in a row, the second given `later` cycles after the first.
class Pair {
public:
    explicit Pair(const axis::AxisParams& params = roomy()) : rig{params} { rig.start(); }

    void set(double p1, double v1, double p2, double v2, MC_BUFFER_MODE mode) {
        setMove(first, p1, v1);
        setMove(second, p2, v2);
        second.BufferMode = mode;
    }
    /// \return the velocity at which the first end position was passed
    double run(int later) {
        const double joint = first.Position;
        const double sign = joint > rig.x.status().set.count() ? 1.0 : -1.0;
        double velocity = -1.0;
        double before = rig.x.status().setVelocity.count();
        first.Execute = true;
        for (int i = 0; i < 60000 && !second.Done; ++i) {
            if (i == later) second.Execute = true;
            rig.call(first, second);
            const auto s = rig.x.status();
            fastest = std::max(fastest, std::abs(s.setVelocity.count()));
            farthest = std::max(farthest, sign * s.set.count());
            if (velocity < 0.0 && sign * (s.set.count() - joint) >= 0.0) {
                velocity = 0.5 * (std::abs(before) + std::abs(s.setVelocity.count()));
                if (s.set.count() == joint) velocity = std::abs(s.setVelocity.count());
                passedAt = i;
            }
            if (doneAt < 0 && first.Done) {
                doneAt = i;
                activeWithDone = second.Active;
            }
            before = s.setVelocity.count();
            cycles = i;
        }
        return velocity;
    }

    BlockRig rig;
    MC_MoveAbsolute first;
    MC_MoveAbsolute second;
    double fastest{0.0};
    double farthest{-1e300};
    int passedAt{-1};
    int doneAt{-1};
    int cycles{0};
    bool activeWithDone{false};
};

struct Case {
    MC_BUFFER_MODE mode;
    double v1;
    double v2;
    double joint;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << "mode " << static_cast<int>(c.mode) << ", " << c.v1 << " then " << c.v2;
}

class Golden : public testing::TestWithParam<Case> {};

using enum MC_BUFFER_MODE;

}  // namespace

// MC_MoveAbsolute 1000, then 2000 while the first is moving: the velocity at 1000.
TEST_P(Golden, TheEndOfTheFirstIsPassedAtTheVelocityOfTheMode) {
    const Case& c = GetParam();
    for (const double sign : {1.0, -1.0}) {
        Pair pair;
        pair.set(sign * 1000.0, c.v1, sign * 2000.0, c.v2, c.mode);
        // The cycle may lie up to one step of acceleration beside the joint.
        EXPECT_NEAR(pair.run(500), c.joint, 1.0);
        EXPECT_EQ(pair.rig.x.status().set.count(), sign * 2000.0);
        EXPECT_LE(pair.fastest, std::max(c.v1, c.v2) * (1.0 + 1e-9));
        EXPECT_EQ(pair.farthest, 2000.0);
        EXPECT_EQ(pair.doneAt, pair.passedAt + 1);
        EXPECT_TRUE(pair.activeWithDone);
    }
}

INSTANTIATE_TEST_SUITE_P(Modes, Golden,
                         testing::Values(Case{mcBuffered, 50.0, 100.0, 0.0},
                                         Case{mcBuffered, 100.0, 50.0, 0.0},
                                         Case{mcBlendingLow, 50.0, 100.0, 50.0},
                                         Case{mcBlendingLow, 100.0, 50.0, 50.0},
                                         Case{mcBlendingPrevious, 50.0, 100.0, 50.0},
                                         Case{mcBlendingPrevious, 100.0, 50.0, 100.0},
                                         Case{mcBlendingNext, 50.0, 100.0, 100.0},
                                         Case{mcBlendingNext, 100.0, 50.0, 50.0},
                                         Case{mcBlendingHigh, 50.0, 100.0, 100.0},
                                         Case{mcBlendingHigh, 100.0, 50.0, 100.0}));

TEST(Blending, PassesTheEndExactlyAndLosesNoTime) {
    // Equal velocities: the chain is one move. 300 mm at 100 mm/s take 3 + 0.1 + 0.1 s = 3200
    // cycles, wherever it is divided.
    for (const double joint : {100.0, 123.4567, 33.333333}) {
        Pair pair;
        pair.set(joint, 100.0, 300.0, 100.0, mcBlendingPrevious);
        pair.run(0);
        EXPECT_EQ(pair.cycles, 3200) << joint;  // Done is seen one cycle behind the last step
    }
}

TEST(Blending, KeepsTheFirstVelocityUntilTheLastRampToAFasterOne) {
    Pair pair;
    pair.set(500.0, 50.0, 1000.0, 100.0, mcBlendingNext);
    pair.first.Execute = pair.second.Execute = true;
    // 50 to 100 mm/s at 1000 mm/s² and 10000 mm/s³: 2·sqrt(50/10000) s at 75 mm/s on average.
    const double ramp = 75.0 * 2.0 * std::sqrt(50.0 / 10000.0);
    while (pair.rig.x.status().set.count() < 500.0 - ramp - 0.2) {
        pair.rig.call(pair.first, pair.second);
        ASSERT_LE(pair.rig.x.status().setVelocity.count(), 50.0 * (1.0 + 1e-9));
    }
    ASSERT_TRUE(pair.rig.callUntil([&] { return pair.first.Done; }, pair.first, pair.second));
    EXPECT_NEAR(pair.rig.x.status().setVelocity.count(), 100.0, 0.5);
}

TEST(Blending, AReversalIsBuffered) {
    for (const auto mode : {mcBlendingLow, mcBlendingPrevious, mcBlendingNext, mcBlendingHigh}) {
        Pair blended;
        Pair buffered;
        blended.set(100.0, 50.0, 20.0, 80.0, mode);
        buffered.set(100.0, 50.0, 20.0, 80.0, mcBuffered);
        EXPECT_NEAR(blended.run(10), 0.0, 1e-9);
        buffered.run(10);
        EXPECT_EQ(blended.farthest, 100.0);
        EXPECT_EQ(blended.cycles, buffered.cycles);
    }
}

TEST(Blending, ALateSuccessorSpeedsUpAgainAsFarAsItCan) {
    // The first takes 1.101 s and brakes from 1.0 s on.
    auto p = roomy();
    p.limits.jerk = core::Jerk{1e6};
    double last = 100.0 + 1e-6;
    for (const int later : {900, 1010, 1030, 1050, 1070}) {
        Pair pair{p};
        pair.set(100.0, 100.0, 300.0, 100.0, mcBlendingPrevious);
        const double v = pair.run(later);
        // What is left of the way with the full acceleration from the velocity at that moment; the
        // jerk limit takes its share.
        const double braked = std::max(0.0, 0.001 * later - 1.0);
        const double left = 5.05 - braked * (100.0 - 500.0 * braked);
        const double bound = std::sqrt(std::pow(100.0 - 1000.0 * braked, 2) + 2000.0 * left);
        EXPECT_LE(v, std::min(100.0 + 1e-6, bound + 2.0)) << later;
        EXPECT_GT(v, 0.8 * std::min(100.0, bound)) << later;
        EXPECT_LE(v, last) << later;
        EXPECT_EQ(pair.farthest, 300.0) << later;
        last = v;
    }
    EXPECT_LT(last, 70.0);
}

TEST(Blending, ASuccessorThatComesTooLateForAnySpeedIsBuffered) {
    Pair pair;
    pair.set(100.0, 100.0, 300.0, 100.0, mcBlendingPrevious);
    EXPECT_NEAR(pair.run(1195), 0.0, 1.0);
    EXPECT_EQ(pair.farthest, 300.0);
    EXPECT_EQ(pair.rig.x.status().set.count(), 300.0);
}

TEST(Blending, ASuccessorBehindTheEndStartsAtOnce) {
    Pair pair;
    pair.set(50.0, 100.0, 80.0, 100.0, mcBlendingHigh);
    EXPECT_GE(pair.run(1500), 0.0);
    EXPECT_EQ(pair.rig.x.status().set.count(), 80.0);
}

TEST(Blending, NeverOverrunsAShortSuccessor) {
    // From 100 mm/s 10 mm are needed to brake; there are 2.
    Pair pair;
    pair.set(100.0, 100.0, 102.0, 100.0, mcBlendingHigh);
    const double v = pair.run(0);
    EXPECT_EQ(pair.farthest, 102.0);
    // 2 mm with the jerk limit alone: v·sqrt(v/j) = 2.
    EXPECT_NEAR(v, std::cbrt(2.0 * 2.0 * 10000.0), 1.0);
}

TEST(Blending, AChainOfShortMovesNeverStopsInBetween) {
    auto p = roomy();
    p.queueDepth = 32;
    BlockRig rig{p};
    rig.start();
    std::array<MC_MoveRelative, 20> moves;
    for (auto& m : moves) {
        m.Distance = 2.0;
        m.Velocity = 100.0;
        m.BufferMode = mcBlendingPrevious;
        m.Execute = true;
    }
    double fastest = 0.0;
    for (int i = 0; i < 5000 && !moves.back().Done; ++i) {
        rig.cycle([&] {
            // Only so many commands fit into one program cycle.
            const std::size_t known = i == 0 ? 10 : moves.size();
            for (std::size_t m = 0; m < known; ++m) moves[m](rig.axisX);
        });
        const auto s = rig.x.status();
        fastest = std::max(fastest, s.setVelocity.count());
        if (s.set.count() > 1.0 && s.set.count() < 39.0) {
            EXPECT_GT(s.setVelocity.count(), 10.0) << s.set.count();
        }
        int active = 0;
        for (const auto& m : moves) active += int{m.Active};
        EXPECT_LE(active, 1);
    }
    EXPECT_TRUE(moves.back().Done);
    EXPECT_EQ(rig.x.status().state, AxisState::Standstill);
    EXPECT_NEAR(rig.x.status().set.count(), 40.0, 1e-12);
    // A single move of 2 mm comes to 27 mm/s.
    EXPECT_GT(fastest, 60.0);
}

TEST(Blending, MovesShorterThanACycleArePassedAllAtOnce) {
    BlockRig rig{roomy()};
    rig.start();
    MC_MoveAbsolute first;
    MC_MoveAbsolute last;
    std::array<MC_MoveRelative, 4> between;
    setMove(first, 100.0);
    first.Execute = true;
    setMove(last, 200.0);
    last.BufferMode = mcBlendingPrevious;
    for (auto& m : between) {
        m.Distance = 0.03;  // a cycle makes 0.1
        m.Velocity = 100.0;
        m.BufferMode = mcBlendingPrevious;
        m.Execute = true;
    }
    last.Execute = true;
    double slowest = 1e9;
    for (int i = 0; i < 9000 && !last.Done; ++i) {
        rig.call(first, between[0], between[1], between[2], between[3], last);
        const auto s = rig.x.status();
        if (s.set.count() > 50.0 && s.set.count() < 150.0) {
            slowest = std::min(slowest, s.setVelocity.count());
        }
    }
    EXPECT_TRUE(last.Done);
    for (const auto& m : between) EXPECT_TRUE(m.Done);
    EXPECT_NEAR(slowest, 100.0, 1e-6);
}

TEST(Blending, AVelocityMoveTakesOverAtThePreviousVelocity) {
    for (const auto mode : {mcBlendingLow, mcBlendingPrevious, mcBlendingNext, mcBlendingHigh}) {
        BlockRig rig{roomy()};
        rig.start();
        MC_MoveAbsolute move;
        MC_MoveVelocity run;
        setMove(move, 100.0, 60.0);
        run.Velocity = 200.0;
        run.BufferMode = mode;
        move.Execute = run.Execute = true;
        ASSERT_TRUE(rig.callUntil([&] { return move.Done; }, move, run));
        EXPECT_TRUE(run.Active);
        EXPECT_TRUE(rig.status.ContinuousMotion);
        EXPECT_NEAR(rig.x.status().setVelocity.count(), 60.0, 0.1);
        ASSERT_TRUE(rig.callUntil([&] { return run.InVelocity; }, move, run));
        EXPECT_EQ(rig.x.status().setVelocity.count(), 200.0);
    }
}

TEST(Blending, OfAMotionWithoutEndIsRefused) {
    BlockRig rig;
    rig.start();
    MC_MoveVelocity run;
    MC_MoveAbsolute move;
    run.Velocity = 50.0;
    run.Execute = true;
    rig.call(run, move);
    setMove(move, 100.0);
    move.BufferMode = mcBlendingLow;
    move.Execute = true;
    rig.call(run, move);
    EXPECT_EQ(move.ErrorID, ErrorId::BlendingNotPossible);
    EXPECT_TRUE(run.Active);
    // Also behind one that only waits.
    MC_MoveAbsolute before;
    MC_MoveVelocity waiting;
    MC_MoveAbsolute after;
    setMove(before, 200.0);
    waiting.Velocity = 50.0;
    waiting.BufferMode = mcBuffered;
    setMove(after, 300.0);
    after.BufferMode = mcBlendingHigh;
    before.Execute = waiting.Execute = after.Execute = true;
    rig.call(before, waiting, after);
    EXPECT_EQ(after.ErrorID, ErrorId::BlendingNotPossible);
    EXPECT_TRUE(waiting.Busy);
}

TEST(Blending, AnAbortClearsTheChainAndBrakesFromTheJointVelocity) {
    Pair pair;
    pair.set(100.0, 100.0, 300.0, 100.0, mcBlendingPrevious);
    pair.first.Execute = pair.second.Execute = true;
    while (pair.rig.x.status().set.count() < 99.0) pair.rig.call(pair.first, pair.second);
    MC_Halt halt;
    halt.Execute = true;
    pair.rig.call(pair.first, pair.second, halt);
    ASSERT_TRUE(pair.rig.callUntil([&] { return halt.Done; }, pair.first, pair.second, halt));
    EXPECT_TRUE(pair.first.CommandAborted && pair.second.CommandAborted);
    // 100 mm/s to rest: 50 mm/s on average for 0.2 s.
    EXPECT_NEAR(pair.rig.x.status().set.count(), 109.0, 0.2);
}

TEST(Blending, ATurnOfAModuloAxisGoesOnOverTheWrap) {
    auto p = roomy();
    p.scaling.modulo = core::Distance{360.0};
    p.scaling.unitsPerTurnNumerator = 360;
    Pair pair{p};
    pair.set(350.0, 100.0, 10.0, 100.0, mcBlendingPrevious);
    pair.first.Direction = pair.second.Direction = MC_DIRECTION::mcPositiveDirection;
    EXPECT_NEAR(pair.run(0), 100.0, 1e-6);
    EXPECT_NEAR(pair.rig.x.status().set.count(), 370.0, 1e-9);
}
