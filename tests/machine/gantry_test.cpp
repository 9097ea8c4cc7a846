#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

const std::string Source = TAKT_SOURCE_DIR;
const std::string Machine = Source + "/samples/03_gantry/machine.xml";

/// One run of the sample with all outputs on, in a folder of its own for each rule: they run side
/// by side.
class GantryRun : public testing::Test {
protected:
    void SetUp() override {
        folder = freshFolder(std::string{"gantry_"} +
                             testing::UnitTest::GetInstance()->current_test_info()->name());
        result = runTakt(
            {"run", Machine, "--fast", "--trace", "a.csv", "--plot", "a.svg", "--pcap", "a.pcapng"},
            folder);
    }
    [[nodiscard]] ProcessResult python(const std::vector<std::string>& arguments) const {
        std::vector<std::string> command{"python3"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        return runCommand(command, folder);
    }
    std::string folder;
    ProcessResult result;
};

TEST_F(GantryRun, EndsWellWithoutLosingAFrame) {
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("finished"));
    EXPECT_THAT(result.output, HasSubstr(" 0 lost, 0 late; working counter errors 0"));
}

TEST_F(GantryRun, LeavesTheSameTraceByteForByteWhenRunAgain) {
    const auto again = runTakt({"run", Machine, "--fast", "--trace", "b.csv", "--quiet"}, folder);
    ASSERT_EQ(again.exitCode, 0) << again.output;
    const std::string first = readFile(folder + "/a.csv");
    EXPECT_GT(first.size(), 100000U);
    EXPECT_TRUE(first == readFile(folder + "/b.csv"));
}

TEST_F(GantryRun, KeepsTheLimitsOfEveryAxisInEveryCycle) {
    const auto judged =
        python({Source + "/tests/machine/continuity.py", "a.csv", "--machine", Machine});
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
}

TEST_F(GantryRun, PutsNoMalformedFrameOnTheWire) {
    const auto malformed = runCommand({"tshark", "-r", "a.pcapng", "-Y", "_ws.malformed"}, folder);
    EXPECT_EQ(malformed.exitCode, 0) << malformed.output;
    EXPECT_EQ(malformed.output.find("ECAT"), std::string::npos) << malformed.output.substr(0, 2000);
}

TEST_F(GantryRun, CapturesEveryFrameTwiceAndNothingElse) {
    const auto all = runCommand(
        {"sh", "-c", "tshark -r a.pcapng -Y ecat -T fields -e frame.number 2>/dev/null | wc -l"},
        folder);
    EXPECT_THAT(result.output,
                HasSubstr("capture: " + std::to_string(std::stoul(all.output)) + " frames"));
    const auto sent =
        runCommand({"sh", "-c",
                    "tshark -r a.pcapng -Y 'ecat and frame.packet_flags_direction == 2' -T fields "
                    "-e frame.number 2>/dev/null | wc -l"},
                   folder);
    EXPECT_GT(std::stoul(sent.output), 10000U);
    EXPECT_EQ(std::stoul(all.output), 2 * std::stoul(sent.output));
}

TEST_F(GantryRun, IsWatchedByTheTrapInEveryCycle) {
    if (readFile(std::string{TAKT_BINARY_DIR} + "/libtakt_trap.so").empty()) {
        SUCCEED() << "the sanitizers of this build replace what the trap watches";
        return;
    }
    // One arming a cycle, one more after each pause in the memory link and after each program call.
    const auto watched =
        runTakt({"run", Machine, "--fast", "--quiet"}, folder, {"TAKT_TRAP_REPORT=trap.txt"});
    ASSERT_EQ(watched.exitCode, 0) << watched.output;
    const std::string report = readFile(folder + "/trap.txt");
    EXPECT_THAT(report, HasSubstr("no hit"));
    EXPECT_GT(std::stoul(report.substr(report.find(' ') + 1)), 16000U) << report;
}

TEST_F(GantryRun, GetsTheWorkingCountersThatTheMachineFileForetells) {
    const auto judged =
        python({Source + "/tests/machine/working_counters.py", "a.pcapng", Machine});
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
}

TEST_F(GantryRun, DrawsAPlot) {
    const std::string plot = readFile(folder + "/a.svg");
    EXPECT_THAT(plot, HasSubstr("<svg"));
    EXPECT_THAT(plot, HasSubstr("</svg>"));
}

}  // namespace
}  // namespace takt::test
