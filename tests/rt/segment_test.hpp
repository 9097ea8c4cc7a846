#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "namespaces.hpp"

namespace takt::test {

/// Two namespaces, a veth pair between them, the simulated machine on its far end. States,
/// identities and positions are judged, never times.
class SegmentTest : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_EQ(namespacesForbidden(), "");
        const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
        std::string name = std::string{test->test_suite_name()} + "_" + test->name();
        std::replace(name.begin(), name.end(), '/', '_');
        folder_ = freshFolder("segment_" + name);
    }
    void play(const std::string& scenario, const std::vector<std::string>& more = {}) {
        result_ = inNamespaces(scenario, folder_, more);
    }
    /// … of the present run, against the limits of the machine file that it ran.
    void expectSmoothTrace() {
        const std::string own = folder_ + "/machine.xml";
        const std::string base = std::string{TAKT_SOURCE_DIR} + "/tests/rt/machine.xml";
        const auto judged =
            runCommand({"python3", std::string{TAKT_SOURCE_DIR} + "/tests/machine/continuity.py",
                        "trace.csv", "--machine", std::filesystem::exists(own) ? own : base},
                       folder_);
        EXPECT_EQ(judged.exitCode, 0) << judged.output;
    }
    /// Down in order, nothing lost on the way.
    void expectTakenDown() {
        const auto ends = linesWith(result_.output, "end: x:");
        ASSERT_THAT(ends, testing::SizeIs(1)) << result_.output;
        EXPECT_THAT(ends[0], testing::HasSubstr("x: INIT, drive Switch on disabled"));
        EXPECT_THAT(ends[0], testing::HasSubstr(" 0.000 turns/s"));
        EXPECT_THAT(linesWith(result_.output, "sim:"),
                    testing::Not(testing::Contains(testing::HasSubstr("with error"))));
    }

    std::string folder_;
    ProcessResult result_;
};

}  // namespace takt::test
