#include "machine_base.hpp"

namespace takt::config {
namespace {

class StopRamp : public test::MachineFile {};

TEST_F(StopRamp, WarnsWhenItOverrunsASoftLimit) {
    const LoadResult result =
        loadWith("jerk=\"50000 mm/s^3\"", "jerk=\"50000 mm/s^3\" stopDeceleration=\"1000 mm/s^2\"");
    ASSERT_TRUE(result.machine) << format(result.diagnostics);
    ASSERT_EQ(result.diagnostics.warningCount(), 1U) << format(result.diagnostics);
    const Diagnostic warning = test::firstOf(result.diagnostics, Severity::Warning);
    EXPECT_EQ(warning.place.line, changedLine_);
    // From 500 mm/s at 50000 mm/s^3: 0.52 s with 1000 mm/s^2, 0.29 s with 2000; 250 mm/s on
    // average.
    EXPECT_NE(warning.what.find("overruns it by up to 57.5 mm"), std::string::npos) << warning.what;
}

TEST_F(StopRamp, WarnsWhenOnlyItsJerkIsTooSmall) {
    const LoadResult result =
        loadWith("jerk=\"50000 mm/s^3\"", "jerk=\"50000 mm/s^3\" stopJerk=\"10000 mm/s^3\"");
    EXPECT_EQ(result.diagnostics.warningCount(), 1U) << format(result.diagnostics);
}

TEST_F(StopRamp, SaysNothingWhenItIsStrongEnough) {
    for (const char* stop : {"stopDeceleration=\"2000 mm/s^2\" stopJerk=\"50000 mm/s^3\"",
                             "stopDeceleration=\"6000 mm/s^2\" stopJerk=\"200000 mm/s^3\""}) {
        const LoadResult result =
            loadWith("jerk=\"50000 mm/s^3\"", std::string{"jerk=\"50000 mm/s^3\" "} + stop);
        EXPECT_EQ(result.diagnostics.warningCount(), 0U) << format(result.diagnostics);
    }
}

}  // namespace
}  // namespace takt::config
