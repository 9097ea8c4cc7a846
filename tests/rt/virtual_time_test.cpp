#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

TEST(VirtualTime, EndsARunWhoseProgramDoesNotComeBackAndKeepsItsTrace) {
    const std::string folder = freshFolder("virtual_hang");
    const auto result =
        runTakt({"run", std::string{TAKT_SOURCE_DIR} + "/tests/rt/machine.xml", "--fast",
                 "--program", std::string{TAKT_BINARY_DIR} + "/test_programs/hangs.so",
                 "--program-watchdog", "1s", "--trace", "trace.csv"},
                folder);
    EXPECT_EQ(result.exitCode, 4);
    EXPECT_THAT(
        result.output,
        HasSubstr("program 'hangs' did not come back from its call in cycle 162 within 1 s"));
    EXPECT_THAT(readFile(folder + "/trace.csv"), HasSubstr("\n161,"));
}

}  // namespace
}  // namespace takt::test
