#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

const std::string Source = TAKT_SOURCE_DIR;
const std::string Machine = Source + "/tests/machine/ways/machine.xml";
const std::string Program = std::string{TAKT_BINARY_DIR} + "/test_programs/ask_for_ways.so";

TEST(Ways, AreRefusedEachForItsReasonInItsCycleAndRunWhereThereIsOne) {
    const std::string folder = freshFolder("ways");
    const ProcessResult run =
        runTakt({"run", Machine, "--fast", "--program", Program, "--trace", "a.csv"}, folder);
    ASSERT_EQ(run.exitCode, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("finished"));
    for (const char* judge : {"keep_outs.py", "continuity.py"}) {
        const ProcessResult judged = runCommand(
            {"python3", "-B", Source + "/tests/machine/" + judge, "a.csv", "--machine", Machine},
            folder);
        EXPECT_EQ(judged.exitCode, 0) << judged.output;
    }
}

}  // namespace
}  // namespace takt::test
