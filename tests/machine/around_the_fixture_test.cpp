#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

const std::string Source = TAKT_SOURCE_DIR;
const std::string Folder = Source + "/samples/05_around_the_fixture";
const std::string Machine = Folder + "/machine.xml";

class FixtureRun : public testing::Test {
protected:
    void SetUp() override {
        folder = freshFolder(std::string{"fixture_"} +
                             testing::UnitTest::GetInstance()->current_test_info()->name());
    }
    [[nodiscard]] ProcessResult runIt(const std::string& trace) const {
        return runTakt({"run", Machine, "--fast", "--trace", trace, "--top-view", "a.svg"}, folder);
    }
    [[nodiscard]] ProcessResult judge(const std::vector<std::string>& more) const {
        std::vector<std::string> command{
            "python3", "-B", Source + "/tests/machine/keep_outs.py", "a.csv", "--machine", Machine};
        command.insert(command.end(), more.begin(), more.end());
        return runCommand(command, folder);
    }
    std::string folder;
};

TEST_F(FixtureRun, KeepsClearOfEverythingInEveryCycle) {
    const ProcessResult run = runIt("a.csv");
    ASSERT_EQ(run.exitCode, 0) << run.output;
    const ProcessResult judged = judge({});
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
    EXPECT_THAT(judged.output, HasSubstr("cycles in motion"));
}

TEST_F(FixtureRun, IsJudgedByAJudgeThatFindsTenOfTenBadTraces) {
    ASSERT_EQ(runIt("a.csv").exitCode, 0);
    const ProcessResult judged = judge({"--selftest"});
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
    EXPECT_THAT(judged.output, HasSubstr("10 of 10"));
}

TEST_F(FixtureRun, LeavesTheSameTraceByteForByteWhenRunAgain) {
    ASSERT_EQ(runIt("a.csv").exitCode, 0);
    ASSERT_EQ(runIt("b.csv").exitCode, 0);
    const std::string first = readFile(folder + "/a.csv");
    EXPECT_GT(first.size(), 100000U);
    EXPECT_TRUE(first == readFile(folder + "/b.csv"));
}

TEST_F(FixtureRun, ShowsTheTopViewOfARunOfToday) {
    ASSERT_EQ(runIt("a.csv").exitCode, 0);
    EXPECT_TRUE(readFile(Folder + "/top_view.svg") == readFile(folder + "/a.svg"))
        << "draw it anew with scripts/plots";
}

}  // namespace
}  // namespace takt::test
