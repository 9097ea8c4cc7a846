#include <algorithm>
#include <filesystem>

#include "segment_test.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

const std::string sourceFolder = TAKT_SOURCE_DIR;

#ifdef __SANITIZE_THREAD__
constexpr int SanitizersThreads = 1;  // begun before the program, which knows nothing of it
#else
constexpr int SanitizersThreads = 0;
#endif

class Interface : public SegmentTest {
protected:
    /// Nothing but one line, and exit code 2.
    void expectOneLine(const std::string& what) {
        EXPECT_THAT(linesWith(result_.output, ""), SizeIs(2)) << result_.output;
        EXPECT_THAT(result_.output, HasSubstr(what));
        EXPECT_THAT(result_.output, HasSubstr("run exit 2"));
    }
    /// By `scan` and `slaves`, which look at a network before a machine runs on it.
    void expectTheDeviceListed() {
        const auto scanned = linesWith(result_.output, "scan:");
        ASSERT_THAT(scanned, SizeIs(1)) << result_.output;
        // 0xFFFF0CD3, 0x00C300E0, 0x00010002 of the device file.
        EXPECT_THAT(scanned[0], HasSubstr(R"("pos":0,"name":"","type":"CD300E")"));
        EXPECT_THAT(scanned[0],
                    HasSubstr(R"("vendor":4294905043,"product":12779744,"revision":65538)"));
        EXPECT_THAT(scanned[0], HasSubstr(R"("dc":true,"coe":true,"ports":"0")"));
        const auto listed = linesWith(result_.output, "slaves:");
        ASSERT_THAT(listed, SizeIs(3)) << result_.output;
        EXPECT_THAT(listed[0], HasSubstr(R"("pos":0,"address":1001,"alias":0)"));
        EXPECT_THAT(listed[0], HasSubstr(R"("state":"INIT","error":false,"alStatusCode":0)"));
        EXPECT_THAT(listed[2], testing::ContainsRegex("0 +1001 +0 +- +PREOP +CD300E"));
        for (const char* verb : {"scan exit", "states exit", "slaves exit"}) {
            const auto exits = linesWith(result_.output, verb);
            EXPECT_THAT(exits, testing::Each(HasSubstr("exit 0"))) << result_.output;
        }
    }
    void expectBothMovesDone() {
        EXPECT_THAT(result_.output, HasSubstr("run exit 0"));
        EXPECT_THAT(result_.output, HasSubstr("network in OP"));
        EXPECT_THAT(result_.output, HasSubstr("sim exit 0"));
        expectTakenDown();
        // 12.5 mm of 20 mm in a turn; the drive holds a count of a 10000th of a turn.
        const auto ends = linesWith(result_.output, "motor at ");
        ASSERT_THAT(ends, SizeIs(1)) << result_.output;
        EXPECT_NEAR(std::stod(ends[0].substr(ends[0].find("motor at ") + 9)), 0.625, 0.01);
        expectSmoothTrace();
    }
};

TEST_F(Interface, ScansListsRunsAndTakesAMachineDownAgain) {
    play("moves");
    expectTheDeviceListed();
    expectBothMovesDone();
}

/// The machine of the network file sample in a folder of its own, one text of the network file
/// exchanged.
std::string listedMachine(const std::string& folder, const std::string& from,
                          const std::string& to) {
    const std::string sample = sourceFolder + "/samples/06_eni/";
    std::string machine = readFile(sample + "machine.xml");
    std::string eni = readFile(sample + "line.eni.xml");
    for (std::size_t at = 0; (at = machine.find("../devices/", at)) != std::string::npos;) {
        machine.replace(at, 3, sourceFolder + "/samples/");
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

TEST_F(Interface, DoesAllThisWithThreeCapabilities) {
    play("moves_with_three_capabilities");
    expectTheDeviceListed();
    expectBothMovesDone();
}

TEST_F(Interface, GivesItsCapabilitiesUpAfterTheStart) {
    play("gives_up_capabilities");
    EXPECT_THAT(result_.output, HasSubstr("network in OP"));
    EXPECT_THAT(result_.output, HasSubstr("run exit 130"));
    const auto left = linesWith(result_.output, "left over:");
    EXPECT_GE(left.size(), 3U) << "the cycle, the program, the house";
    const auto withRights = std::count_if(left.begin(), left.end(), [](const std::string& line) {
        return line != "left over: CapPrm:\t0000000000000000 CapEff:\t0000000000000000 ";
    });
    EXPECT_EQ(withRights, SanitizersThreads) << result_.output;
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
    play("other_machine", {sourceFolder + "/samples/03_gantry/machine.xml"});
    EXPECT_THAT(result_.output, HasSubstr("run exit 2"));
    EXPECT_THAT(result_.output, Not(HasSubstr("drive Operation enabled")));
}

TEST_F(Interface, KeepsTheBusInOpWhenAProgramDoesNotComeBack) {
    play("hangs");
    EXPECT_THAT(result_.output, HasSubstr("run exit 4"));
    EXPECT_THAT(linesWith(result_.output, "program 'hangs' in cycle"), SizeIs(1)) << result_.output;
    EXPECT_THAT(result_.output, HasSubstr("was abandoned; its axes stop on their path"));
    // Down in order, no watchdog, and no motion left.
    expectTakenDown();
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
        {"run", sourceFolder + "/tests/rt/machine.xml", "--interface", "bus0", "--fast"}, folder_);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.output, HasSubstr("--fast"));
}

}  // namespace
}  // namespace takt::test
