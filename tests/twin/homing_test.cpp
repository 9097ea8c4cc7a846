#include <gtest/gtest.h>

#include <cmath>

#include "devices.hpp"
#include "homing_sequence.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

using std::chrono::milliseconds;

constexpr double SwitchFrom = 2.0;
constexpr double SwitchTo = 3.0;
constexpr double NegativeEnd = -4.0;  ///< negative limit active below
constexpr double PositiveEnd = 8.0;   ///< positive limit active above
constexpr double Index = 0.3;

struct Outcome {
    std::uint16_t statusWord{0};
    double turns{0.0};
    std::int32_t position{0};
    int cycles{0};
};

struct Run {
    std::string profile;
    std::int8_t method{0};
    double start{0.0};
    std::int32_t offset{0};
    SwitchParams home{SwitchFrom, SwitchTo};
};

class HomingRig {
public:
    explicit HomingRig(const Run& run) : ra_{run.profile == "ra"} {
        params_ = lineOf(1, run.profile);
        MechanicsParams& mechanics = params_.devices[0].mechanics;
        mechanics.startTurns = run.start;
        mechanics.indexTurns = Index;
        mechanics.homeSwitch = run.home;
        mechanics.negativeLimit = SwitchParams{-100.0, NegativeEnd};
        mechanics.positiveLimit = SwitchParams{PositiveEnd, 100.0};
        twin_ = std::make_unique<Twin>(params_, descriptionsFor(params_), milliseconds{1});
        master_ = std::make_unique<TestMaster>(*twin_);
        TestMaster& master = *master_;
        master.toPreOp();
        master.download(0, 0x6098, 0, {static_cast<std::uint8_t>(run.method)});
        // 4 and 0.5 turns/s, 40 turns/s² in each drive's own units.
        master.download(0, 0x6099, 1, le32(ra_ ? 2400 : 40000));
        master.download(0, 0x6099, 2, le32(ra_ ? 300 : 5000));
        master.download(0, 0x609A, 0, le32(ra_ ? 24000 : 400000));
        master.download(0, 0x607C, 0, le32(static_cast<std::uint32_t>(run.offset)));
        master.toOp();
        master.cycles(60);
        enabled_ = master.enable(0, 6);
    }
    Outcome home(int limit = 12000) {
        TestMaster& master = *master_;
        master.command(0, 0x001F, 6, master.position(0));
        Outcome outcome;
        master.cycles(5);
        while (outcome.cycles < limit && (master.statusWord(0) & 0x2400) == 0) {
            master.cycle();
            ++outcome.cycles;
        }
        master.cycles(30);
        return finish(outcome);
    }
    Outcome finish(Outcome outcome) {
        outcome.statusWord = master_->statusWord(0);
        outcome.turns = twin_->probe(0).motorTurns;
        outcome.position = master_->position(0);
        return outcome;
    }
    [[nodiscard]] bool enabled() const { return enabled_; }
    TestMaster& master() { return *master_; }
    Twin& twin() { return *twin_; }

private:
    bool ra_;
    TwinParams params_;
    std::unique_ptr<Twin> twin_;
    std::unique_ptr<TestMaster> master_;
    bool enabled_{false};
};

constexpr std::uint16_t ModeBits = 0x3400;
constexpr std::uint16_t Finished = 0x1400;
constexpr double CountsPerTurn = 10000.0;
/// From 0.5 turns/s at 40 turns/s².
constexpr double StoppingWay = 0.5 * 0.5 / (2.0 * 40.0);

/// First index at or beyond `from` in a direction.
double indexBeyond(double from, int direction) {
    return direction > 0 ? std::ceil(from - Index) + Index : std::floor(from - Index) + Index;
}

struct Expectation {
    std::int8_t method;
    double edge;    ///< where the last event happens
    int direction;  ///< of the last motion
    bool index;
};

std::vector<Expectation> expectations(double start) {
    return {
        {1, indexBeyond(NegativeEnd, 1), 1, true},
        {2, indexBeyond(PositiveEnd, -1), -1, true},
        {3, indexBeyond(SwitchFrom, -1), -1, true},
        {4, indexBeyond(SwitchFrom, 1), 1, true},
        {5, indexBeyond(SwitchTo, 1), 1, true},
        {6, indexBeyond(SwitchTo, -1), -1, true},
        {17, NegativeEnd, 1, false},
        {18, PositiveEnd, -1, false},
        {19, SwitchFrom, -1, false},
        {20, SwitchFrom, 1, false},
        {21, SwitchTo, 1, false},
        {22, SwitchTo, -1, false},
        {33, indexBeyond(start, -1), -1, true},
        {34, indexBeyond(start, 1), 1, true},
    };
}

/// Whether a method reaches its switch from where the axis stands (CiA 402 methods do not turn
/// round).
bool reaches(std::int8_t method, double start) {
    if (start < SwitchFrom) return method != 5 && method != 6 && method != 21 && method != 22;
    if (start > SwitchTo) return method != 3 && method != 4 && method != 19 && method != 20;
    return true;
}

