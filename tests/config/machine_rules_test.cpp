#include <gtest/gtest.h>

#include "machine_base.hpp"
#include "machine_schema.hpp"
#include "xml_encoding.hpp"

namespace takt::config {
namespace {

using test::BaseMachine;

class MachineRule : public test::MachineFile {};

// --- the form of the file

TEST_F(MachineRule, RefusesATypoInAnElement) {
    expectError("<Scaling countsPerTurn=\"10000\"", "<Scalng countsPerTurn=\"10000\"",
                "the element <Scalng> is not known here, did you mean 'Scaling'?", "Scaling");
}
TEST_F(MachineRule, RefusesATypoInAnAttribute) {
    expectError("softPositive=\"800 mm\"", "softPostive=\"800 mm\"", "did you mean 'softPositive'?",
                "softPositive");
}
TEST_F(MachineRule, RefusesATypoInARequiredAttributeOnce) {
    expectError("<Axis name=\"X\" unit=\"mm\">", "<Axis name=\"X\" unti=\"mm\">",
                "did you mean 'unit'?", "unit");
}
TEST_F(MachineRule, RefusesAnUnknownElement) {
    expectError("  <Program name", "  <Gearbox/><Program name", "<Gearbox> is not known here",
                "Network, Axis, Program");
}
TEST_F(MachineRule, RefusesAMissingElement) {
    expectError("    <Limits velocity=\"360 deg/s\" acceleration=\"3600 deg/s^2\"/>\n", "",
                "<Limits> is missing", "", -3);
}
TEST_F(MachineRule, RefusesAMissingAttribute) {
    expectError("velocity=\"360 deg/s\" ", "", "the attribute 'velocity' is missing", "deg/s");
}
TEST_F(MachineRule, RefusesASecondElementOfAKind) {
    expectError("    <Homing method=\"35\"/>", "    <Homing method=\"35\"/><Homing method=\"34\"/>",
                "there is a second <Homing>", "one");
}
TEST_F(MachineRule, RefusesTextInAnElement) {
    expectError("<Homing method=\"35\"/>", "<Homing method=\"35\">home</Homing>", "there is text",
                "attributes");
}
TEST_F(MachineRule, RefusesAnotherRoot) {
    const auto result = loadText("<Maschine/>");
    EXPECT_EQ(result.diagnostics.errorCount(), 1U);
    EXPECT_NE(format(result.diagnostics).find("machine.xml:1: error: <Maschine> is not the root"),
              std::string::npos);
}
TEST_F(MachineRule, RefusesAnEntityThatNobodyDeclared) {
    expectError("lostFrames=\"3\"", "lostFrames=\"3\" interface=\"&evil;\"",
                "Entity 'evil' not defined", "");
}

// --- numbers and units

TEST_F(MachineRule, RefusesAnUnknownUnit) {
    expectError("velocity=\"500 mm/s\"", "velocity=\"500 furlong/s\"",
                "the unit 'furlong/s' is not known here", "mm/s, m/s, mm/min, m/min");
}
TEST_F(MachineRule, RefusesAUnitOfAnotherKind) {
    expectError("velocity=\"500 mm/s\"", "velocity=\"500 deg/s\"", "'deg/s' is not known here",
                "mm/s");
}
TEST_F(MachineRule, RefusesAMissingUnit) {
    expectError("softPositive=\"800 mm\"", "softPositive=\"800\"", "the unit is missing",
                "mm, um, cm, m");
}
TEST_F(MachineRule, RefusesAnUnknownUserUnit) {
    expectError("<Axis name=\"X\" unit=\"mm\">", "<Axis name=\"X\" unit=\"inch\">", "unit=\"inch\"",
                "mm, deg");
}
TEST_F(MachineRule, RefusesNan) {
    expectError("velocity=\"500 mm/s\"", "velocity=\"nan mm/s\"", "not a number", "above 0");
}
TEST_F(MachineRule, RefusesOverflow) {
    expectError("softPositive=\"800 mm\"", "softPositive=\"1e999 mm\"", "too large", "with a unit");
}
TEST_F(MachineRule, RefusesAWholeNumberThatOverflows) {
    expectError("countsPerTurn=\"10000\"", "countsPerTurn=\"4294977296\"", "out of range",
                "1 to 2147483647");
}
TEST_F(MachineRule, RefusesATimeThatIsNoWholeNanosecond) {
    expectError("wakeJitter=\"30 us\"", "wakeJitter=\"0.0005 us\"", "whole number of nanoseconds",
                "nanoseconds");
}
TEST_F(MachineRule, RefusesAWrongFlag) {
    expectError("vertical=\"true\"", "vertical=\"yes\"", "neither true nor false", "true, false");
}

// --- network and slaves

TEST_F(MachineRule, RefusesAMissingDeviceFile) {
    expectError("devices/cd300e.xml", "devices/cd3000.xml", "there is no device file",
                "relative to the machine file");
}
TEST_F(MachineRule, ReportsAFaultInADeviceFileThere) {
    folder_.write(
        "bad.xml",
        "<EtherCATInfo>\n<Vendor><Id>x</Id></Vendor><Descriptions><Devices><Device>"
        "<Type ProductCode='1'>T</Type></Device></Devices></Descriptions></EtherCATInfo>");
    const auto result = loadWith("devices/cd300e.xml", "bad.xml");
    EXPECT_FALSE(result.machine);
    EXPECT_NE(
        format(result.diagnostics).find("bad.xml:2: error: <Vendor>/<Id>: 'x' is not a number"),
        std::string::npos)
        << format(result.diagnostics);
}
TEST_F(MachineRule, RefusesADeviceThatNoFileDescribes) {
    expectError("device=\"CD300E\"", "device=\"CD300\"", "did you mean 'CD300E'?", "CD300E, RA");
}
TEST_F(MachineRule, RefusesAWrongIdentity) {
    expectError("device=\"CD300E\"", "device=\"CD300E\" revision=\"0x7\"",
                "no device 'CD300E' with this identity", "revision 0x00010002");
}
TEST_F(MachineRule, RefusesAWrongVendor) {
    expectError("device=\"CD300E\"", "device=\"CD300E\" vendor=\"2\"", "with this identity",
                "vendor 0xFFFF0CD3");
}
TEST_F(MachineRule, RefusesDoubledSlaveNames) {
    expectError("  </Network>", "<Slave name=\"x\" device=\"RA\"/>\n  </Network>",
                "there is a slave of this name in line 6", "once");
}
TEST_F(MachineRule, RefusesDoubledAxisNames) {
    expectError("<Axis name=\"Z\"", "<Axis name=\"X\"", "there is an axis of this name in line 25",
                "once");
}
TEST_F(MachineRule, RefusesDoubledProgramNames) {
    expectError("  <Twin clock", "  <Program name=\"pick\"/>\n  <Twin clock",
                "there is a program of this name", "once");
}
TEST_F(MachineRule, RefusesANameThatIsNone) {
    expectError("<Axis name=\"Z\"", "<Axis name=\"Z axis\"", "this is not a name", "letters");
}
TEST_F(MachineRule, RefusesANetworkWithoutSlaves) {
    const auto result = loadText("<Machine name=\"m\">\n<Network/>\n</Machine>");
    ASSERT_EQ(result.diagnostics.errorCount(), 1U) << format(result.diagnostics);
    EXPECT_EQ(result.diagnostics.items()[0].place.line, 2);
}
TEST_F(MachineRule, RefusesAnUnknownDcMode) {
    expectError("mode=\"DC-Synchron\"", "mode=\"DC-Sync\"", "the device has no DC mode 'DC-Sync'",
                "off, DC-Synchron, SM-Synchron, FreeRun");
}
TEST_F(MachineRule, RefusesAShiftBeyondTheCycle) {
    expectError("shift=\"0 us\"", "shift=\"1 ms\"", "not below the cycle", "-1 ms to 1 ms");
}

class Cd300eCycle : public test::MachineFile,
                    public testing::WithParamInterface<std::pair<const char*, bool>> {};

TEST_P(Cd300eCycle, IsOneOfSeven) {
    const auto [cycle, taken] = GetParam();
    std::string text = BaseMachine;
    const std::size_t slave = text.find("<Slave name=\"z\"");
    text.erase(slave, text.find("</Slave>", slave) + 8 - slave);
    const std::size_t axis = text.find("<Axis name=\"Z\"");
    text.erase(axis, text.find("</Axis>", axis) + 7 - axis);
    text.replace(text.find("1 ms"), 4, cycle);
    const auto result = loadText(text);
    EXPECT_EQ(result.machine.has_value(), taken) << format(result.diagnostics);
    if (taken) return;
    const Diagnostic error = test::firstOf(result.diagnostics, Severity::Error);
    EXPECT_EQ(error.place.line, 3);
    EXPECT_NE(error.what.find("CD300E of slave 'x'"), std::string::npos) << error.what;
    EXPECT_EQ(error.allowed, "125 us, 250 us, 500 us, 1 ms, 2 ms, 4 ms, 8 ms");
}

INSTANTIATE_TEST_SUITE_P(Times, Cd300eCycle,
                         testing::Values(std::pair{"125 us", true}, std::pair{"250 us", true},
                                         std::pair{"0.5 ms", true}, std::pair{"1 ms", true},
                                         std::pair{"2 ms", true}, std::pair{"4 ms", true},
                                         std::pair{"8 ms", true}, std::pair{"3 ms", false},
                                         std::pair{"375 us", false}, std::pair{"10 ms", false},
                                         std::pair{"100 us", false}));

TEST_F(MachineRule, RefusesACycleThatBothDrivesRefuse) {
    const auto result = loadWith("cycle=\"1 ms\"", "cycle=\"1100 us\"");
    EXPECT_EQ(result.diagnostics.errorCount(), 2U) << format(result.diagnostics);
    EXPECT_NE(format(result.diagnostics).find("multiples of 125 us up to 16 ms"),
              std::string::npos);
}
TEST_F(MachineRule, RefusesACycleOfZero) {
    expectError("cycle=\"1 ms\"", "cycle=\"0 ms\"", "must not be 0", "above 0");
}

TEST_F(MachineRule, RefusesAWatchdogThatIsOff) {
    expectError("time=\"100 ms\"", "time=\"0 ms\"", "the watchdog is off", "from 6 ms");
}
TEST_F(MachineRule, RefusesAWatchdogBelowTwiceTheLostFrames) {
    expectError("time=\"100 ms\"", "time=\"5 ms\"", "too short", "from 6 ms (twice 3 lost cycles)");
}
TEST_F(MachineRule, RefusesAWatchdogThatTheRegisterCannotHold) {
    expectError("time=\"100 ms\"", "time=\"7 s\"", "cannot be set", "6553500 us");
}
TEST_F(MachineRule, RefusesTheDefaultWatchdogWhenTooManyFramesMayBeLost) {
    const auto result = loadWith("lostFrames=\"3\"", "lostFrames=\"60\"");
    EXPECT_EQ(result.diagnostics.errorCount(), 2U) << format(result.diagnostics);
    EXPECT_NE(format(result.diagnostics).find("from 120 ms"), std::string::npos);
}

// --- process data and start-up objects

TEST_F(MachineRule, RefusesAnObjectThatTheDeviceLacks) {
    expectError("index=\"0x60FD\"", "index=\"0x60FB\"", "the device has no object 0x60FB:00",
                "dictionary");
}
TEST_F(MachineRule, RefusesAnObjectThatCannotBeMapped) {
    expectError("<Entry index=\"0x60FD\" bits=\"32\"/>", "<Entry index=\"0x6502\" bits=\"32\"/>",
                "0x6502:00 cannot be mapped to the inputs", "TxPDOs");
}
TEST_F(MachineRule, RefusesAnOutputAmongTheInputs) {
    expectError("<Entry index=\"0x60FD\" bits=\"32\"/>", "<Entry index=\"0x607C\" bits=\"32\"/>",
                "cannot be mapped to the inputs", "TxPDOs");
}
TEST_F(MachineRule, RefusesAWrongSize) {
    expectError("index=\"0x60FD\" bits=\"32\"", "index=\"0x60FD\" bits=\"16\"",
                "0x60FD:00 has 32 bits, not 16", "32");
}
TEST_F(MachineRule, RefusesAPdoThatTheDeviceLacks) {
    expectError("<Pdo index=\"0x1A00\">", "<Pdo index=\"0x1B00\">", "the device has no PDO 0x1B00",
                "inputs 0x1A00");
}
TEST_F(MachineRule, RefusesAMissingTargetPosition) {
    expectError("        <Entry index=\"0x607A\" bits=\"32\"/>\n", "",
                "the target position 0x607A (32 bits)", "0x6040, 0x6060 and 0x607A", -4);
}
TEST_F(MachineRule, RefusesAMissingModeDisplay) {
    expectError("        <Entry index=\"0x6061\" bits=\"8\"/>\n", "", "the mode display 0x6061",
                "0x6061", -10);
}
TEST_F(MachineRule, RefusesAnObjectMappedTwice) {
    expectError("<Entry index=\"0x60FD\" bits=\"32\"/>", "<Entry index=\"0x6064\" bits=\"32\"/>",
                "0x6064:00 is mapped twice to the inputs", "once", -11);
}
TEST_F(MachineRule, RefusesMoreBytesThanTheRaTakes) {
    std::string entries;
    for (const char* index :
         {"0x60FD", "0x606C", "0x60F4", "0x60BA", "0x60BB", "0x60BC", "0x60BD"}) {
        entries += std::string{"<Entry index=\""} + index + "\"/>";
    }
    expectError("<Entry index=\"0x60FD\" bits=\"32\"/>", entries, "the PDO 0x1A00 has 35 bytes",
                "at most 32", -11);
}
TEST_F(MachineRule, RefusesMoreEntriesThanTheCd300eTakes) {
    std::string pdo = "<Pdo index=\"0x1A00\">";
    for (const char* index : {"0x603F", "0x6041", "0x6061", "0x6064", "0x606C", "0x6077", "0x60B9",
                              "0x60BA", "0x60F4"}) {
        pdo += std::string{"<Entry index=\""} + index + "\"/>";
    }
    expectError("<Slave name=\"x\" device=\"CD300E\">",
                "<Slave name=\"x\" device=\"CD300E\">" + pdo + "</Pdo>",
                "the PDO 0x1A00 has 9 entries", "at most 8");
}
TEST_F(MachineRule, RefusesASecondPdoWhereTheRaTakesOne) {
    expectError("<Pdo index=\"0x1A00\">",
                "<Pdo index=\"0x1A01\"><Entry index=\"0x606C\"/></Pdo><Pdo index=\"0x1A00\">",
                "there are 2 PDOs for the inputs", "at most 1", -7);
}
TEST_F(MachineRule, RefusesAStartupObjectOfTheMaster) {
    expectError("<Startup index=\"0x6065\" value=\"20000\"/>",
                "<Startup index=\"0x1C12\" sub=\"1\" value=\"0x1600\"/>",
                "is written by the master", "other objects");
}
TEST_F(MachineRule, RefusesAStartupValueOutOfRange) {
    expectError("<Startup index=\"0x6065\" value=\"20000\"/>",
                "<Startup index=\"0x6098\" value=\"99\"/>", "value=\"99\": this is out of range",
                "-18 to 35");
}
TEST_F(MachineRule, RefusesAStartupObjectThatCannotBeWritten) {
    expectError("index=\"0x6065\"", "index=\"0x6064\"", "0x6064:00 cannot be written", "writable");
}
TEST_F(MachineRule, RefusesAStartupTypeOfAnotherSize) {
    expectError("index=\"0x6065\" value", "index=\"0x6065\" type=\"int16\" value",
                "0x6065:00 has 32 bits", "uint32");
}
TEST_F(MachineRule, WantsATypeForAnObjectOutsideTheDictionary) {
    expectError("index=\"0x6065\" value=\"20000\"", "index=\"0x2F00\" sub=\"1\" value=\"0\"",
                "'type' is missing", "uint16");
}

// --- axes

TEST_F(MachineRule, RefusesAnAxisOnAMissingSlave) {
    expectError("<Drive slave=\"z\"", "<Drive slave=\"w\"", "there is no slave 'w'", "x, z");
}
TEST_F(MachineRule, RefusesTwoAxesOnOneSlave) {
    expectError("<Drive slave=\"z\"", "<Drive slave=\"x\"",
                "the slave 'x' already drives another axis", "one axis");
}
TEST_F(MachineRule, RefusesSwappedSoftLimits) {
    expectError("softNegative=\"-2 mm\"", "softNegative=\"900 mm\"", "the soft limits are swapped",
                "softNegative below softPositive");
}
TEST_F(MachineRule, RefusesAStrokeBeyond32Bits) {
    expectError("softPositive=\"800 mm\"", "softPositive=\"4294968 mm\"", "the drive has 32 bits",
                "4294967.294 mm");
}
TEST_F(MachineRule, TakesAStrokeOfJust32Bits) {
    EXPECT_TRUE(loadWith("softPositive=\"800 mm\"", "softPositive=\"4294967.294 mm\"").machine);
}
TEST_F(MachineRule, RefusesSoftLimitsOfAModuloAxis) {
    expectError("acceleration=\"3600 deg/s^2\"/>",
                "acceleration=\"3600 deg/s^2\" softPositive=\"90 deg\"/>",
                "a modulo axis turns endlessly", "either modulo or soft limits");
}
TEST_F(MachineRule, RefusesAVelocityAboveTheMotor) {
    expectError("velocity=\"500 mm/s\"", "velocity=\"1001 mm/s\"", "3003 rpm", "at most 1000 mm/s");
}
TEST_F(MachineRule, TakesAVelocityOfJustTheMotor) {
    EXPECT_TRUE(loadWith("velocity=\"500 mm/s\"", "velocity=\"1000 mm/s\"").machine);
}
TEST_F(MachineRule, RefusesAVelocityAboveWhatTheEncoderCanTell) {
    expectError("velocity=\"360 deg/s\"", "velocity=\"1300000000 deg/s\"", "in one cycle",
                "2^30 counts");
}
TEST_F(MachineRule, RefusesAnAccelerationOfZero) {
    expectError("acceleration=\"2000 mm/s^2\"", "acceleration=\"0 mm/s^2\"", "must not be 0",
                "above 0");
}
TEST_F(MachineRule, RefusesAJerkOfZero) {
    expectError("jerk=\"50000 mm/s^3\"", "jerk=\"0 mm/s^3\"", "must not be 0", "mm/s^3");
}
TEST_F(MachineRule, RefusesANegativeVelocity) {
    expectError("velocity=\"500 mm/s\"", "velocity=\"-500 mm/s\"", "must not be negative",
                "above 0");
}
TEST_F(MachineRule, RefusesAGearOfZeroToZero) {
    expectError("gear=\"10/1\"", "gear=\"0/0\"", "gear=\"0/0\"", "motor turns / load turns");
}
TEST_F(MachineRule, RefusesAScalingThatNeedsMoreThan64Bits) {
    expectError("perTurn=\"20 mm\"", "perTurn=\"20.000000000000001 mm\"", "64 bits", "");
}
TEST_F(MachineRule, RefusesAModuloPeriodBeyond32Bits) {
    expectError("modulo=\"360 deg\"", "modulo=\"3600000000 deg\"", "one period is", "counts");
}
TEST_F(MachineRule, RefusesAHomingMethodThatTheDriveLacks) {
    const auto result = loadWith("<Homing method=\"35\"/>", "<Homing method=\"24\"/>");
    EXPECT_FALSE(result.machine);
    const Diagnostic error = test::firstOf(result.diagnostics, Severity::Error);
    EXPECT_EQ(error.place.line, changedLine_);
    EXPECT_EQ(error.allowed, "1 to 6, 17 to 22, 33, 34, 35");
}
TEST_F(MachineRule, RefusesAHomingSpeedAboveTheAxis) {
    expectError("switchSpeed=\"50 mm/s\"", "switchSpeed=\"501 mm/s\"",
                "above the velocity of the axis", "at most 500 mm/s");
}
TEST_F(MachineRule, RefusesAHomingAccelerationThatTheDriveRefuses) {
    expectError("<Homing method=\"35\"/>", "<Homing method=\"19\" acceleration=\"601 deg/s^2\"/>",
                "the drive would need 10017 in 0x609A:00", "at most 600 deg/s^2");
}
TEST_F(MachineRule, RefusesAVerticalAxisWhoseStopIsNotConfirmed) {
    expectError("slave=\"z\" lostCommunication=\"confirmed\"", "slave=\"z\"", "is not documented",
                "lostCommunication=\"confirmed\"");
}

// --- programs and twin

TEST_F(MachineRule, RefusesAMissingProgram) {
    expectError("libpick.so", "libpock.so", "the library 'libpock.so' is not there",
                "a file in one of: ");
}
TEST_F(MachineRule, RefusesABudgetAboveTheCycle) {
    expectError("budget=\"40 %\"", "budget=\"101 %\"", "more than the whole cycle", "100 %");
}
TEST_F(MachineRule, RefusesATwinOfAMissingSlave) {
    expectError("<Device slave=\"x\"", "<Device slave=\"q\"", "there is no slave 'q'", "slaves");
}
TEST_F(MachineRule, RefusesATwinSwitchWithSwappedEnds) {
    expectError("from=\"-10 mm\"", "from=\"10 mm\"", "'from' is not below 'to'", "from below to");
}
TEST_F(MachineRule, RefusesAStartOutsideTheHardStops) {
    expectError("start=\"120 mm\" inertia=\"3 kg cm^2\">",
                "start=\"120 mm\" inertia=\"3 kg cm^2\"><HardStops to=\"100 mm\"/>",
                "outside the hard stops", "HardStops");
}

TEST_F(MachineRule, RefusesACrowdOfAxes) {
    std::string crowd;
    for (int i = 0; i < 5000; ++i) crowd += "<Axis/>";
    const auto result = loadWith("  <Twin clock", crowd + "  <Twin clock");
    EXPECT_FALSE(result.machine);
    EXPECT_NE(format(result.diagnostics).find("there are 5002 <Axis>"), std::string::npos);
}

// --- all of it together

TEST_F(MachineRule, TellsAllFaultsAtOnceInTheOrderOfTheirLines) {
    std::string text = BaseMachine;
    const auto change = [&text](std::string_view old, std::string_view fresh) {
        text.replace(text.find(old), old.size(), fresh);
    };
    change("device=\"CD300E\"", "device=\"CD300E\" colour=\"red\"");
    change("500 mm/s\"", "500\"");
    change("<Homing method=\"35\"/>", "<Homing method=\"thirty\"/>");
    change("libpick.so", "missing.so");
    change("35 ppm", "35 ppb");
    const auto result = loadText(text);
    EXPECT_FALSE(result.machine);
    EXPECT_EQ(result.diagnostics.errorCount(), 5U) << format(result.diagnostics);
    int last = 0;
    for (const Diagnostic& item : result.diagnostics.items()) {
        EXPECT_GE(item.place.line, last);
        last = item.place.line;
    }
}

/// Whatever the schema finds, loading refuses too: the schema is never stricter in silence.
TEST_F(MachineRule, RefusesWhatTheSchemaRefuses) {
    int refused = 0;
    for (std::size_t at = BaseMachine.find("<Network"); at < BaseMachine.size(); at += 5) {
        std::string text = BaseMachine;
        text[at] = text[at] == 'a' ? 'b' : 'a';
        const bool bySchema = !validate(text, machineSchema()).empty();
        const auto result = loadText(text);
        if (bySchema) {
            ++refused;
            EXPECT_TRUE(result.diagnostics.hasErrors()) << text.substr(at - 20, 40);
        }
    }
    EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace takt::config
