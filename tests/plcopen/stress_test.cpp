#include <array>
#include <limits>

#include "block_rig.hpp"

using namespace takt;
using namespace takt::test;

namespace {

/// splitmix64: the same numbers on every machine.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_{seed} {}
    std::uint64_t next() {
        state_ += 0x9E3779B97F4A7C15ULL;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
        return z ^ (z >> 31U);
    }
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(next() >> 11U) / 9007199254740992.0);
    }
    bool chance(double p) { return between(0.0, 1.0) < p; }
    /// Mostly a fair value, now and then the default or nonsense.
    double value(double low, double high) {
        if (chance(0.3)) return 0.0;
        if (chance(0.02)) return std::numeric_limits<double>::quiet_NaN();
        if (chance(0.02)) return -high;
        return between(low, high * 1.02);
    }

private:
    std::uint64_t state_;
};

/// A program that calls everything at random, on an axis that is hurt at random.
class Chaos {
public:
    explicit Chaos(std::uint64_t seed, const axis::AxisParams& params)
        : rig{params}, random_{seed} {
        rig.power.Enable = rig.status.Enable = true;
    }

    void run(int cycles) {
        for (int i = 0; i < cycles && !testing::Test::HasFailure(); ++i) {
            stir();
            hurt();
            rig.call(moves_[0], moves_[1], relative_, additive_, continuous_, velocity_, halt_,
                     stop_, home_, reset_);
            checkState();
        }
    }
    double hash() const { return hash_; }

    BlockRig rig;
    int statesSeen{0};  ///< one bit for each

private:
    template <typename Block>
    void toggle(Block& block, double chance) {
        if (random_.chance(block.Execute ? 0.05 : chance)) block.Execute = !block.Execute;
    }
    template <typename Block>
    void dynamics(Block& b) {
        b.Velocity = random_.value(1.0, 500.0);
        b.Acceleration = random_.value(50.0, 5000.0);
        b.Deceleration = random_.value(50.0, 4000.0);
        b.Jerk = random_.value(500.0, 100000.0);
        b.BufferMode = random_.chance(0.6) ? static_cast<MC_BUFFER_MODE>(1 + random_.next() % 5)
                                           : MC_BUFFER_MODE::mcAborting;
    }
    void stir() {
        for (auto& move : moves_) {
            dynamics(move);
            move.Position = random_.between(-110.0, 210.0);
            move.Direction = static_cast<MC_DIRECTION>(1 + random_.next() % 4);
            toggle(move, 0.02);
        }
        dynamics(relative_);
        relative_.Distance = random_.between(-50.0, 50.0);
        toggle(relative_, 0.01);
        dynamics(additive_);
        additive_.Distance = random_.between(-50.0, 50.0);
        toggle(additive_, 0.01);
        dynamics(continuous_);
        continuous_.Distance = random_.between(-50.0, 50.0);
        continuous_.EndVelocity = random_.between(-300.0, 300.0);
        toggle(continuous_, 0.01);
        dynamics(velocity_);
        velocity_.Direction = static_cast<MC_DIRECTION>(1 + random_.next() % 4);
        toggle(velocity_, 0.01);
        halt_.Deceleration = random_.value(50.0, 4000.0);
        halt_.Jerk = random_.value(500.0, 100000.0);
        toggle(halt_, 0.004);
        stop_.Deceleration = random_.value(50.0, 8000.0);
        stop_.Jerk = random_.value(500.0, 400000.0);
        toggle(stop_, 0.003);
        toggle(home_, 0.003);
        toggle(reset_, 0.02);
        if (random_.chance(rig.power.Enable ? 0.001 : 0.05)) rig.power.Enable = !rig.power.Enable;
    }
    void hurt() {
        SimDrive& d = rig.drive;
        if (random_.chance(0.0003)) d.faultCode = 0x8611;
        if (random_.chance(d.enableInput ? 0.0003 : 0.1)) d.enableInput = !d.enableInput;
        if (random_.chance(d.frameLost ? 0.6 : 0.002)) d.frameLost = !d.frameLost;
        if (random_.chance(d.health.operational ? 0.0002 : 0.1)) {
            d.health.operational = !d.health.operational;
        }
        d.homingTravel = static_cast<std::int64_t>(random_.between(-2000.0, 2000.0));
        d.homingFails = random_.chance(0.1);
    }
    void checkState() {
        statesSeen |= 1 << static_cast<int>(rig.x.state());
        const auto s = rig.x.status();
        hash_ =
            hash_ * 0.999 + s.set.count() + s.setVelocity.count() + static_cast<double>(s.state);
        // Bookkeeping: rest states have no motion, a command in control has a motion state.
        if (s.state == AxisState::Standstill) {
            EXPECT_EQ(s.setVelocity.count(), 0.0) << rig.k;
            EXPECT_EQ(rig.x.view().active, axis::CommandId::None) << rig.k;
            EXPECT_EQ(rig.x.view().queued, 0) << rig.k;
        }
        EXPECT_EQ(s.state == AxisState::ErrorStop, s.error != ErrorId::None) << rig.k;
        EXPECT_NE(s.error, ErrorId::SetpointJump) << axis::explain(rig.x.error());
        EXPECT_NE(s.error, ErrorId::ProfileNotFeasible) << axis::explain(rig.x.error());
        EXPECT_NE(s.error, ErrorId::SWLimitReached) << axis::explain(rig.x.error());
    }

    Random random_;
    double hash_{0.0};
    std::array<MC_MoveAbsolute, 2> moves_;
    MC_MoveRelative relative_;
    MC_MoveAdditive additive_;
    MC_MoveContinuousRelative continuous_;
    MC_MoveVelocity velocity_;
    MC_Halt halt_;
    MC_Stop stop_;
    MC_Home home_;
    MC_Reset reset_;
};

axis::AxisParams stressed() {
    auto p = testParams();
    p.limits.softNegative = core::Position{-100.0};
    p.limits.softPositive = core::Position{200.0};
    p.supervision.followingError = core::Distance{4.0};
    p.supervision.enableTimeout = std::chrono::milliseconds{200};
    return p;
}

axis::AxisParams stressedRotary() {
    auto p = stressed();
    p.limits.softNegative.reset();
    p.limits.softPositive.reset();
    p.scaling.modulo = core::Distance{97.0};
    return p;
}

}  // namespace

class Stress : public testing::TestWithParam<int> {};

TEST_P(Stress, LinearAxisKeepsEveryRule) {
    Chaos chaos{static_cast<std::uint64_t>(GetParam()), stressed()};
    chaos.run(20000);
    EXPECT_EQ(chaos.statesSeen, 0b11011111) << "every state but SynchronizedMotion";
}

TEST_P(Stress, RotaryAxisKeepsEveryRule) {
    Chaos chaos{static_cast<std::uint64_t>(GetParam()) + 1000, stressedRotary()};
    chaos.run(20000);
    EXPECT_EQ(chaos.statesSeen, 0b11011111) << "every state but SynchronizedMotion";
}

INSTANTIATE_TEST_SUITE_P(Seeds, Stress, testing::Range(1, 9));

TEST(StressRun, TwoRunsAreTheSameBitForBit) {
    Chaos a{77, stressed()};
    Chaos b{77, stressed()};
    a.run(5000);
    b.run(5000);
    EXPECT_EQ(a.hash(), b.hash());
}
