#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <takt/config/eni_reader.hpp>
#include <takt/config/load_machine.hpp>

#include "test_files.hpp"

namespace takt::config::test {
namespace {

using fieldbus::Transition;
using testing::ElementsAre;
using testing::HasSubstr;
using Kind = fieldbus::CyclicCommand::Kind;

const std::filesystem::path Sample{TAKT_SOURCE_DIR "/samples/06_eni/line.eni.xml"};

EniNetwork sample() {
    Diagnostics diagnostics;
    auto network = readEni(Sample, diagnostics);
    EXPECT_TRUE(network) << format(diagnostics);
    return network.value_or(EniNetwork{});
}

TEST(EniReader, GivesSlavesInFrameOrderWithTheirIdentity) {
    const EniNetwork network = sample();
    ASSERT_EQ(network.slaves.size(), 5U);
    EXPECT_EQ(network.slaves[2].name, "Drive 3 (RA)");
    EXPECT_EQ(network.slaves[2].device.type, "RA");
    EXPECT_EQ(network.slaves[2].listed.station, 1003);
    EXPECT_EQ(network.slaves[2].device.identity.vendor, 0xFFFF0A5EU);
    EXPECT_EQ(network.slaves[2].device.identity.product, 0x000A2000U);
    EXPECT_EQ(network.slaves[2].device.identity.revision, 0x00000101U);
}

TEST(EniReader, KeepsTheCommandsOfATransitionInOrderWithTheirChecks) {
    const EniNetwork network = sample();
    const auto& commands = network.slaves[0].listed.commands;
    ASSERT_GT(commands.size(), 3U);
    EXPECT_EQ(commands[0].command, 2);  // APWR
    EXPECT_EQ(commands[0].ado, 0x0500);
    EXPECT_TRUE(commands[0].transitions.has(Transition::InitToPreOp));
    EXPECT_FALSE(commands[0].transitions.has(Transition::PreOpToSafeOp));
    EXPECT_EQ(commands[0].workingCounter, 1);
    EXPECT_EQ(commands[0].retries, 3U);
    ASSERT_TRUE(commands[2].validation);
    EXPECT_THAT(commands[2].validation->data, ElementsAre(0xD3, 0x0C, 0xFF, 0xFF));
    EXPECT_THAT(commands[2].validation->mask, ElementsAre(0xFF, 0xFF, 0xFF, 0xFF));
    EXPECT_EQ(commands[2].validation->timeout, std::chrono::milliseconds{100});
}

TEST(EniReader, GivesTheCommandsToAllDevicesTheirPlace) {
    const EniNetwork network = sample();
    ASSERT_EQ(network.listed.commands.size(), 12U);
    EXPECT_TRUE(network.listed.commands[0].beforeSlaves);
    EXPECT_EQ(network.listed.commands[0].workingCounter, 5);
    EXPECT_EQ(network.listed.commands[5].data.size(), 256U) << "<DataLength> stands for zeros";
}

TEST(EniReader, GivesObjectsWithTheirLines) {
    const EniNetwork network = sample();
    const auto& objects = network.slaves[2].listed.objects;
    ASSERT_EQ(objects.size(), 20U);
    EXPECT_EQ(objects[3].index, 0x1600);
    EXPECT_EQ(objects[3].subindex, 1);
    EXPECT_THAT(objects[3].data, ElementsAre(0x10, 0x00, 0x40, 0x60));
    EXPECT_THAT(objects[3].origin, HasSubstr("line.eni.xml:"));
}

TEST(EniReader, MakesADescriptionThatASlaveCanBeBuiltFrom) {
    const EniNetwork network = sample();
    const wire::DeviceDescription& device = network.slaves[3].device;
    ASSERT_EQ(device.syncManagers.size(), 4U);
    EXPECT_EQ(device.syncManagers[0].use, wire::SyncManagerUse::MailboxOut);
    EXPECT_EQ(device.syncManagers[1].start, 0x1100);
    EXPECT_EQ(device.syncManagers[2].defaultSize, 7);
    EXPECT_EQ(device.syncManagers[3].use, wire::SyncManagerUse::Inputs);
    EXPECT_THAT(device.fmmus, ElementsAre(wire::FmmuUse::Outputs, wire::FmmuUse::Inputs,
                                          wire::FmmuUse::MailboxState));
    ASSERT_TRUE(device.mailbox);
    EXPECT_TRUE(device.mailbox->coe);
    EXPECT_NE(device.findObject(0x607A), nullptr);
    EXPECT_NE(device.findObject(0x6098), nullptr) << "what CiA 402 prescribes for homing";
    EXPECT_EQ(network.slaves[4].device.mailbox, std::nullopt);
    EXPECT_EQ(network.slaves[4].device.findObject(0x6098), nullptr);
}

TEST(EniReader, TellsClocksFromTheCommandsThatSwitchThemOn) {
    const EniNetwork network = sample();
    EXPECT_TRUE(network.slaves[0].dc.enabled);
    EXPECT_EQ(network.slaves[0].dc.assignActivate, 0x0300);
    EXPECT_EQ(network.slaves[0].dc.sync0Cycle, std::chrono::milliseconds{1});
    EXPECT_FALSE(network.slaves[4].dc.enabled);
}

TEST(EniReader, KnowsWhatTheCyclicCommandsAreFor) {
    const EniNetwork network = sample();
    EXPECT_EQ(network.cycle, std::chrono::milliseconds{1});
    ASSERT_EQ(network.listed.frames.size(), 1U);
    std::vector<Kind> kinds;
    for (const auto& command : network.listed.frames[0]) kinds.push_back(command.kind);
    EXPECT_THAT(kinds, ElementsAre(Kind::ReferenceTime, Kind::MailboxStates, Kind::ProcessData,
                                   Kind::ProcessData, Kind::ProcessData, Kind::AlStatus));
    const auto& drives = network.listed.frames[0][2];
    EXPECT_EQ(drives.address, 0x01000000U);
    EXPECT_EQ(drives.length, 102);
    EXPECT_EQ(drives.workingCounter, 12);
    EXPECT_FALSE(drives.inPreOp);
    EXPECT_TRUE(drives.inSafeOp);
}

TEST(EniReader, GivesTheVariablesOfTheProcessImage) {
    const EniNetwork network = sample();
    ASSERT_FALSE(network.outputs.empty());
    EXPECT_EQ(network.outputs[0].name, "Drive 1 (CD300E).RxPDO 1.Controlword");
    EXPECT_EQ(network.outputs[0].bits, 16U);
    EXPECT_EQ(network.outputs[0].firstBit, network.slaves[0].listed.outputs.firstBit);
    EXPECT_EQ(network.inputs.back().name, "Term 5 (DIO8).Inputs.Input 8");
}

/// One text of the good file exchanged, and what must be said about it.
struct BadEni {
    const char* name;
    const char* from;
    const char* to;
    const char* told;  ///< part of the message
    int linesOn{0};    ///< the message names a line so far behind the change: where its element is
};

std::ostream& operator<<(std::ostream& stream, const BadEni& bad) {
    return stream << bad.name;
}

class EniFault : public testing::TestWithParam<BadEni> {};

TEST_P(EniFault, IsToldWithItsLine) {
    const BadEni& bad = GetParam();
    std::string text = readAll(Sample);
    const std::size_t at = text.find(bad.from);
    ASSERT_NE(at, std::string::npos) << "the sample no longer has " << bad.from;
    const int line = lineOf(text, at) + bad.linesOn;
    text.replace(at, std::string_view{bad.from}.size(), bad.to);
    const ScratchFolder folder;
    Diagnostics diagnostics;
    EXPECT_FALSE(readEni(folder.write("bad.eni.xml", text), diagnostics));
    const std::string told = format(diagnostics);
    EXPECT_THAT(told, HasSubstr("bad.eni.xml:" + std::to_string(line) + ": error:"));
    EXPECT_THAT(told, HasSubstr(bad.told));
}

INSTANTIATE_TEST_SUITE_P(
    All, EniFault,
    testing::Values(
        BadEni{"AnotherRoot", "<EtherCATConfig ", "<EtherCATInfo ", "error"},
        BadEni{"NoTransition", "<Transition>IP</Transition>", "", "no <Transition>", -1},
        BadEni{"UnknownTransition", "<Transition>IP</Transition>", "<Transition>PO</Transition>",
               "'PO' is no transition"},
        BadEni{"UnknownCommand", "<Cmd>8</Cmd><Adp>0</Adp><Ado>288</Ado>",
               "<Cmd>15</Cmd><Adp>0</Adp><Ado>288</Ado>", "no <Cmd>", -4},
        BadEni{"NoRegister", "<Adp>0</Adp><Ado>288</Ado>", "<Adp>0</Adp>", "no <Ado>", -4},
        BadEni{"DataThatIsNotHex", "<Data>1100</Data>", "<Data>11G0</Data>", "not hexBinary"},
        BadEni{"NoData", "<Data>1100</Data>", "", "carries no data", -5},
        BadEni{"DataOutsideTheMask", "<Data>0100</Data><DataMask>0F00</DataMask>",
               "<Data>2100</Data><DataMask>0F00</DataMask>", "never come true"},
        BadEni{"MaskOfAnotherLength", "<DataMask>0F00</DataMask>", "<DataMask>0F</DataMask>",
               "do not fit together"},
        BadEni{"NoStation", "<PhysAddr>1001</PhysAddr>", "<PhysAddr>0</PhysAddr>",
               "no station address", -2},
        BadEni{"StationOfAnother", "<PhysAddr>1002</PhysAddr>", "<PhysAddr>1001</PhysAddr>",
               "station address 1001 of 'Drive 1", -2},
        BadEni{"WrongOrder", "<AutoIncAddr>65535</AutoIncAddr>", "<AutoIncAddr>65534</AutoIncAddr>",
               "slaves in frame order"},
        BadEni{"NoVendor", "<VendorId>4294905043</VendorId>", "", "no <VendorId>", -3},
        BadEni{"IdentityAgainstItsCheck", "<ProductCode>12779744</ProductCode>",
               "<ProductCode>12779745</ProductCode>", "wants 0x00c300e0", -3},
        BadEni{"CommandToAnotherSlave", "<Cmd>5</Cmd><Adp>1001</Adp><Ado>1024</Ado>",
               "<Cmd>5</Cmd><Adp>1002</Adp><Ado>1024</Ado>", "goes to <Adp> 1002", -3},
        BadEni{"NoWayToOp", "<Data>0800</Data>", "<Data>0400</Data>", "no init command of SO",
               -236},
        BadEni{"WatchdogOff", "<Data>E803</Data>", "<Data>0000</Data>", "watchdog is off", -4},
        BadEni{"Sync0CycleAgainstDc", "<CycleTime0>1000000</CycleTime0>",
               "<CycleTime0>2000000</CycleTime0>", "<CycleTime0> is 2000000 ns", -194},
        BadEni{"CoeThatReadsWithData", "<Ccs>1</Ccs>", "<Ccs>2</Ccs>", "not clear whether"},
        BadEni{"CoeWithoutData", "<Data>00</Data></InitCmd>", "</InitCmd>", "what to write where"},
        BadEni{"MailboxOutsideTheRam", "<Send><Start>4096</Start>", "<Send><Start>16</Start>",
               "no place in the device"},
        BadEni{"PdoThatIsNotThere", "<Pdo>5632</Pdo>", "<Pdo>5633</Pdo>", "is not defined"},
        BadEni{"ShareOutsideTheImage", "<Send><BitStart>", "<Send><BitStart>99",
               "of the process image"},
        BadEni{"ProcessDataWithoutCounter", "<DataLength>102</DataLength><Cnt>12</Cnt>",
               "<DataLength>102</DataLength>", "without <Cnt>", -3},
        BadEni{"WrongCounter", "<DataLength>102</DataLength><Cnt>12</Cnt>",
               "<DataLength>102</DataLength><Cnt>9</Cnt>", "FMMUs of the init commands give 12",
               -3},
        BadEni{"NothingCarriesAnFmmu", "<Addr>16777216</Addr><DataLength>102</DataLength>",
               "<Addr>16777216</Addr><DataLength>90</DataLength>", "no cyclic command carries",
               -438},
        BadEni{"OffsetBeyondTheImage", "<InputOffs>55</InputOffs>", "<InputOffs>9955</InputOffs>",
               "beyond the inputs", -4},
        BadEni{"RegisterWritesInTheCycle", "<Cmd>7</Cmd><Adp>0</Adp><Ado>304</Ado><DataLength>",
               "<Cmd>8</Cmd><Adp>0</Adp><Ado>304</Ado><DataLength>", "writes registers", -3},
        BadEni{"UnknownState", "<State>PREOP</State>", "<State>PREP</State>", "'PREP' is no state"},
        BadEni{"NoReferenceTime", "<Cmd>13</Cmd><Adp>0</Adp><Ado>2320</Ado>",
               "<Cmd>0</Cmd><Adp>0</Adp><Ado>2320</Ado>", "hand the time", -6},
        BadEni{"NoCycleTime", "<CycleTime>1000</CycleTime>", "", "no <CycleTime>", -1},
        BadEni{"VariableOutsideTheImage", "<BitSize>16</BitSize><BitOffs>",
               "<BitSize>16</BitSize><BitOffs>99", "outside the process image"}),
    [](const auto& bad) { return bad.param.name; });

class EniMachine : public testing::Test {
protected:
    EniMachine() {
        std::filesystem::create_directory_symlink(TAKT_SOURCE_DIR "/samples/devices",
                                                  folder_.path() / "devices");
        folder_.write("line.eni.xml", readAll(Sample));
        folder_.write("libline.so", "not looked into");
        text_ = readAll(TAKT_SOURCE_DIR "/samples/06_eni/machine.xml");
        for (std::size_t at = 0; (at = text_.find("../devices")) != std::string::npos;) {
            text_.replace(at, 3, "");
        }
    }
    LoadResult loadWith(const std::string& from, const std::string& to) {
        const std::size_t at = text_.find(from);
        EXPECT_NE(at, std::string::npos) << "the sample no longer has " << from;
        line_ = lineOf(text_, at);
        text_.replace(at, from.size(), to);
        return loadMachine(folder_.write("machine.xml", text_));
    }
    [[nodiscard]] std::string changedLine() const {
        return "machine.xml:" + std::to_string(line_) + ": error:";
    }

private:
    ScratchFolder folder_;
    std::string text_;
    int line_{0};
};

TEST_F(EniMachine, TakesSlavesCycleAndCommandsFromTheNetworkFile) {
    const LoadResult result = loadWith("line", "line");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    const MachineConfig& machine = *result.machine;
    ASSERT_EQ(machine.network.slaves.size(), 5U);
    EXPECT_TRUE(machine.network.listed);
    EXPECT_EQ(machine.scheduler.cycle, std::chrono::milliseconds{1});
    EXPECT_THAT(machine.network.slaves[1].origin, HasSubstr("line.eni.xml:"));
    EXPECT_EQ(machine.axes[0].drive.profile, "cd300e") << "by the type in the name";
    EXPECT_EQ(machine.axes[2].drive.profile, "ra");
    EXPECT_EQ(machine.axes[3].drive.profile, "generic");
}

TEST_F(EniMachine, BindsAnAxisToVariables) {
    const LoadResult result = loadWith("line", "line");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    const axis::DriveBindings& bound = result.machine->axes[3].drive.bound;
    EXPECT_EQ(bound.controlword.bitOffset, 0U);
    EXPECT_EQ(bound.targetPosition.bitOffset, 16U);
    EXPECT_EQ(bound.targetPosition.bitLength, 32);
    EXPECT_EQ(bound.actualPosition.bitOffset, 16U);
    EXPECT_FALSE(bound.errorCode.present()) << "found by its object";
}

TEST_F(EniMachine, BuildsTheTwinFromTheEsiFileWhereThereIsOne) {
    const LoadResult result = loadWith("line", "line");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    EXPECT_THAT(result.machine->twinDevices[0]->source, HasSubstr("cd300e.xml"));
    EXPECT_THAT(result.machine->twinDevices[3]->source, HasSubstr("line.eni.xml"));
}

TEST_F(EniMachine, WritesTheObjectsOfAnAxisBehindTheListedOnes) {
    const LoadResult result = loadWith("line", "line");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    for (const std::size_t slave : {0U, 2U, 3U}) {
        const auto& startup = result.machine->network.slaves[slave].startup;
        EXPECT_TRUE(std::any_of(startup.begin(), startup.end(),
                                [](const auto& object) { return object.index == 0x6098; }))
            << "homing method of slave " << slave;
    }
}

TEST_F(EniMachine, NamesTheVariablesThatThereAre) {
    const LoadResult result = loadWith("RxPDO 1.Controlword\"", "RxPDO 1.Control word\"");
    EXPECT_FALSE(result.machine);
    const std::string told = format(result.diagnostics);
    EXPECT_THAT(told, HasSubstr(changedLine()));
    EXPECT_THAT(told, HasSubstr("did you mean 'Drive 4 (Servo402).RxPDO 1.Controlword'?"));
    EXPECT_THAT(told, HasSubstr("Drive 4 (Servo402).RxPDO 1.Target position"));
}

TEST_F(EniMachine, RefusesAVariableOfAnotherSlave) {
    const LoadResult result =
        loadWith("controlword=\"Drive 4 (Servo402).RxPDO", "controlword=\"Drive 1 (CD300E).RxPDO");
    EXPECT_FALSE(result.machine);
    EXPECT_THAT(format(result.diagnostics), HasSubstr(changedLine()));
    EXPECT_THAT(format(result.diagnostics), HasSubstr("does not belong to the slave"));
}

TEST_F(EniMachine, RefusesAVariableOfTheWrongSize) {
    const LoadResult result = loadWith("RxPDO 1.Target position\"", "RxPDO 1.Controlword\"");
    EXPECT_FALSE(result.machine);
    EXPECT_THAT(format(result.diagnostics), HasSubstr("has 16 bits; allowed: 32 bits"));
}

TEST_F(EniMachine, RefusesSlavesBesideTheNetworkFile) {
    const LoadResult result =
        loadWith("  </Network>", "<Slave name=\"x\" device=\"CD300E\"/></Network>");
    EXPECT_FALSE(result.machine);
    EXPECT_THAT(format(result.diagnostics), HasSubstr(changedLine()));
}

TEST_F(EniMachine, RefusesAnotherCycle) {
    const LoadResult result = loadWith("lostFrames=\"3\"", "lostFrames=\"3\" cycle=\"2 ms\"");
    EXPECT_FALSE(result.machine);
    EXPECT_THAT(format(result.diagnostics), HasSubstr("1000 us in the network file"));
}

TEST_F(EniMachine, SaysOnceThatTheNetworkFileIsNotThere) {
    const LoadResult result = loadWith("line.eni.xml", "lane.eni.xml");
    EXPECT_FALSE(result.machine);
    EXPECT_EQ(result.diagnostics.errorCount(), 1U) << format(result.diagnostics);
    EXPECT_THAT(format(result.diagnostics), HasSubstr(changedLine()));
}

TEST_F(EniMachine, RefusesToBindWithoutANetworkFile) {
    const ScratchFolder folder;
    const LoadResult result = loadMachine(folder.write("machine.xml", R"(<Machine name="m">
<Network><Esi file=")" TAKT_SOURCE_DIR R"(/samples/devices/cd300e.xml"/>
<Slave name="x" device="CD300E"/></Network>
<Axis name="X" unit="mm"><Drive slave="x">
<Bind controlword="Controlword"/></Drive>
<Scaling perTurn="10 mm"/><Limits velocity="300 mm/s" acceleration="2000 mm/s^2"/></Axis>
</Machine>)"));
    EXPECT_FALSE(result.machine);
    EXPECT_THAT(format(result.diagnostics), HasSubstr("machine.xml:5: error:"));
    EXPECT_THAT(format(result.diagnostics), HasSubstr("no variables to bind to"));
}

}  // namespace
}  // namespace takt::config::test
