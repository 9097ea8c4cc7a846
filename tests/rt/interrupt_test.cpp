#include "segment_test.hpp"
#include "trace_file.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

/// CiA 402: bits of a statusword that tell the state, and Operation enabled.
constexpr unsigned StateMask = 0x6FU;
constexpr unsigned OperationEnabled = 0x27U;

unsigned wordAt(const TraceFile& trace, std::size_t row, const char* column) {
    return static_cast<unsigned>(std::strtoul(trace.at(row, column).c_str(), nullptr, 0));
}

/// ^C on a real network, on the monotonic clock, with the program on a thread of its own.
class InterruptOnInterface : public SegmentTest, public testing::WithParamInterface<const char*> {
protected:
    void interrupt(const std::string& phase, const std::string& signals) {
        play("interrupt", {phase, signals});
        // Of two at once either one may be the first.
        const char* const exits = signals == "1" ? "run exit 130" : "run exit 1(30|43)";
        EXPECT_THAT(result_.output, testing::ContainsRegex(exits));
        expectTakenDown();
        const TraceFile trace{folder_ + "/trace.csv"};
        ASSERT_GT(trace.size(), 0U);
        EXPECT_EQ(trace.last("X.state"), "Disabled");
        EXPECT_NE(wordAt(trace, trace.size() - 1, "X.statusword") & StateMask, OperationEnabled);
        EXPECT_FALSE(trace.everWas("X.state", "ErrorStop"));
        // No axis follows set-points before it is on, nor while the drive homes by itself.
        if (phase != "enable" && phase != "homing") expectSmoothTrace();
    }
};

TEST_P(InterruptOnInterface, StopsTheAxisWithinItsLimitsAndTakesTheBusDown) {
    interrupt(GetParam(), "1");
}

INSTANTIATE_TEST_SUITE_P(InEveryPhase, InterruptOnInterface,
                         testing::Values("enable", "homing", "acceleration", "constant",
                                         "deceleration", "standstill"),
                         [](const auto& phase) { return std::string{phase.param}; });

TEST_F(InterruptOnInterface, BeforeAnythingMovesTakesTheBusDownToo) {
    play("interrupt_start");
    EXPECT_THAT(result_.output, HasSubstr("run exit 130")) << result_.output;
    expectTakenDown();
}

TEST_F(InterruptOnInterface, ASecondOneLetsTheDriveStopByItself) {
    interrupt("constant", "2");
    const TraceFile trace{folder_ + "/trace.csv"};
    // Quick stop: enable voltage without bit 2 (CiA 402 controlword 0x0002).
    bool quick = false;
    for (std::size_t row = 0; row < trace.size(); ++row) {
        const bool running = (wordAt(trace, row, "X.statusword") & StateMask) == OperationEnabled;
        quick = quick || (running && (wordAt(trace, row, "X.controlword") & 0x87U) == 0x02U);
    }
    EXPECT_TRUE(quick);
}

}  // namespace
}  // namespace takt::test
