#include <gtest/gtest.h>

#include <cmath>

#include "bare_drive.hpp"
#include "drive_alarms.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

using core::cia402::DriveState;

constexpr std::int8_t Csp = 8;
constexpr std::int8_t Csv = 9;
constexpr std::int8_t Cst = 10;
constexpr std::int8_t Homing = 6;

/// Moves at 1 turn/s for `cycles` ms.
void creep(BareDrive& drive, int cycles, int counts = 10) {
    for (int i = 0; i < cycles; ++i) {
        drive.set(0x607A, static_cast<std::int32_t>(drive.get(0x607A)) + counts);
        drive.run(1);
    }
}

TEST(TwinTouchProbe, CatchesTheIndexWhereItIs) {
    MechanicsParams mechanics;
    mechanics.indexTurns = 0.3137;
    for (const char* profile : {"cd300e", "ra"}) {
        BareDrive drive{profile, mechanics};
        drive.enable(Csp);
        drive.set(0x60B8, 0x0015);  // first probe, index, rising edge, single
        creep(drive, 100);
        EXPECT_EQ(drive.get(0x60B9), 0x0001) << profile;
        creep(drive, 300);
        EXPECT_EQ(drive.get(0x60B9), 0x0003) << profile;
        EXPECT_NEAR(static_cast<double>(drive.get(0x60BA)), 3137.0, 1.0) << profile;
        creep(drive, 1000);  // a second index is not caught
        EXPECT_NEAR(static_cast<double>(drive.get(0x60BA)), 3137.0, 1.0) << profile;
    }
}

