#include <gtest/gtest.h>

#include "machine_base.hpp"

namespace takt::config {
namespace {

class RealtimeElement : public test::MachineFile {
protected:
    [[nodiscard]] LoadResult loadRealtime(std::string_view element) {
        return loadWith("  <Twin clock", std::string{element} + "<Twin clock");
    }
    void expectRefused(std::string_view element, std::string_view what, std::string_view allowed) {
        expectError("  <Twin clock", std::string{element} + "<Twin clock", what, allowed);
    }
};

TEST_F(RealtimeElement, MayBeLeftOut) {
    const auto result = loadText(test::BaseMachine);
    ASSERT_TRUE(result.machine.has_value());
    const scheduler::SchedulerParams& params = result.machine->scheduler;
    EXPECT_EQ(params.priority, 80);
    EXPECT_EQ(params.cpu, -1);
    EXPECT_EQ(params.overruns.policy, scheduler::OverrunPolicy::React);
    EXPECT_EQ(params.overruns.stopAfter, 3U);
    EXPECT_EQ(params.overruns.driveStopAfter, 10U);
}

TEST_F(RealtimeElement, SetsEverythingItNames) {
    const auto result = loadRealtime(
        R"(<Realtime priority="60" cpu="1" overruns="count" stopAfter="5" driveStopAfter="20" overrunRate="2 %"/>)");
    ASSERT_TRUE(result.machine.has_value()) << format(result.diagnostics);
    const scheduler::SchedulerParams& params = result.machine->scheduler;
    EXPECT_EQ(params.priority, 60);
    EXPECT_EQ(params.cpu, 1);
    EXPECT_EQ(params.overruns.policy, scheduler::OverrunPolicy::Count);
    EXPECT_EQ(params.overruns.stopAfter, 5U);
    EXPECT_EQ(params.overruns.driveStopAfter, 20U);
    EXPECT_DOUBLE_EQ(params.overruns.rate, 0.02);
}

TEST_F(RealtimeElement, RefusesAPriorityThatDoesNotExist) {
    expectRefused(R"(<Realtime priority="100"/>)", "priority", "0 to 99");
}
TEST_F(RealtimeElement, RefusesAnUnknownPolicy) {
    expectRefused(R"(<Realtime overruns="ignore"/>)", "not one of the choices", "react, count");
}
TEST_F(RealtimeElement, RefusesADriveStopBeforeTheStopOnPath) {
    expectRefused(R"(<Realtime stopAfter="5" driveStopAfter="4"/>)", "would stop before",
                  "5 (stopAfter)");
}
TEST_F(RealtimeElement, RefusesARateAboveAllCycles) {
    expectRefused(R"(<Realtime overrunRate="101 %"/>)", "more than all cycles", "100 %");
}

}  // namespace
}  // namespace takt::config
