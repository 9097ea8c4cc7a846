#include <gtest/gtest.h>

#include <cmath>

#include "devices.hpp"
#include "position_scale.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

using core::cia402::DriveState;
using std::chrono::milliseconds;

class Rig {
public:
    explicit Rig(const std::string& profile, MechanicsParams mechanics = {}) {
        params = lineOf(1, profile);
        params.devices[0].mechanics = mechanics;
        twin = std::make_unique<Twin>(params, descriptionsFor(params), milliseconds{1});
        master = std::make_unique<TestMaster>(*twin);
        master->toPreOp();
    }
    void toOp() {
        master->toOp();
        master->cycles(60);
    }
    void give(std::uint16_t controlWord, int cycles = 12) {
        master->command(0, controlWord, mode, target);
        master->cycles(cycles);
    }
    [[nodiscard]] DriveState state() const { return core::cia402::stateOf(master->statusWord(0)); }
    void enable() {
        ASSERT_TRUE(master->enable(0, mode));
        target = master->position(0);
    }
    /// Moves by `step` counts a cycle.
    void run(int step, int cycles) {
        for (int i = 0; i < cycles; ++i) {
            target += step;
            master->command(0, 0x000F, mode, target);
            master->cycle();
        }
    }
    [[nodiscard]] double speed() const { return twin->probe(0).motorVelocity; }

    TwinParams params;
    std::unique_ptr<Twin> twin;
    std::unique_ptr<TestMaster> master;
    std::int8_t mode{8};
    std::int32_t target{0};
};

TEST(TwinDriveStates, WalksUpAndDownAsCia402Says) {
    Rig rig{"generic"};
    rig.toOp();
    EXPECT_EQ(rig.state(), DriveState::SwitchOnDisabled);
    struct Step {
        std::uint16_t controlWord;
        DriveState expected;
    };
    const Step steps[] = {
        {0x0007, DriveState::SwitchOnDisabled},  // not without Shutdown
        {0x000F, DriveState::SwitchOnDisabled},
        {0x0006, DriveState::ReadyToSwitchOn},   // 2
        {0x0000, DriveState::SwitchOnDisabled},  // 7
        {0x0006, DriveState::ReadyToSwitchOn},
        {0x0002, DriveState::SwitchOnDisabled},  // 7 by quick stop
        {0x0006, DriveState::ReadyToSwitchOn},
        {0x0007, DriveState::SwitchedOn},       // 3
        {0x0006, DriveState::ReadyToSwitchOn},  // 6
        {0x0007, DriveState::SwitchedOn},
        {0x0000, DriveState::SwitchOnDisabled},  // 10
        {0x0006, DriveState::ReadyToSwitchOn},
        {0x000F, DriveState::OperationEnabled},  // 3 and 4
        {0x0007, DriveState::SwitchedOn},        // 5
        {0x000F, DriveState::OperationEnabled},  // 4
        {0x0006, DriveState::ReadyToSwitchOn},   // 8
        {0x000F, DriveState::OperationEnabled},
        {0x0000, DriveState::SwitchOnDisabled},  // 9
    };
    for (const Step& step : steps) {
        rig.give(step.controlWord);
        EXPECT_EQ(rig.state(), step.expected) << std::hex << step.controlWord;
    }
}

TEST(TwinDriveStates, BootsBeforeItIsDisabled) {
    Rig rig{"generic"};
    EXPECT_EQ(rig.twin->probe(0).driveState, DriveState::NotReadyToSwitchOn);
    rig.master->sleep(milliseconds{60});
    EXPECT_EQ(rig.twin->probe(0).driveState, DriveState::SwitchOnDisabled);
}

TEST(TwinDriveStates, TakesTimeToEnable) {
    Rig rig{"generic"};
    rig.toOp();
    rig.give(0x0006);
    rig.give(0x0007);
    rig.give(0x000F, 3);
    EXPECT_EQ(rig.state(), DriveState::SwitchedOn);
    rig.give(0x000F, 6);
    EXPECT_EQ(rig.state(), DriveState::OperationEnabled);
}

TEST(TwinDriveStates, ShowsRemoteInOpAndItsModeOfOperation) {
    Rig rig{"cd300e"};
    rig.toOp();
    rig.mode = 7;
    rig.give(0x0006);
    EXPECT_EQ(rig.master->mode(0), 0);  // not simulated: not taken
    rig.mode = 8;
    rig.give(0x0006);
    EXPECT_EQ(rig.master->mode(0), 8);
    EXPECT_EQ(rig.master->statusWord(0) & 0x0210, 0x0210);
}

TEST(TwinDriveStops, Cd300eCoastsOnQuickStopByDefault) {
    MechanicsParams mechanics;
    mechanics.friction = 0.05;
    Rig rig{"cd300e", mechanics};
    rig.toOp();
    rig.enable();
    rig.run(100, 200);  // 10 turns/s
    const double before = rig.speed();
    rig.give(0x0002, 5);
    EXPECT_EQ(rig.state(), DriveState::SwitchOnDisabled);
    // Friction alone: 0.05 Nm on 1e-4 kg·m² are 500 rad/s², 79.6 turns/s².
    const double first = rig.speed();
    rig.give(0x0002, 50);
    EXPECT_NEAR(first - rig.speed(), 0.050 * 500.0 / 6.283185307179586, 0.05);
    EXPECT_LT(first, before);
    rig.give(0x0002, 200);
    EXPECT_EQ(rig.speed(), 0.0);
}

