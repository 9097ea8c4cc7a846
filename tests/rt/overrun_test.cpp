#include "segment_test.hpp"
#include "trace_file.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The whole controller is kept from running for more than a hundred cycles (fault F31). Limits are
/// wide, so that a busy computer does not reach them by itself.
class Stalled : public SegmentTest {
protected:
    void stall(const std::string& realtime) {
        play("stalled", {realtime});
        const TraceFile trace{folder_ + "/trace.csv"};
        ASSERT_GT(trace.size(), 0U) << result_.output;
        EXPECT_EQ(trace.last("X.state"), "Disabled");
        expectTakenDown();
        // Whatever was missed, no set-point jumps by it.
        expectSmoothTrace();
    }
};

TEST_F(Stalled, StopsOnPathAfterTooManyMissedCycles) {
    stall(R"(overruns="react" stopAfter="50" driveStopAfter="100000" overrunRate="100 %")");
    EXPECT_THAT(result_.output, HasSubstr("too many cycles missed"));
    EXPECT_THAT(result_.output, HasSubstr("the axes stop on their path"));
    EXPECT_THAT(result_.output, HasSubstr("run exit 3"));
    const TraceFile trace{folder_ + "/trace.csv"};
    EXPECT_FALSE(trace.everWas("X.state", "ErrorStop"));
}

TEST_F(Stalled, LetsTheDrivesStopAfterStillMore) {
    stall(R"(overruns="react" stopAfter="50" driveStopAfter="51" overrunRate="100 %")");
    EXPECT_THAT(result_.output, HasSubstr("the drives stop"));
    EXPECT_THAT(result_.output, HasSubstr("run exit 3"));
}

TEST_F(Stalled, OnlyCountsWhereThatIsAllThatIsAskedFor) {
    stall(R"(overruns="count")");
    EXPECT_THAT(result_.output, Not(HasSubstr("too many cycles missed")));
    EXPECT_THAT(result_.output, HasSubstr("run exit 130")) << "by the signal behind the stall";
    const auto missed = linesWith(result_.output, "missed cycles ");
    ASSERT_EQ(missed.size(), 1U) << result_.output;
    EXPECT_GE(std::stoi(missed[0].substr(missed[0].find("missed cycles ") + 14)), 100);
    const TraceFile trace{folder_ + "/trace.csv"};
    EXPECT_FALSE(trace.everWas("X.state", "ErrorStop"));
}

}  // namespace
}  // namespace takt::test
