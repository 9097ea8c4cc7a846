#include <gtest/gtest.h>

#include <cmath>

#include "machine_base.hpp"
#include "machine_schema.hpp"
#include "xml_encoding.hpp"

namespace takt::config {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using test::BaseMachine;
using test::MachineFile;
using test::readAll;
using test::ScratchFolder;

TEST_F(MachineFile, LoadsWithoutAnythingToSay) {
    const LoadResult result = loadText(BaseMachine);
    EXPECT_TRUE(result.diagnostics.empty()) << format(result.diagnostics);
    ASSERT_TRUE(result.machine);
    EXPECT_EQ(result.machine->name, "bench");
    EXPECT_EQ(result.machine->network.cycle, milliseconds{1});
    EXPECT_EQ(result.machine->scheduler.cycle, milliseconds{1});
}

TEST_F(MachineFile, PlacesSlavesInFrameOrder) {
    const auto machine = loadText(BaseMachine).machine;
    ASSERT_TRUE(machine && machine->network.slaves.size() == 2);
    EXPECT_EQ(machine->network.slaves[0].name, "x");
    EXPECT_EQ(machine->network.slaves[1].name, "z");
    EXPECT_EQ(machine->network.slaves[1].position, 1);
    EXPECT_EQ(machine->network.slaves[0].device->type, "CD300E");
    EXPECT_EQ(machine->network.slaves[0].watchdog, milliseconds{100});
    EXPECT_NE(machine->network.slaves[0].origin.find("machine.xml:6"), std::string::npos);
}

TEST_F(MachineFile, LetsEveryAxisTolerateTheLostFramesOfTheNetwork) {
    std::string text{BaseMachine};
    const std::size_t at = text.find("lostFrames=\"3\"");
    ASSERT_NE(at, std::string::npos);
    const auto machine = loadText(text.replace(at, 14, "lostFrames=\"5\"")).machine;
    ASSERT_TRUE(machine);
    for (const auto& axis : machine->axes) EXPECT_EQ(axis.supervision.lostCycles, 5U);
}

TEST_F(MachineFile, TakesTheDeliveredPdosWhereNoneAreNamed) {
    const auto machine = loadText(BaseMachine).machine;
    ASSERT_TRUE(machine);
    const auto& slave = machine->network.slaves[0];
    ASSERT_EQ(slave.outputs.size(), 1U);
    EXPECT_EQ(slave.outputs[0].entries.size(), 4U);
    EXPECT_FALSE(slave.outputs[0].writeMapping || slave.writeAssignment);
    EXPECT_EQ(slave.inputs.at(0).entries.size(), 7U);
}

TEST_F(MachineFile, WritesOnlyWhatDiffersFromTheDelivery) {
    const auto machine = loadText(BaseMachine).machine;
    ASSERT_TRUE(machine);
    const auto& slave = machine->network.slaves[1];
    EXPECT_TRUE(slave.outputs.at(0).writeMapping && slave.inputs.at(0).writeMapping);
    EXPECT_FALSE(slave.writeAssignment);
    EXPECT_EQ(slave.inputs[0].entries.at(3).index, 0x60FD);
}

TEST_F(MachineFile, WritesTheAssignmentWhenAnotherPdoIsNamed) {
    const auto result = loadWith(
        "    <Slave name=\"x\" device=\"CD300E\">",
        "    <Slave name=\"x\" device=\"CD300E\"><Pdo index=\"0x1601\">"
        "<Entry index=\"0x6040\"/><Entry index=\"0x6060\"/><Entry index=\"0x607A\"/></Pdo>");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    const auto& slave = result.machine->network.slaves[0];
    EXPECT_TRUE(slave.writeAssignment);
    EXPECT_EQ(slave.outputs.at(0).index, 0x1601);
    EXPECT_EQ(slave.outputs[0].entries.at(2).bits, 32) << "from the dictionary";
    EXPECT_EQ(slave.inputs.at(0).index, 0x1A00) << "the other direction stays";
}

TEST_F(MachineFile, ChoosesDcWithSync0ByItself) {
    const auto machine = loadText(BaseMachine).machine;
    ASSERT_TRUE(machine);
    EXPECT_TRUE(machine->network.slaves[0].dc.enabled);
    EXPECT_EQ(machine->network.slaves[0].dc.assignActivate, 0x0300);
    EXPECT_EQ(machine->network.slaves[0].dc.sync0Cycle, milliseconds{1});
}

TEST_F(MachineFile, KeepsTheScalingAsAnExactRatio) {
    const auto result = loadWith("perTurn=\"20 mm\"", "perTurn=\"20.3 mm\"");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    const axis::ScalingParams& scaling = result.machine->axes[0].scaling;
    EXPECT_EQ(scaling.countsPerTurn, 10000);
    EXPECT_EQ(scaling.unitsPerTurnNumerator, 203);
    EXPECT_EQ(scaling.unitsPerTurnDenominator, 10);
    const axis::ScalingParams& rotary = result.machine->axes[1].scaling;
    EXPECT_EQ(rotary.gearMotor, 10);
    EXPECT_EQ(rotary.gearLoad, 1);
    EXPECT_EQ(rotary.unitsPerTurnNumerator, 360);
    ASSERT_TRUE(rotary.modulo);
    EXPECT_EQ(rotary.modulo->count(), 360.0);
}

TEST_F(MachineFile, FillsInLimitsThatAreLeftOut) {
    const auto machine = loadText(BaseMachine).machine;
    ASSERT_TRUE(machine);
    const axis::LimitParams& limits = machine->axes[1].limits;
    EXPECT_EQ(limits.acceleration.count(), 3600.0);
    EXPECT_EQ(limits.deceleration.count(), 3600.0);
    EXPECT_EQ(limits.jerk.count(), 36000.0);
    EXPECT_EQ(limits.stopDeceleration.count(), 3600.0);
    EXPECT_EQ(limits.stopJerk.count(), 36000.0);
    EXPECT_FALSE(limits.softNegative || limits.softPositive);
    EXPECT_EQ(machine->axes[1].supervision.followingError.count(), 7.2) << "20 ms at 360 deg/s";
}

TEST_F(MachineFile, KnowsTheUnitsOfEachDriveFamily) {
    const auto machine = loadText(BaseMachine).machine;
    ASSERT_TRUE(machine);
    EXPECT_EQ(machine->axes[0].drive.profile, "cd300e");
    EXPECT_EQ(machine->axes[0].drive.velocityUnit, axis::DriveVelocityUnit::CountsPerSecond);
    EXPECT_EQ(machine->axes[0].drive.maxMotorSpeed.count(), 50.0);
    EXPECT_EQ(machine->axes[1].drive.profile, "ra");
    EXPECT_EQ(machine->axes[1].drive.velocityUnit, axis::DriveVelocityUnit::TenthRpm);
}

TEST_F(MachineFile, LetsTheProfileBeOverridden) {
    const auto result = loadWith("name=\"x\" device=\"CD300E\"",
                                 "name=\"x\" device=\"CD300E\" profile=\"generic\"");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_EQ(result.machine->axes[0].drive.profile, "generic");
    EXPECT_EQ(result.machine->twin.devices[0].profile, "generic");
}

TEST_F(MachineFile, GivesEverySlaveATwin) {
    const auto machine = loadText(BaseMachine).machine;
    ASSERT_TRUE(machine && machine->twin.devices.size() == 2);
    EXPECT_EQ(machine->twin.hostPpm, 12.0);
    EXPECT_EQ(machine->twin.wakeJitter, microseconds{30});
    EXPECT_EQ(machine->twin.devices[0].clockPpm, 35.0);
    EXPECT_EQ(machine->twin.devices[1].slave, "z");
    EXPECT_EQ(machine->twin.devices[1].countsPerTurn, 32768);
}

TEST_F(MachineFile, TurnsTwinPositionsIntoMotorTurns) {
    const auto machine = loadText(BaseMachine).machine;
    ASSERT_TRUE(machine);
    const twin::MechanicsParams& mechanics = machine->twin.devices[0].mechanics;
    EXPECT_DOUBLE_EQ(mechanics.startTurns, 6.0);
    ASSERT_TRUE(mechanics.homeSwitch);
    EXPECT_DOUBLE_EQ(mechanics.homeSwitch->fromTurns, -0.5);
    EXPECT_DOUBLE_EQ(mechanics.homeSwitch->toTurns, 0.25);
    EXPECT_DOUBLE_EQ(mechanics.inertia, 3e-4);
    EXPECT_FALSE(mechanics.hardStopNegative);
}

TEST_F(MachineFile, MirrorsTwinPositionsOfAReversedAxis) {
    const auto result = loadWith("perTurn=\"20 mm\"", "perTurn=\"20 mm\" reversed=\"true\"");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    const twin::MechanicsParams& mechanics = result.machine->twin.devices[0].mechanics;
    EXPECT_DOUBLE_EQ(mechanics.startTurns, -6.0);
    EXPECT_DOUBLE_EQ(mechanics.homeSwitch->fromTurns, -0.25);
    EXPECT_DOUBLE_EQ(mechanics.homeSwitch->toTurns, 0.5);
}

TEST_F(MachineFile, TakesTwinPositionsInMotorTurnsToo) {
    const auto result = loadWith("start=\"120 mm\"", "start=\"1.5 turns\"");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_DOUBLE_EQ(result.machine->twin.devices[0].mechanics.startTurns, 1.5);
}

TEST_F(MachineFile, FindsAProgramBesideItselfFirst) {
    const ScratchFolder& folder = folder_;
    std::filesystem::create_directory(folder.path() / "other");
    folder.write("other/libpick.so", "");
    folder.write("machine.xml", BaseMachine);
    auto result = loadMachine(folder.path() / "machine.xml", {folder.path() / "other"});
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_EQ(result.machine->programs.at(0).library, (folder.path() / "libpick.so").string());
    EXPECT_DOUBLE_EQ(result.machine->programs[0].budgetShare, 0.4);
    std::filesystem::remove(folder.path() / "libpick.so");
    result = loadMachine(folder.path() / "machine.xml", {folder.path() / "other"});
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_EQ(result.machine->programs[0].library, (folder.path() / "other/libpick.so").string());
}

TEST_F(MachineFile, NotesASlaveWithoutAxisAndGoesOn) {
    const auto result =
        loadWith("  </Network>", "    <Slave name=\"spare\" device=\"RA\"/>\n  </Network>");
    EXPECT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_NE(format(result.diagnostics).find("note: slave 'spare': no axis uses it"),
              std::string::npos);
}

TEST_F(MachineFile, NotesAnUndocumentedStopOfAHorizontalAxis) {
    const auto result =
        loadWith("maxSpeed=\"3000 rpm\" lostCommunication=\"confirmed\"", "maxSpeed=\"3000 rpm\"");
    EXPECT_TRUE(result.machine);
    const Diagnostic note = test::firstOf(result.diagnostics, Severity::Note);
    EXPECT_EQ(note.place.line, changedLine_);
    EXPECT_NE(note.what.find("coasting"), std::string::npos);
}

TEST_F(MachineFile, WarnsOfALinearAxisWithoutSoftLimits) {
    const auto result = loadWith("            softNegative=\"-2 mm\"\n", "");
    EXPECT_TRUE(result.machine) << format(result.diagnostics);
    const Diagnostic warning = test::firstOf(result.diagnostics, Severity::Warning);
    EXPECT_EQ(warning.place.line, changedLine_ - 1);
    EXPECT_NE(warning.what.find("softNegative"), std::string::npos);
    EXPECT_NE(warning.allowed.find("4294967.294 mm"), std::string::npos) << warning.allowed;
}

TEST_F(MachineFile, WarnsOfADriveWithoutDistributedClocks) {
    const auto result = loadWith("mode=\"DC-Synchron\" shift=\"0 us\"", "mode=\"off\"");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_FALSE(result.machine->network.slaves[1].dc.enabled);
    EXPECT_NE(test::firstOf(result.diagnostics, Severity::Warning).what.find("distributed clocks"),
              std::string::npos);
}

TEST_F(MachineFile, TakesTheShortestFileThatMakesSense) {
    const auto result = loadText(R"(<Machine name="short">
  <Network><Esi file="devices/ra.xml"/><Slave name="a" device="RA"/></Network>
  <Axis name="A" unit="mm">
    <Drive slave="a"/><Scaling perTurn="5 mm"/>
    <Limits velocity="100 mm/s" acceleration="1000 mm/s^2" softNegative="0 mm" softPositive="100 mm"/>
  </Axis>
</Machine>)");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_EQ(result.diagnostics.warningCount(), 0U) << format(result.diagnostics);
    EXPECT_EQ(result.machine->axes[0].scaling.countsPerTurn, 32768);
    EXPECT_EQ(result.machine->axes[0].homing.method, 35);
}

TEST(GantrySample, LoadsWithoutAnythingToSay) {
    const ScratchFolder libraries;
    libraries.write("libgantry.so", "");
    const LoadResult result =
        loadMachine(TAKT_SOURCE_DIR "/samples/03_gantry/machine.xml", {libraries.path()});
    EXPECT_TRUE(result.diagnostics.empty()) << format(result.diagnostics);
    ASSERT_TRUE(result.machine);
    EXPECT_EQ(result.machine->axes.size(), 3U);
    EXPECT_EQ(result.machine->axes[2].drive.profile, "ra");
    EXPECT_TRUE(result.machine->axes[2].vertical);
    EXPECT_EQ(result.machine->twin.devices.at(1).clockPpm, -50.0);
}

TEST(GantrySample, IsValidByTheSchema) {
    const auto messages =
        validate(readAll(TAKT_SOURCE_DIR "/samples/03_gantry/machine.xml"), machineSchema());
    EXPECT_TRUE(messages.empty()) << messages.front().line << ": " << messages.front().text;
}

TEST(MachineSchema, TakesTheMachineThatTheRulesTake) {
    const auto messages = validate(BaseMachine, machineSchema());
    EXPECT_TRUE(messages.empty()) << messages.front().line << ": " << messages.front().text;
}

TEST(MachineSchema, IsTheFileThatEditorsUse) {
    EXPECT_EQ(machineSchema(), readAll(TAKT_SOURCE_DIR "/config/schema/machine.xsd"));
}

}  // namespace
}  // namespace takt::config
