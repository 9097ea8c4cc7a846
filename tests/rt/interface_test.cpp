#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "namespaces.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

const std::string Source = TAKT_SOURCE_DIR;

/// Two namespaces, a veth pair between them, the simulated machine on its far end. States,
/// identities and positions are judged, never times.
class Interface : public testing::Test {
protected:
    void SetUp() override {
        const std::string forbidden = namespacesForbidden();
        ASSERT_EQ(forbidden, "");
        folder_ = freshFolder(std::string{"interface_"} +
                              testing::UnitTest::GetInstance()->current_test_info()->name());
    }
    void play(const std::string& scenario, const std::vector<std::string>& more = {}) {
        result_ = inNamespaces(scenario, folder_, more);
    }
    /// Nothing but one line, and exit code 2.
    void expectOneLine(const std::string& what) {
        EXPECT_THAT(linesWith(result_.output, ""), SizeIs(2)) << result_.output;
        EXPECT_THAT(result_.output, HasSubstr(what));
        EXPECT_THAT(result_.output, HasSubstr("run exit 2"));
    }
    void expectSmoothTrace() {
        const auto judged = runCommand({"python3", Source + "/tests/machine/continuity.py",
                                        "trace.csv", "--machine", Source + "/tests/rt/machine.xml"},
                                       folder_);
        EXPECT_EQ(judged.exitCode, 0) << judged.output;
    }

    std::string folder_;
    ProcessResult result_;
};

TEST_F(Interface, RunsAMachineAndTakesItDownAgain) {
    play("moves");
    EXPECT_THAT(result_.output, HasSubstr("run exit 0"));
    EXPECT_THAT(result_.output, HasSubstr("network in OP"));
    EXPECT_THAT(result_.output, HasSubstr("sim exit 0"));
    // 12.5 mm of 20 mm in a turn; the drive holds a count of a 10000th of a turn.
    const auto ends = linesWith(result_.output, "end: x:");
    ASSERT_THAT(ends, SizeIs(1)) << result_.output;
    EXPECT_THAT(ends[0], HasSubstr("x: INIT, drive Switch on disabled"));
    const std::size_t at = ends[0].find("motor at ");
    ASSERT_NE(at, std::string::npos);
    EXPECT_NEAR(std::stod(ends[0].substr(at + 9)), 0.625, 0.01);
    EXPECT_THAT(linesWith(result_.output, "sim:"), Not(testing::Contains(HasSubstr("with error"))));
    expectSmoothTrace();
}

/// The machine of the network file sample in a folder of its own, one text of the network file
/// exchanged.
std::string listedMachine(const std::string& folder, const std::string& from,
                          const std::string& to) {
    const std::string sample = Source + "/samples/06_eni/";
    std::string machine = readFile(sample + "machine.xml");
    std::string eni = readFile(sample + "line.eni.xml");
    for (std::size_t at = 0; (at = machine.find("../devices/", at)) != std::string::npos;) {
        machine.replace(at, 3, Source + "/samples/");
    }
    for (std::size_t at = 0; !from.empty() && (at = eni.find(from, at)) != std::string::npos;) {
        eni.replace(at, from.size(), to);
    }
    std::filesystem::create_directories(folder);
    writeFile(folder + "/machine.xml", machine);
    writeFile(folder + "/line.eni.xml", eni);
    return folder + "/machine.xml";
}

TEST_F(Interface, RefusesADeviceThatIsNotTheOneOfTheNetworkFile) {
    const std::string there = listedMachine(folder_ + "/there", "", "");
    // The revision of the two CD300E, which no init command checks.
    const std::string wanted =
        listedMachine(folder_ + "/wanted", "<RevisionNo>65538<", "<RevisionNo>65539<");
    play("network_file", {there, wanted});
    EXPECT_THAT(result_.output, HasSubstr("run exit 2"));
    EXPECT_THAT(result_.output,
                HasSubstr("line.eni.xml:103: slave 0 'Drive 1 (CD300E)': expected revision "
                          "0x00010003, found 0x00010002; check the network file"));
}