TEST(TwinTouchProbe, CountsContinuousEventsAsEachDriveShowsThem) {
    MechanicsParams mechanics;
    mechanics.indexTurns = 0.5;
    BareDrive cd300e{"cd300e", mechanics};
    cd300e.enable(Csp);
    cd300e.set(0x60B8, 0x1700);  // second probe, index, rising, continuous
    creep(cd300e, 3000);
    EXPECT_EQ(cd300e.get(0x60B9), 0x0300);
    EXPECT_EQ(cd300e.get(0x60D7), 3);
    EXPECT_NEAR(static_cast<double>(cd300e.get(0x60BC)), 25'000.0, 1.0);
    BareDrive ra{"ra", mechanics};
    ra.enable(Csp);
    ra.set(0x60B8, 0x0017);
    creep(ra, 3000);
    EXPECT_EQ(ra.get(0x60B9), 0x00C3);  // three, modulo 4, in bits 6 and 7
    creep(ra, 1000);
    EXPECT_EQ(ra.get(0x60B9), 0x0003);
}

TEST(TwinTouchProbe, TakesTheInputThatItsFunctionIsAssignedTo) {
    MechanicsParams mechanics;
    mechanics.homeSwitch = SwitchParams{0.25, 0.75};
    BareDrive drive{"cd300e", mechanics};
    drive.set(0x2402, 28, 5);  // DI5, the home switch, is the first probe
    drive.enable(Csp);
    drive.set(0x60B8, 0x0031);  // both edges
    creep(drive, 1000);
    EXPECT_EQ(drive.get(0x60B9), 0x0007);
    EXPECT_NEAR(static_cast<double>(drive.get(0x60BA)), 2500.0, 1.0);
    EXPECT_NEAR(static_cast<double>(drive.get(0x60BB)), 7500.0, 1.0);
    drive.set(0x60B8, 0x0000);
    drive.run(1);
    drive.set(0x60B8, 0x0011);
    drive.run(1);
    EXPECT_EQ(drive.get(0x60B9), 0x0001);  // armed again
}

TEST(TwinInputs, OfRaComeFromTheBusWhenTheirFunctionIsAssigned) {
    BareDrive drive{"ra"};
    drive.set(0x2501, 0x0015);  // DI2 is the home switch
    drive.set(0x2502, 0x2002);  // DI3 forward inhibit, always inactive
    drive.set(0x2503, 0x0103);  // DI4 reverse inhibit, inverted
    drive.set(0x60FE, 0x0002'0000, 1);
    drive.set(0x60FE, 0x0006'0000, 2);
    drive.run(1);
    EXPECT_EQ(drive.get(0x60FD), 0x0002'0004);
    drive.set(0x60FE, 0x0006'0000, 1);  // DI3 stays inactive by its source digit
    drive.run(1);
    EXPECT_EQ(drive.get(0x60FD), 0x0006'0004);
    drive.set(0x60FE, 0x0008'0000, 2);  // DI4 fed with 0: inverted, active
    drive.run(1);
    EXPECT_EQ(drive.get(0x60FD), 0x0000'0001);
    drive.set(0x60FE, 0, 2);
    drive.run(1);
    EXPECT_EQ(drive.get(0x60FD), 0);
}

TEST(TwinInputs, OfRaHomeOnAVirtualSwitch) {
    BareDrive drive{"ra"};
    drive.set(0x2501, 0x0015);
    drive.set(0x60FE, 0x0002'0000, 2);
    drive.set(0x6098, 21);
    drive.set(0x6099, 600, 1);
    drive.set(0x6099, 300, 2);
    drive.set(0x609A, 24'000);
    drive.enable(Homing);
    drive.give(0x001F, 1);
    double home = 0.0;
    for (int i = 0; i < 4000 && !drive.bit(12); ++i) {
        drive.set(0x60FE, drive.turns() < -1.0 ? 0x0002'0000 : 0, 1);
        const double before = drive.turns();
        drive.run(1);
        if (before < -1.0 && drive.turns() >= -1.0) home = drive.turns();
    }
    EXPECT_TRUE(drive.bit(12));
    EXPECT_NEAR(drive.turns() - static_cast<double>(drive.get(0x6064)) / 10'000.0, home, 2e-3);
}

TEST(TwinInputs, OfRaRaiseAlarm190WhenTheyEnableToo) {
    BareDrive drive{"ra"};
    drive.set(0x2500, 0x0000);  // DI1 as delivered: servo on
    drive.set(0x60FE, 0x0001'0000, 2);
    drive.enable(Csp);
    EXPECT_EQ(drive.state(), DriveState::OperationEnabled);
    drive.set(0x60FE, 0x0001'0000, 1);
    drive.run(3);
    EXPECT_EQ(drive.state(), DriveState::Fault);
    EXPECT_EQ(drive.get(0x3EE1), 0x190);
}

TEST(TwinAlarms, OfEveryNumberStopTheDriveOrWarn) {
    for (const char* profile : {"cd300e", "ra"}) {
        ASSERT_FALSE(alarmsOf(profile).empty());
        for (const DriveAlarm& alarm : alarmsOf(profile)) {
            SCOPED_TRACE(profile + (" " + std::to_string(alarm.number)));
            BareDrive drive{profile};
            drive.enable(Csp);
            ASSERT_TRUE(drive.drive().raiseAlarm(alarm.number));
            drive.run(3);
            const bool warning = alarm.kind == AlarmKind::Warning;
            EXPECT_EQ(drive.state(), warning ? DriveState::OperationEnabled : DriveState::Fault);
            EXPECT_EQ(drive.bit(7), warning);
            EXPECT_EQ(drive.get(0x603F) & 0xFFFF, alarm.errorCode);
            drive.give(0x0000, 1);
            drive.give(0x0080, 2);
            const bool cleared = warning || alarm.resettable;
            EXPECT_EQ(drive.state() == DriveState::SwitchOnDisabled, cleared);
            EXPECT_FALSE(drive.bit(7));
        }
    }
}

TEST(TwinAlarms, OfCd300eShowTheirNumberInTheErrorCode) {
    for (const DriveAlarm& alarm : alarmsOf("cd300e")) {
        const bool warning = alarm.kind == AlarmKind::Warning;
        EXPECT_EQ(alarm.errorCode, warning ? 0 : alarm.number);
    }
    EXPECT_EQ(alarmsOf("cd300e").size(), 37U);
    EXPECT_EQ(findAlarm("cd300e", 0xFF07), nullptr);  // missing in the manual too
}

TEST(TwinAlarms, ThatCannotBeResetEndWithARestartOnly) {
    BareDrive drive{"cd300e"};
    drive.run(60);
    drive.drive().raiseAlarm(0xFF05);
    drive.give(0x0000, 2);
    drive.give(0x0080, 2);
    EXPECT_EQ(drive.state(), DriveState::Fault);
    drive.drive().restart();
    drive.give(0x0000, 60);
    EXPECT_EQ(drive.state(), DriveState::SwitchOnDisabled);
    EXPECT_EQ(drive.get(0x603F) & 0xFFFF, 0);
}

TEST(TwinAlarms, OverloadComesFromTorqueThatLasts) {
    MechanicsParams stuck;
    stuck.hardStopPositive = 0.0;
    BareDrive drive{"cd300e", stuck};
    drive.enable(Cst);
    drive.set(0x6071, 950);  // below the rated torque: for ever
    drive.run(100'000);
    EXPECT_EQ(drive.state(), DriveState::OperationEnabled);
    EXPECT_FALSE(drive.bit(7));
    drive.set(0x6071, 2000);
    int cycles = 0;
    bool warned = false;
    while (drive.state() == DriveState::OperationEnabled && cycles < 60'000) {
        drive.run(1);
        ++cycles;
        warned = warned || drive.bit(7);
    }
    // First 100 s towards 0.9025, then towards 4 until 1; with 30 s both.
    const double start = 0.9025 * (1.0 - std::exp(-100.0 / 30.0));
    EXPECT_NEAR(cycles, 30'000 * std::log((4.0 - start) / 3.0), 15.0);
    EXPECT_TRUE(warned);
    EXPECT_EQ(drive.get(0x603F) & 0xFFFF, 0xFF01);
}

TEST(TwinAlarms, ReachTheMasterThroughTheWholeDevice) {
    TwinParams params = lineOf(1, "cd300e");
    Twin twin{params, descriptionsFor(params), std::chrono::milliseconds{1}};
    TestMaster master{twin};
    master.toPreOp();
    master.toOp();
    master.cycles(60);
    ASSERT_TRUE(master.enable(0, Csp));
    EXPECT_FALSE(twin.raiseAlarm(0, 0x1234));
    EXPECT_TRUE(twin.raiseAlarm(0, 0x3210));
    master.cycles(4);
    EXPECT_EQ(core::cia402::stateOf(master.statusWord(0)), DriveState::Fault);
    EXPECT_EQ(master.errorCode(0), 0x3210);
}

TEST(TwinGear, OutsideItsRangeRaisesFF09WhenEnabling) {
    BareDrive drive{"cd300e"};
    drive.set(0x6092, 1000, 1);  // 8388.6 increments a count
    drive.drive().takeGear();
    drive.set(0x6060, Csv);
    drive.run(60);
    drive.give(0x0006, 2);
    drive.give(0x0007, 2);
    EXPECT_EQ(drive.state(), DriveState::SwitchedOn);
    drive.give(0x000F, 3);
    EXPECT_EQ(drive.state(), DriveState::Fault);
    EXPECT_EQ(drive.get(0x603F) & 0xFFFF, 0xFF09);
}

}  // namespace
}  // namespace takt::twin::test
