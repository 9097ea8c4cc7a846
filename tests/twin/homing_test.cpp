#include "homing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>

#include "devices.hpp"
#include "homing_cases.hpp"
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

struct Scene {
    std::string profile;
    std::int8_t method{0};
    double start{0.0};
    std::int32_t offset{0};
    SwitchParams home{SwitchFrom, SwitchTo};
    bool limits{true};
    bool hardStops{false};
};

/// Motion between two reversals, each fast or slow: "F+ S-".
class Legs {
public:
    void watch(double velocity) {
        constexpr double Still = 0.02;
        if (std::abs(velocity) < Still) return;
        const int sign = velocity > 0.0 ? 1 : -1;
        if (legs_.empty() || legs_.back().sign != sign) legs_.push_back({sign, false});
        if (std::abs(velocity) > 1.0) legs_.back().fast = true;
    }
    [[nodiscard]] std::string text() const {
        std::string result;
        for (const Leg& leg : legs_) {
            if (!result.empty()) result += ' ';
            result += leg.fast ? 'F' : 'S';
            result += leg.sign > 0 ? '+' : '-';
        }
        return result;
    }

private:
    struct Leg {
        int sign;
        bool fast;
    };
    std::vector<Leg> legs_;
};

class HomingRig {
public:
    explicit HomingRig(const Scene& run) : ra_{run.profile == "ra"} {
        params_ = lineOf(1, run.profile);
        MechanicsParams& mechanics = params_.devices[0].mechanics;
        mechanics.startTurns = run.start;
        mechanics.indexTurns = Index;
        mechanics.homeSwitch = run.home;
        if (run.limits) {
            mechanics.negativeLimit = SwitchParams{-100.0, NegativeEnd};
            mechanics.positiveLimit = SwitchParams{PositiveEnd, 100.0};
        }
        if (run.hardStops) {
            mechanics.hardStopNegative = NegativeEnd;
            mechanics.hardStopPositive = PositiveEnd;
        }
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
            if ((master.statusWord(0) & 0x1000) == 0) legs_.watch(twin_->probe(0).motorVelocity);
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
    /// The legs of the search, until home was found.
    [[nodiscard]] std::string legs() const { return legs_.text(); }
    TestMaster& master() { return *master_; }
    Twin& twin() { return *twin_; }

private:
    bool ra_;
    TwinParams params_;
    std::unique_ptr<Twin> twin_;
    std::unique_ptr<TestMaster> master_;
    bool enabled_{false};
    Legs legs_;
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

double placeOf(Start start) {
    switch (start) {
        case Start::NegativeLimit:
            return NegativeEnd - 0.45;
        case Start::Below:
            return 0.05;
        case Start::OnSwitch:
            return 2.5;
        case Start::Above:
            return 5.05;
        case Start::PositiveLimit:
            return PositiveEnd + 0.45;
    }
    return 0.0;
}

constexpr Start AllStarts[] = {Start::NegativeLimit, Start::Below, Start::OnSwitch, Start::Above,
                               Start::PositiveLimit};

/// Reference edge, direction of the last motion, index: the manuals' tables of results.
struct Expectation {
    double edge;
    int direction;
    bool index;
};

std::optional<Expectation> resultOf(int method, Start start) {
    struct Row {
        double edge;
        int direction;
        std::vector<int> index;
        std::vector<int> edgeOnly;
    };
    const std::vector<Row> rows{
        {NegativeEnd, 1, {1}, {17}},
        {PositiveEnd, -1, {2}, {18}},
        {SwitchFrom, -1, {3, 7, 14}, {19, 23, 30}},
        {SwitchFrom, 1, {4, 8, 13}, {20, 24, 29}},
        {SwitchTo, 1, {5, 10, 11}, {21, 26, 27}},
        {SwitchTo, -1, {6, 9, 12}, {22, 25, 28}},
        {placeOf(start), -1, {33}, {}},
        {placeOf(start), 1, {34}, {}},
    };
    const auto has = [&](const std::vector<int>& list) {
        return std::find(list.begin(), list.end(), method) != list.end();
    };
    for (const Row& row : rows) {
        if (has(row.index))
            return Expectation{indexBeyond(row.edge, row.direction), row.direction, true};
        if (has(row.edgeOnly)) return Expectation{row.edge, row.direction, false};
    }
    return std::nullopt;
}

bool anyOf(int method, std::initializer_list<int> list) {
    return std::find(list.begin(), list.end(), method) != list.end();
}

/// Whether the manual describes the run. It does not: meeting a limit switch in 3 to 6, 19 to 22,
/// 33 and 34; starting on the limit switch that 7 to 14 and 23 to 30 travel to.
bool described(int method, Start start) {
    const bool above = start == Start::Above || start == Start::PositiveLimit;
    const bool below = start == Start::Below || start == Start::NegativeLimit;
    if (anyOf(method, {3, 4, 19, 20})) return !above;
    if (anyOf(method, {5, 6, 21, 22})) return !below;
    if ((method >= 7 && method <= 10) || (method >= 23 && method <= 26))
        return start != Start::PositiveLimit;
    if ((method >= 11 && method <= 14) || (method >= 27 && method <= 30))
        return start != Start::NegativeLimit;
    if (method == 33) return start != Start::NegativeLimit;
    if (method == 34) return start != Start::PositiveLimit;
    return true;
}

std::string label(int method, Start start) {
    return "method " + std::to_string(method) + " from " + std::to_string(placeOf(start));
}

TEST(TwinHoming, Cd300eTakesTheStandstillAsHomeAndTheNearestIndexWithIndexMethods) {
    for (int method = 1; method <= 34; ++method) {
        for (const Start start : AllStarts) {
            const auto expected = resultOf(method, start);
            if (!expected || !described(method, start)) continue;
            SCOPED_TRACE(label(method, start));
            HomingRig rig{{"cd300e", static_cast<std::int8_t>(method), placeOf(start)}};
            ASSERT_TRUE(rig.enabled());
            const Outcome outcome = rig.home();
            EXPECT_EQ(outcome.statusWord & ModeBits, Finished);
            EXPECT_EQ(outcome.statusWord & 0x8000, 0x8000);
            EXPECT_NEAR(outcome.position, 0, 1);
            // Switch methods come to rest one stopping way beyond the edge; a control step of play.
            const double beyond = expected->index ? 0.0 : expected->direction * StoppingWay;
            EXPECT_NEAR(outcome.turns, expected->edge + beyond, expected->index ? 2e-4 : 1.5e-3);
        }
    }
}

TEST(TwinHoming, RaLatchesTheEdgeAndDoesNotMoveBack) {
    for (int method = 1; method <= 34; ++method) {
        if (!anyOf(method, {1, 2, 3, 4, 5, 6, 17, 18, 19, 20, 21, 22, 33, 34})) continue;
        for (const Start start : AllStarts) {
            if (!described(method, start)) continue;
            SCOPED_TRACE(label(method, start));
            const auto expected = resultOf(method, start);
            ASSERT_TRUE(expected);
            HomingRig rig{{"ra", static_cast<std::int8_t>(method), placeOf(start)}};
            ASSERT_TRUE(rig.enabled());
            const Outcome outcome = rig.home();
            EXPECT_EQ(outcome.statusWord & ModeBits, Finished);
            // The zero lies exactly on the edge wherever the motor stands afterwards.
            EXPECT_NEAR(outcome.turns - outcome.position / CountsPerTurn, expected->edge, 2e-4);
            EXPECT_NEAR(outcome.turns, expected->edge, 0.01);
        }
    }
}

TEST(TwinHoming, EndsWithAnErrorWhereTheManualDescribesNoRun) {
    for (const char* profile : {"cd300e", "ra"}) {
        for (int method = 1; method <= 34; ++method) {
            if (!driveTraits(profile).supportsHoming(static_cast<std::int8_t>(method))) continue;
            for (const Start start : AllStarts) {
                if (described(method, start)) continue;
                SCOPED_TRACE(profile + (" " + label(method, start)));
                HomingRig rig{{profile, static_cast<std::int8_t>(method), placeOf(start)}};
                ASSERT_TRUE(rig.enabled());
                rig.home();
                rig.master().cycles(200);  // from 4 turns/s it takes 100 ms to stand
                const Outcome outcome = rig.finish({});
                EXPECT_EQ(outcome.statusWord & ModeBits, 0x2400);
                EXPECT_EQ(outcome.statusWord & 0x8000, 0);
            }
        }
    }
}

/// "S- S+" of the steps "S- S+ S+": one leg for steps in one direction, fast if one of them is.
std::string legsOf(const std::string& steps) {
    std::string legs;
    for (std::size_t at = 0; at < steps.size(); at += 3) {
        const bool same = !legs.empty() && legs.back() == steps[at + 1];
        if (!same) {
            if (!legs.empty()) legs += ' ';
            legs += steps.substr(at, 2);
        }
    }
    return legs;
}

TEST(TwinHoming, Cd300eTravelsTheLegsOfEveryStartCaseOfItsManual) {
    for (const HomingCase& entry : HomingCases) {
        SCOPED_TRACE(label(entry.method, entry.start) + ": " + entry.steps);
        HomingRig rig{{"cd300e", entry.method, placeOf(entry.start)}};
        ASSERT_TRUE(rig.enabled());
        rig.home();
        std::string observed = rig.legs();
        const std::string expected = legsOf(entry.steps);
        // The way to rest over the last edge, and back to the index, is not part of the search.
        EXPECT_EQ(observed.substr(0, expected.size()), expected) << observed;
    }
}

TEST(TwinHoming, Cd300eBacksOffFromAHardStopByTheHomeOffset) {
    for (const int method : {-17, -18}) {
        for (const std::int32_t offset : {2500, -2500}) {  // its size counts, not its sign
            SCOPED_TRACE(std::to_string(method) + " with " + std::to_string(offset));
            Scene run{"cd300e", static_cast<std::int8_t>(method), 0.05, offset};
            run.limits = false;
            run.hardStops = true;
            HomingRig rig{run};
            ASSERT_TRUE(rig.enabled());
            const Outcome outcome = rig.home(20'000);
            EXPECT_EQ(outcome.statusWord & ModeBits, Finished);
            const double home = method == -17 ? NegativeEnd + 0.25 : PositiveEnd - 0.25;
            EXPECT_NEAR(outcome.turns, home, 5e-4);
            EXPECT_NEAR(outcome.position, 0, 3);
        }
    }
}

TEST(TwinHoming, AHardStopIsNotFoundBelowItsCurrentThreshold) {
    Scene run{"cd300e", -17, NegativeEnd + 0.1, 2500};
    run.limits = false;
    run.hardStops = true;
    HomingRig rig{run};
    // 100 A are beyond what the drive can give: the following error ends the run instead.
    ASSERT_EQ(rig.master().download(0, 0x6099, 4, le16(1000)), 0U);
    ASSERT_EQ(rig.master().download(0, 0x6065, 0, le32(5000)), 0U);
    ASSERT_TRUE(rig.enabled());
    rig.home(3000);
    EXPECT_EQ(rig.master().errorCode(0), 0x8611);
}

/// A homing run of the parts alone, so that readings of the manuals can be switched.
struct BareRun {
    HomingSettings settings;
    double home{0.0};
    Homing::State state{Homing::State::Idle};

    explicit BareRun(std::int8_t method, const HomingTraits& traits) {
        settings = {method, 4.0, 0.5, 40.0, 0.0, 3.0, traits.movesToOffset, 1.0, traits};
    }
    void from(double start, double index = Index) {
        MechanicsParams mechanics;
        mechanics.startTurns = start;
        mechanics.indexTurns = index;
        mechanics.homeSwitch = SwitchParams{SwitchFrom, SwitchTo};
        mechanics.negativeLimit = SwitchParams{-100.0, NegativeEnd};
        mechanics.positiveLimit = SwitchParams{PositiveEnd, 100.0};
        constexpr double Step = 250e-6;
        Motor motor{mechanics};
        Servo servo{motor, Step, 3.8};
        servo.reset(motor);
        MotionGenerator generator;
        generator.begin({start, 0.0, 0.0});
        Homing homing;
        homing.start(settings, motor, generator);
        Demand demand = generator.demand();
        for (int i = 0; i < 60'000 && homing.state() != Homing::State::Done; ++i) {
            const double torque = servo.torque(demand, motor, {10.0, 10.0, 0.0});
            motor.step(torque, false, Step);
            homing.step(motor, torque, generator);
            demand = generator.step(Step);
        }
        state = homing.state();
        home = homing.home();
    }
};

TEST(TwinHomingReadings, AnIndexMetWhileSlowingDownCountsUnlessTheDriveWaitsForSlowSpeed) {
    HomingTraits traits = driveTraits("cd300e").homing;
    const double index = 2.1;  // 0.197 turns after the edge at 2.0 the slow speed is reached
    BareRun run{4, traits};
    run.from(0.05, index);
    EXPECT_NEAR(run.home, 2.1, 1e-6);
    traits.indexAtSlowSpeedOnly = true;
    BareRun waiting{4, traits};
    waiting.from(0.05, index);
    EXPECT_NEAR(waiting.home, 3.1, 1e-6);
}

TEST(TwinHomingReadings, TheFirstEdgeIsHomeForADriveThatDoesNotBackOff) {
    HomingTraits traits = driveTraits("ra").homing;
    traits.backsOff = false;
    for (const auto& [method, start, edge] :
         {std::tuple{20, 0.05, SwitchFrom}, std::tuple{22, 5.05, SwitchTo}}) {
        BareRun run{static_cast<std::int8_t>(method), traits};
        run.from(start);
        EXPECT_EQ(run.state, Homing::State::Done);
        EXPECT_NEAR(run.home, edge, 1e-6);
    }
}

TEST(TwinHomingReadings, ThePrintedStartDirectionsOfRaReachTheSwitchFromTheOtherSide) {
    HomingTraits traits = driveTraits("ra").homing;
    traits.startsAsPrinted = true;
    for (const auto& [method, start, edge] :
         {std::tuple{4, 5.05, indexBeyond(SwitchFrom, 1)}, std::tuple{20, 5.05, SwitchFrom},
          std::tuple{6, 0.05, indexBeyond(SwitchTo, -1)}, std::tuple{22, 0.05, SwitchTo}}) {
        SCOPED_TRACE(method);
        BareRun run{static_cast<std::int8_t>(method), traits};
        run.from(start);
        EXPECT_EQ(run.state, Homing::State::Done);
        EXPECT_NEAR(run.home, edge, 1e-6);
    }
}

TEST(TwinHomingReadings, TheRestPointIsHomeInOffsetModeOneWhenTheDriveReadsItSo) {
    HomingTraits traits = driveTraits("cd300e").homing;
    traits.movesToOffset = false;
    BareRun latched{34, traits};
    latched.from(0.05);
    EXPECT_NEAR(latched.home, Index, 1e-6);
    traits.offsetAtRestPoint = true;
    BareRun resting{34, traits};
    resting.from(0.05);
    EXPECT_NEAR(resting.home, Index + StoppingWay, 1e-3);
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

TEST(TwinHoming, KnowsTheMethodsOfEachDriveAndNoOthers) {
    for (int method = -128; method < 128; ++method) {
        const auto value = static_cast<std::int8_t>(method);
        const bool common = (method >= 1 && method <= 6) || (method >= 17 && method <= 22) ||
                            (method >= 33 && method <= 35);
        const bool reversing = (method >= 7 && method <= 14) || (method >= 23 && method <= 30);
        EXPECT_EQ(homingSupported(HomingMethods::WithoutReversal, value), common) << method;
        EXPECT_EQ(homingSupported(HomingMethods::Cia402, value),
                  common || reversing || method == 37)
            << method;
        EXPECT_EQ(homingSupported(HomingMethods::WithHardStops, value),
                  common || reversing || method == -17 || method == -18)
            << method;
    }
}

}  // namespace
}  // namespace takt::twin::test