TEST_F(Interface, RunsWithThreeCapabilitiesAndGivesThemUpAfterTheStart) {
    play("three_capabilities");
    EXPECT_THAT(result_.output, HasSubstr("network in OP"));
    EXPECT_THAT(result_.output, HasSubstr("run exit 130"));
    const auto left = linesWith(result_.output, "left over:");
    EXPECT_GE(left.size(), 3U) << "the cycle, the program, the house";
    for (const std::string& line : left) {
        EXPECT_THAT(line, testing::MatchesRegex(
                              "left over: CapPrm:.0000000000000000 CapEff:.0000000000000000 "));
    }
    EXPECT_THAT(result_.output, HasSubstr("end: x: INIT, drive Switch on disabled"));
}

TEST_F(Interface, NamesTheCapabilityThatIsMissing) {
    play("missing_capability");
    expectOneLine(
        "interface 'bus0': no permission to open a raw socket; takt needs the capability "
        "CAP_NET_RAW");
}

TEST_F(Interface, SaysThatItIsDown) {
    play("down");
    expectOneLine("interface 'bus0': is down; do: ip link set bus0 up");
}

TEST_F(Interface, SaysThatItDoesNotExist) {
    play("not_there");
    expectOneLine("interface 'bus0': does not exist");
}

TEST_F(Interface, SaysThatAnotherTaktOwnsIt) {
    play("owned");
    EXPECT_THAT(linesWith(result_.output, "interface 'bus0': is owned by another takt"), SizeIs(1))
        << result_.output;
    EXPECT_THAT(result_.output, HasSubstr("run exit 2"));
    EXPECT_THAT(result_.output, HasSubstr("sim exit 0"));
}

TEST_F(Interface, RefusesAnotherMachineThanTheConfiguredOne) {
    play("other_machine", {Source + "/samples/03_gantry/machine.xml"});
    EXPECT_THAT(result_.output, HasSubstr("run exit 2"));
    EXPECT_THAT(result_.output, Not(HasSubstr("drive Operation enabled")));
}

TEST_F(Interface, KeepsTheBusInOpWhenAProgramDoesNotComeBack) {
    play("hangs");
    EXPECT_THAT(result_.output, HasSubstr("run exit 4"));
    EXPECT_THAT(linesWith(result_.output, "program 'hangs' in cycle"), SizeIs(1)) << result_.output;
    EXPECT_THAT(result_.output, HasSubstr("was abandoned; its axes stop on their path"));
    // Down in order, no watchdog, and no motion left.
    EXPECT_THAT(linesWith(result_.output, "sim:"), Not(testing::Contains(HasSubstr("with error"))));
    EXPECT_THAT(result_.output, HasSubstr("end: x: INIT, drive Switch on disabled"));
    const std::string trace = readFile(folder_ + "/trace.csv");
    EXPECT_THAT(trace, HasSubstr("ContinuousMotion"));
    EXPECT_THAT(trace, Not(HasSubstr("ErrorStop")));
    expectSmoothTrace();
}

TEST_F(Interface, LeavesTheDrivesSafeByTheirWatchdogWhenKilled) {
    play("killed");
    const auto ends = linesWith(result_.output, "end: x:");
    ASSERT_THAT(ends, SizeIs(1)) << result_.output;
    EXPECT_THAT(ends[0], HasSubstr("AL status 0x001B"));
    EXPECT_THAT(ends[0], Not(HasSubstr("drive Operation enabled")));
    EXPECT_THAT(ends[0], HasSubstr(" 0.000 turns/s"));
}

TEST_F(Interface, IsRefusedTogetherWithFast) {
    const auto result = runTakt(
        {"run", Source + "/tests/rt/machine.xml", "--interface", "bus0", "--fast"}, folder_);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.output, HasSubstr("--fast"));
}

}  // namespace
}  // namespace takt::test
