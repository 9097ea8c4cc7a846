#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

const std::string Source = TAKT_SOURCE_DIR;
const std::string Contours = Source + "/tests/machine/contour/";
const std::string Machine = Contours + "machine.xml";
const std::string Programs = std::string{TAKT_BINARY_DIR} + "/test_programs/";

ProcessResult python(const std::vector<std::string>& arguments, const std::string& folder) {
    std::vector<std::string> command{"python3", "-B"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return runCommand(command, folder);
}

std::string folderOfTest() {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    return freshFolder(std::string{"contour_"} + test->test_suite_name() + "_" + test->name());
}

/// Runs of the contour machine, each judged from outside.
class Contour : public testing::Test {
protected:
    void run(const std::string& program, const std::vector<std::string>& environment = {},
             const std::string& machine = Machine) {
        result = runTakt({"run", machine, "--fast", "--for", "20s", "--program",
                          Programs + program + ".so", "--trace", "a.csv"},
                         folder, environment);
    }
    [[nodiscard]] ProcessResult judged(const std::string& path,
                                       const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{Source + "/tests/machine/contour.py",
                                           "a.csv",
                                           "--machine",
                                           Machine,
                                           "--path",
                                           Contours + path};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return python(arguments, folder);
    }
    void expectSmooth() const {
        const auto smooth = python(
            {Source + "/tests/machine/continuity.py", "a.csv", "--machine", Machine}, folder);
        EXPECT_EQ(smooth.exitCode, 0) << smooth.output;
    }
    std::string folder{folderOfTest()};
    ProcessResult result;
};

TEST_F(Contour, FourLapsRoundASquareTakeNoMoreThanFourSecondsAndFourTenths) {
    run("square_laps");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const auto verdict = judged("square_laps.path", {"--within", "4.40"});
    EXPECT_EQ(verdict.exitCode, 0) << verdict.output;
    RecordProperty("verdict", verdict.output);
    expectSmooth();
}

TEST_F(Contour, TheJudgeFindsTenOfTenBadTraces) {
    run("square_laps");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    for (const char* seed : {"1", "2", "3"}) {
        const auto found = judged("square_laps.path", {"--selftest", "--seed", seed});
        EXPECT_EQ(found.exitCode, 0) << found.output;
        EXPECT_THAT(found.output, HasSubstr("10 of 10"));
    }
}

TEST_F(Contour, LeavesTheSameTraceByteForByteWhenRunAgain) {
    run("square_laps");
    const std::string first = readFile(folder + "/a.csv");
    EXPECT_GT(first.size(), 100000U);
    run("square_laps");
    EXPECT_TRUE(first == readFile(folder + "/a.csv"));
}

TEST_F(Contour, GoesThroughTheJointOfTwoArcsThatGoOnInOneDirection) {
    run("circle_stops");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const auto verdict = judged("circle_stops.path");
    EXPECT_EQ(verdict.exitCode, 0) << verdict.output;
    expectSmooth();
}

TEST_F(Contour, TheSampleStaysWithinItsDeviationInSpace) {
    const std::string sample = Source + "/samples/04_contour/machine.xml";
    result = runTakt({"run", sample, "--fast", "--trace", "a.csv"}, folder);
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const auto verdict = python({Source + "/tests/machine/contour.py", "a.csv", "--machine", sample,
                                 "--group", "Table", "--path", Contours + "sample.path"},
                                folder);
    EXPECT_EQ(verdict.exitCode, 0) << verdict.output;
}

/// What stops a group half-way round a circle.
class StoppedContour : public Contour, public testing::WithParamInterface<const char*> {};

TEST_P(StoppedContour, StaysOnItsPath) {
    run("circle_stops", {std::string{"TAKT_TEST_CASE="} + GetParam()});
    const bool throws = std::string{GetParam()} == "throw";
    ASSERT_EQ(result.exitCode, throws ? 3 : 0) << result.output;
    const auto verdict = judged("circle_stops.path", {"--stopped"});
    EXPECT_EQ(verdict.exitCode, 0) << verdict.output;
    expectSmooth();
}

INSTANTIATE_TEST_SUITE_P(All, StoppedContour,
                         testing::Values("halt", "stop", "member-stop", "throw"),
                         [](const auto& stop) {
                             std::string name = stop.param;
                             if (const auto dash = name.find('-'); dash != std::string::npos)
                                 name.replace(dash, 1, "_");
                             return name;
                         });

/// X meets something solid at 12 mm: it lags, and the whole group stops on the path.
TEST_F(Contour, AMemberThatIsBlockedStopsTheGroupOnItsPathAndAResetBringsItBack) {
    std::string text = readFile(Machine);
    const std::string plain = R"(<Mechanics start="0 mm" inertia="2 kg cm^2"/></Device>)";
    const std::string blocked = R"(<Mechanics start="0 mm" inertia="2 kg cm^2">
        <HardStops from="-50 mm" to="12 mm"/></Mechanics></Device>)";
    text.replace(text.find(plain), plain.size(), blocked);
    text.replace(text.find("../../../samples"), std::string{"../../../samples"}.size(),
                 Source + "/samples");
    writeFile(folder + "/machine.xml", text);
    run("circle_stops", {"TAKT_TEST_CASE=blocked"}, folder + "/machine.xml");
    ASSERT_EQ(result.exitCode, 0) << result.output;
    const auto verdict = judged("circle_stops.path", {"--stopped"});
    EXPECT_EQ(verdict.exitCode, 0) << verdict.output;
    expectSmooth();
    const std::string trace = readFile(folder + "/a.csv");
    EXPECT_THAT(trace, HasSubstr("GroupErrorStop"));
}

}  // namespace
}  // namespace takt::test