TEST(TwinDriveStops, QuickStopRampsWithTheOptionThatWasWritten) {
    Rig rig{"cd300e"};
    ASSERT_EQ(rig.master->download(0, 0x605A, 0, le16(1)), 0U);
    ASSERT_EQ(rig.master->download(0, 0x6084, 0, le32(500'000)), 0U);  // 50 turns/s²
    rig.toOp();
    rig.enable();
    rig.run(100, 200);  // 10 turns/s
    rig.give(0x0002, 103);
    EXPECT_EQ(rig.state(), DriveState::QuickStopActive);
    EXPECT_NEAR(rig.speed(), 5.0, 0.2);  // half of the 200 ms ramp
    rig.give(0x0002, 130);
    EXPECT_EQ(rig.state(), DriveState::SwitchOnDisabled);
}

TEST(TwinDriveStops, RaStaysInQuickStopUntilEnabledAgain) {
    Rig rig{"ra"};
    ASSERT_EQ(rig.master->download(0, 0x6085, 0, le32(60'000)), 0U);  // 100 turns/s²
    rig.toOp();
    rig.enable();
    rig.run(100, 200);
    rig.give(0x0002, 200);
    EXPECT_EQ(rig.state(), DriveState::QuickStopActive);
    EXPECT_NEAR(rig.speed(), 0.0, 1e-3);
    rig.target = rig.master->position(0);
    rig.give(0x000F);
    EXPECT_EQ(rig.state(), DriveState::OperationEnabled);
    rig.give(0x0002);
    rig.give(0x0000);
    EXPECT_EQ(rig.state(), DriveState::SwitchOnDisabled);
}

TEST(TwinDriveStops, RaHaltsInCspByBitEight) {
    Rig rig{"ra"};
    rig.toOp();
    rig.enable();
    rig.run(100, 200);
    rig.give(0x010F, 200);
    EXPECT_EQ(rig.state(), DriveState::OperationEnabled);
    EXPECT_NEAR(rig.speed(), 0.0, 1e-3);
    EXPECT_EQ(rig.master->statusWord(0) & 0x1000, 0);
}

TEST(TwinDriveMotion, FollowsAccelerationsWithALagOfFewCounts) {
    Rig rig{"generic"};
    rig.toOp();
    rig.enable();
    std::int32_t worst = 0;
    double position = rig.target;
    double velocity = 0.0;
    for (int i = 0; i < 400; ++i) {
        velocity += i < 200 ? 1.0 : -1.0;  // 10,000 counts/s in 10 ms: 100 turns/s²
        position += velocity;
        rig.target = static_cast<std::int32_t>(position);
        rig.give(0x000F, 1);
        worst = std::max(worst, std::abs(rig.master->lag(0)));
    }
    EXPECT_LE(worst, 5);
    rig.give(0x000F, 100);
    EXPECT_EQ(rig.master->position(0), rig.target);
}

TEST(TwinDriveMotion, ReadsBackTheLatchedPositionTwoCyclesAfterTheTargetWasSet) {
    Rig rig{"generic"};
    rig.toOp();
    rig.enable();
    // At steady speed the target of cycle k is reached at the SYNC0 of k+2 and read with k+3.
    rig.run(40, 300);
    const std::int32_t set = rig.target;
    EXPECT_NEAR(set - rig.master->position(0), 2 * 40, 1);
}

TEST(TwinDriveMotion, StandsStillUnderLoadAndHoldsItsPosition) {
    MechanicsParams mechanics;
    mechanics.loadTorque = 0.6;
    Rig rig{"generic", mechanics};
    rig.toOp();
    const double start = rig.twin->probe(0).motorTurns;
    EXPECT_EQ(start, 0.0);  // the brake has held it
    rig.enable();
    rig.give(0x000F, 500);
    EXPECT_NEAR(rig.twin->probe(0).motorTurns, start, 1e-3);
    EXPECT_EQ(rig.master->position(0), rig.target);
    rig.give(0x0000, 200);
    EXPECT_NEAR(rig.twin->probe(0).motorTurns, start, 1e-2);
}

TEST(TwinDriveMotion, ContinuesOverTheEndOfTheThirtyTwoBitPosition) {
    MechanicsParams mechanics;
    mechanics.startTurns = 214748.0;  // 2,147,480,000 counts of 2,147,483,647
    Rig rig{"generic", mechanics};
    rig.toOp();
    rig.enable();
    for (int i = 0; i < 200; ++i) {
        rig.target = static_cast<std::int32_t>(static_cast<std::uint32_t>(rig.target) + 50U);
        rig.give(0x000F, 1);
        ASSERT_LT(std::abs(rig.master->lag(0)), 60);
    }
    rig.give(0x000F, 50);
    EXPECT_EQ(rig.master->position(0), rig.target);
    EXPECT_LT(rig.target, 0);
    EXPECT_GT(rig.twin->probe(0).motorTurns, 214748.9);
}

TEST(TwinDriveFaults, Cd300eFaultsWhenTheFollowingErrorLasts) {
    MechanicsParams mechanics;
    mechanics.hardStopPositive = 1.0;
    Rig rig{"cd300e", mechanics};
    ASSERT_EQ(rig.master->download(0, 0x6065, 0, le32(2000)), 0U);
    rig.toOp();
    rig.enable();
    rig.run(50, 200);  // to the stop
    EXPECT_EQ(rig.state(), DriveState::OperationEnabled);
    rig.run(50, 80);  // 4000 counts into it
    EXPECT_EQ(rig.state(), DriveState::Fault);
    EXPECT_EQ(rig.master->errorCode(0), 0x8611);
    EXPECT_EQ(rig.master->statusWord(0) & 0x2000, 0x2000);
    EXPECT_LE(rig.twin->probe(0).motorTurns, 1.0);
}

TEST(TwinDriveFaults, ResetsOnTheRisingEdgeOnly) {
    MechanicsParams mechanics;
    mechanics.hardStopPositive = 0.1;
    Rig rig{"cd300e", mechanics};
    ASSERT_EQ(rig.master->download(0, 0x6065, 0, le32(500)), 0U);
    rig.toOp();
    rig.enable();
    rig.run(50, 60);
    ASSERT_EQ(rig.state(), DriveState::Fault);
    rig.give(0x0006);
    EXPECT_EQ(rig.state(), DriveState::Fault);
    rig.give(0x0080);
    EXPECT_EQ(rig.state(), DriveState::SwitchOnDisabled);
    EXPECT_EQ(rig.master->errorCode(0), 0);
    rig.give(0x0086);  // while bit 7 is high nothing else counts
    EXPECT_EQ(rig.state(), DriveState::SwitchOnDisabled);
    rig.give(0x0006);
    EXPECT_EQ(rig.state(), DriveState::ReadyToSwitchOn);
}

TEST(TwinDriveFaults, RaSendsAnEmergencyWithItsPanelCode) {
    MechanicsParams mechanics;
    mechanics.hardStopPositive = 0.1;
    Rig rig{"ra", mechanics};
    ASSERT_EQ(rig.master->download(0, 0x6065, 0, le32(500)), 0U);
    rig.toOp();
    rig.enable();
    rig.run(50, 60);
    ASSERT_EQ(rig.state(), DriveState::Fault);
    const Bytes message = rig.master->read(0, 0x1080, 128).data;
    EXPECT_EQ(number(std::span{message}.first(2)), 10U);
    EXPECT_EQ(message[5] & 0x0F, 3);
    EXPECT_EQ(number(std::span{message}.subspan(6, 2)), 0x1000U);
    EXPECT_EQ(number(std::span{message}.subspan(8, 2)), 0x8611U);
    EXPECT_EQ(message[10], 0x80);
    EXPECT_EQ(number(std::span{message}.subspan(11, 2)), 0x0600U);
}

TEST(TwinDriveFaults, ALimitSwitchHoldsTheAxisBackInItsDirectionOnly) {
    MechanicsParams mechanics;
    mechanics.positiveLimit = SwitchParams{0.5, 10.0};
    Rig rig{"generic", mechanics};
    rig.toOp();
    rig.enable();
    rig.run(20, 400);  // 8000 counts, the switch at 5000
    EXPECT_NEAR(rig.twin->probe(0).motorTurns, 0.5, 0.01);
    EXPECT_EQ(rig.master->statusWord(0) & 0x1800, 0x0800);
    for (rig.target = rig.master->position(0); rig.target > 0; rig.target -= 20) {
        rig.master->command(0, 0x000F, 8, rig.target);
        rig.master->cycle();
    }
    EXPECT_NEAR(rig.twin->probe(0).motorTurns, 0.0, 0.01);
}

TEST(TwinPositionScale, CutsTowardsZeroAsTheCd300eManualShows) {
    // Figures of the manual's screens: 23-bit encoder, 10,000 and 131,072 counts a turn.
    const PositionScale fine{10000, true};
    EXPECT_EQ(fine.fromCounts(7438), 6239446);
    EXPECT_EQ(fine.counts(6239446), 7437);
    EXPECT_EQ(fine.counts(6239511), 7438);
    EXPECT_EQ(PositionScale(131072, true).counts(-64620335), -1009692);
}

TEST(TwinPositionScale, RoundsBackToTheSameCountsOtherwise) {
    const PositionScale scale{32768, false};
    const PositionScale odd{10007, false};
    for (std::int64_t counts = -50000; counts <= 50000; counts += 37) {
        EXPECT_EQ(scale.counts(scale.fromCounts(counts)), counts);
        EXPECT_EQ(odd.counts(odd.fromCounts(counts)), counts);
    }
    EXPECT_EQ(scale.counts(scale.fromCounts(2'000'000'000'000)), 2'000'000'000'000);
}

}  // namespace
}  // namespace takt::twin::test