TEST(TwinHoming, Cd300eTakesTheStandstillAsHomeAndTheNearestIndexWithIndexMethods) {
    for (const double start : {0.05, 2.5, 5.05}) {
        for (const Expectation& expected : expectations(start)) {
            if (!reaches(expected.method, start)) continue;
            HomingRig rig{{"cd300e", expected.method, start}};
            ASSERT_TRUE(rig.enabled());
            const Outcome outcome = rig.home();
            EXPECT_EQ(outcome.statusWord & ModeBits, Finished)
                << int{expected.method} << " from " << start;
            EXPECT_EQ(outcome.statusWord & 0x8000, 0x8000);
            EXPECT_NEAR(outcome.position, 0, 1) << int{expected.method};
            // Switch methods come to rest one stopping way beyond the edge; a control step of play.
            const double home =
                expected.index ? expected.edge : expected.edge + expected.direction * StoppingWay;
            EXPECT_NEAR(outcome.turns, home, expected.index ? 2e-4 : 1.5e-3)
                << int{expected.method} << " from " << start;
        }
    }
}

TEST(TwinHoming, RaLatchesTheEdgeAndDoesNotMoveBack) {
    for (const double start : {0.05, 2.5, 5.05}) {
        for (const Expectation& expected : expectations(start)) {
            if (!reaches(expected.method, start)) continue;
            HomingRig rig{{"ra", expected.method, start}};
            ASSERT_TRUE(rig.enabled());
            const Outcome outcome = rig.home();
            EXPECT_EQ(outcome.statusWord & ModeBits, Finished)
                << int{expected.method} << " from " << start;
            // The zero lies exactly on the edge wherever the motor stands afterwards.
            EXPECT_NEAR(outcome.turns - outcome.position / CountsPerTurn, expected.edge, 2e-4)
                << int{expected.method} << " from " << start;
            EXPECT_NEAR(outcome.turns, expected.edge, 0.01) << int{expected.method};
        }
    }
}

TEST(TwinHoming, Method35TakesThePresentPositionWithoutMotion) {
    for (const char* profile : {"cd300e", "ra", "generic"}) {
        HomingRig rig{{profile, 35, 5.05}};
        const Outcome outcome = rig.home(100);
        EXPECT_EQ(outcome.statusWord & ModeBits, Finished) << profile;
        EXPECT_NEAR(outcome.turns, 5.05, 1e-4) << profile;
        EXPECT_EQ(outcome.position, 0) << profile;
    }
}

TEST(TwinHoming, Cd300eMovesByTheHomeOffsetAndIsZeroThere) {
    HomingRig rig{{"cd300e", 34, 0.05, 2500}};
    const Outcome outcome = rig.home();
    EXPECT_EQ(outcome.statusWord & ModeBits, Finished);
    EXPECT_NEAR(outcome.turns, Index + 0.25, 2e-4);
    EXPECT_NEAR(outcome.position, 0, 1);
}

TEST(TwinHoming, RaReadsMinusTheHomeOffsetAtHome) {
    HomingRig rig{{"ra", 34, 0.05, 2500}};
    const Outcome outcome = rig.home();
    EXPECT_NEAR(outcome.turns, Index, 0.01);
    EXPECT_NEAR(outcome.position, -2500 + (outcome.turns - Index) * CountsPerTurn, 2.0);
}

TEST(TwinHoming, StopsWithoutResultWhenTheStartBitFalls) {
    HomingRig rig{{"cd300e", 19, -2.0}};
    rig.home(200);
    rig.master().command(0, 0x000F, 6, 0);
    rig.master().cycles(300);
    const Outcome outcome = rig.finish({});
    EXPECT_EQ(outcome.statusWord & ModeBits, 0x0400);
    EXPECT_EQ(outcome.statusWord & 0x8000, 0);
    const double stands = outcome.turns;
    rig.master().cycles(100);
    EXPECT_NEAR(rig.twin().probe(0).motorTurns, stands, 1e-4);
    EXPECT_EQ(rig.home().statusWord & ModeBits, Finished);
}

TEST(TwinHoming, FailsAtALimitSwitchThatTheMethodDoesNotUse) {
    HomingRig rig{{"ra", 19, 5.05}};  // beyond the switch: runs into the positive limit
    rig.home();
    rig.master().cycles(200);  // from 4 turns/s it takes 100 ms to stand
    const Outcome outcome = rig.finish({});
    EXPECT_EQ(outcome.statusWord & ModeBits, 0x2400);
    EXPECT_NEAR(outcome.turns, PositiveEnd, 0.5);
}

TEST(TwinHoming, FailsWithoutAMethod) {
    HomingRig rig{{"cd300e", 0, 0.0}};
    EXPECT_EQ(rig.home(50).statusWord & ModeBits, 0x2400);
}

TEST(TwinHoming, FollowsTargetsInTheNewCoordinatesAfterwards) {
    HomingRig rig{{"cd300e", 21, 5.05}};
    const Outcome outcome = rig.home();
    TestMaster& master = rig.master();
    std::int32_t target = master.position(0);
    for (int i = 0; i < 100; ++i) {
        master.command(0, 0x000F, 8, target);
        master.cycle();
        target += 100;
    }
    master.cycles(60);
    EXPECT_NEAR(rig.twin().probe(0).motorTurns, outcome.turns + 0.99, 1e-3);
    EXPECT_EQ(master.statusWord(0) & 0x8000, 0x8000);
}

TEST(TwinHoming, KnowsTheMethodsOfBothTables) {
    for (int method = -128; method < 128; ++method) {
        const bool known = (method >= 1 && method <= 6) || (method >= 17 && method <= 22) ||
                           (method >= 33 && method <= 35);
        EXPECT_EQ(homingSupported(HomingTable::Cia402, static_cast<std::int8_t>(method)), known)
            << method;
    }
}

}  // namespace
}  // namespace takt::twin::test
