#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

const std::string Source = TAKT_SOURCE_DIR;
const std::string Machine = Source + "/samples/03_gantry/machine.xml";

/// One run of the sample with all outputs on, shared by the rules below.
class GantryRun : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder = freshFolder("gantry");
        result = runTakt({"run", Machine, "--fast", "--trace", "a.csv", "--plot", "a.svg", "--pcap", "a.pcapng"},
                         folder);
    }
    static ProcessResult python(const std::vector<std::string>& arguments) {
        std::vector<std::string> command{"python3"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        return runCommand(command, folder);
    }
    static inline std::string folder;
    static inline ProcessResult result;
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
    const auto judged = python({Source + "/tests/machine/continuity.py", "a.csv", "--machine", Machine});
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
}

TEST_F(GantryRun, PutsNoMalformedFrameOnTheWire) {
    const auto malformed = runCommand({"tshark", "-r", "a.pcapng", "-Y", "_ws.malformed"}, folder);
    EXPECT_EQ(malformed.exitCode, 0) << malformed.output;
    EXPECT_EQ(malformed.output.find("ECAT"), std::string::npos) << malformed.output.substr(0, 2000);
}

TEST_F(GantryRun, GetsTheWorkingCountersThatTheMachineFileForetells) {
    const auto judged = python({Source + "/tests/machine/working_counters.py", "a.pcapng", Machine});
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
}

TEST_F(GantryRun, DrawsAPlot) {
    const std::string plot = readFile(folder + "/a.svg");
    EXPECT_THAT(plot, HasSubstr("<svg"));
    EXPECT_THAT(plot, HasSubstr("</svg>"));
}

}  // namespace
}  // namespace takt::test
