#include <gtest/gtest.h>

#include <limits>

#include "machine_base.hpp"

namespace takt::config {
namespace {

using planner::roadmap::KeepOutParams;

/// Three linear axes and a turning one in a group G; the obstacles stand in their own line.
class ObstacleRule : public test::MachineFile {
protected:
    [[nodiscard]] LoadResult loadObstacles(const std::string& obstacles) {
        std::string text = R"(<Machine name="bench"><Network cycle="1 ms">
<Esi file="devices/cd300e.xml"/>)";
        std::string axes;
        for (const char* name : {"X", "Y", "Z", "C"}) {
            const bool turns = *name == 'C';
            text += std::string{"<Slave name=\""} + name + "\" device=\"CD300E\"/>\n";
            axes += std::string{"<Axis name=\""} + name +
                    (turns ? "\" unit=\"deg\">" : "\" unit=\"mm\">") + "<Drive slave=\"" + name +
                    "\" lostCommunication=\"confirmed\"/>\n<Scaling perTurn=\"10 " +
                    (turns ? "deg" : "mm") + "\"/><Limits velocity=\"10 " + (turns ? "deg" : "mm") +
                    "/s\" acceleration=\"20 " + (turns ? "deg" : "mm") + "/s^2\" " +
                    (turns ? "softNegative=\"0 deg\" softPositive=\"90 deg\"" : softLimits_) +
                    "/></Axis>\n";
        }
        text += "</Network>\n" + axes + R"(<Group name="G">
<Member axis="X"/><Member axis="Y"/><Member axis="Z"/><Member axis="C"/>
<Limits velocity="10 mm/s" acceleration="20 mm/s^2"/></Group>
)";
        changedLine_ = test::lineOf(text, text.size());
        return loadText(text + obstacles + "\n</Machine>");
    }

    void expectRefused(const std::string& obstacles, std::string_view what,
                       std::string_view allowed, int lines = 0) {
        const LoadResult result = loadObstacles(obstacles);
        EXPECT_FALSE(result.machine.has_value());
        const std::string all = format(result.diagnostics);
        ASSERT_EQ(result.diagnostics.errorCount(), 1U) << all;
        const Diagnostic error = test::firstOf(result.diagnostics, Severity::Error);
        EXPECT_EQ(error.place.line, changedLine_ + lines) << all;
        EXPECT_NE(error.what.find(what), std::string::npos) << all;
        EXPECT_NE(error.allowed.find(allowed), std::string::npos) << all;
    }

    static std::string inside(const std::string& keepOuts) {
        return "<Obstacles group=\"G\" clearance=\"8 mm\">\n" + keepOuts + "\n</Obstacles>";
    }

    std::string softLimits_{"softNegative=\"0 mm\" softPositive=\"400 mm\""};
};

constexpr const char* GoodBox = R"(<Box name="fixture"><Span axis="X" from="10 mm" to="2 cm"/>
<Span axis="Z" to="-5 mm"/></Box>)";
constexpr const char* GoodCylinder =
    R"(<Cylinder name="post" radius="30 mm" clearance="0 mm"><Centre axis="Z" at="1 mm"/>
<Centre axis="Y" at="2 mm"/><Span axis="X" from="3 mm"/></Cylinder>)";

TEST_F(ObstacleRule, ReadsBoxes) {
    const LoadResult result = loadObstacles(inside(GoodBox));
    ASSERT_TRUE(result.machine.has_value()) << format(result.diagnostics);
    ASSERT_EQ(result.machine->obstacles.size(), 1U);
    EXPECT_EQ(result.machine->obstacles[0].group, 0U);
    ASSERT_EQ(result.machine->obstacles[0].keepOuts.size(), 1U);
    const KeepOutParams& box = result.machine->obstacles[0].keepOuts[0];
    EXPECT_EQ(box.name, "fixture");
    EXPECT_EQ(box.clearance.count(), 8.0);
    EXPECT_FALSE(box.disc.has_value());
    ASSERT_EQ(box.spans.size(), 2U);
    EXPECT_EQ(box.spans[0].axis, 0U);
    EXPECT_EQ(box.spans[0].from.count(), 10.0);
    EXPECT_EQ(box.spans[0].to.count(), 20.0);
    EXPECT_EQ(box.spans[1].axis, 2U);
    EXPECT_EQ(box.spans[1].from.count(), -std::numeric_limits<double>::infinity());
    EXPECT_EQ(box.spans[1].to.count(), -5.0);
    EXPECT_NE(box.origin.find("machine.xml:"), std::string::npos);
}
TEST_F(ObstacleRule, ReadsCylinders) {
    const LoadResult result = loadObstacles(inside(GoodCylinder));
    ASSERT_TRUE(result.machine.has_value()) << format(result.diagnostics);
    const KeepOutParams& cylinder = result.machine->obstacles[0].keepOuts[0];
    EXPECT_EQ(cylinder.clearance.count(), 0.0);
    ASSERT_TRUE(cylinder.disc.has_value());
    EXPECT_EQ(cylinder.disc->firstAxis, 2U);
    EXPECT_EQ(cylinder.disc->secondAxis, 1U);
    EXPECT_EQ(cylinder.disc->firstCentre.count(), 1.0);
    EXPECT_EQ(cylinder.disc->secondCentre.count(), 2.0);
    EXPECT_EQ(cylinder.disc->radius.count(), 30.0);
    ASSERT_EQ(cylinder.spans.size(), 1U);
    EXPECT_EQ(cylinder.spans[0].to.count(), std::numeric_limits<double>::infinity());
}
TEST_F(ObstacleRule, TakesALatency) {
    const LoadResult left = loadObstacles("<Obstacles group=\"G\"/>");
    ASSERT_TRUE(left.machine.has_value()) << format(left.diagnostics);
    EXPECT_EQ(left.machine->obstacles[0].latencyCycles, 100U);
    const LoadResult given = loadObstacles("<Obstacles group=\"G\" latency=\"7\"/>");
    ASSERT_TRUE(given.machine.has_value()) << format(given.diagnostics);
    EXPECT_EQ(given.machine->obstacles[0].latencyCycles, 7U);
}
TEST_F(ObstacleRule, WarnsOfAKeepOutThatNobodyCanReach) {
    const LoadResult result =
        loadObstacles(inside("<Box name=\"a\"><Span axis=\"X\" from=\"409 mm\"/></Box>\n"
                             "<Box name=\"b\"><Span axis=\"X\" from=\"407 mm\"/></Box>"));
    ASSERT_TRUE(result.machine.has_value()) << format(result.diagnostics);
    ASSERT_EQ(result.diagnostics.warningCount(), 1U) << format(result.diagnostics);
    const Diagnostic warning = test::firstOf(result.diagnostics, Severity::Warning);
    EXPECT_EQ(warning.place.line, changedLine_ + 1);
    EXPECT_NE(warning.what.find("keep-out 'a'"), std::string::npos);
}
TEST_F(ObstacleRule, RefusesAnUnknownGroup) {
    expectRefused("<Obstacles group=\"H\"/>", "there is no group 'H'", "G");
}
TEST_F(ObstacleRule, RefusesASecondSetForAGroup) {
    expectRefused("<Obstacles group=\"G\"/>\n<Obstacles group=\"G\"/>", "already",
                  "one <Obstacles> for each group", 1);
}
TEST_F(ObstacleRule, RefusesAnAxisThatIsNotInTheGroup) {
    expectRefused(inside("<Box name=\"a\">\n<Span axis=\"Q\" to=\"1 mm\"/></Box>"),
                  "'Q' is no axis of group 'G'", "X, Y, Z, C", 2);
}
TEST_F(ObstacleRule, RefusesAnAxisTwiceInAKeepOut) {
    expectRefused(inside("<Box name=\"a\"><Span axis=\"X\" to=\"1 mm\"/>\n<Span axis=\"X\" "
                         "from=\"3 mm\"/></Box>"),
                  "axis 'X' stands in line", "each axis once", 2);
}
TEST_F(ObstacleRule, RefusesAnAxisOfAnotherUnit) {
    expectRefused(inside("<Box name=\"a\"><Span axis=\"C\" to=\"1 mm\"/></Box>"),
                  "axis 'C' is in deg", "unit of the group's paths", 1);
}
TEST_F(ObstacleRule, RefusesASpanWithItsEndsSwapped) {
    expectRefused(inside("<Box name=\"a\"><Span axis=\"X\" from=\"3 mm\" to=\"3 mm\"/></Box>"),
                  "no extent", "from below to", 1);
}
TEST_F(ObstacleRule, RefusesASpanWithoutEnds) {
    expectRefused(inside("<Box name=\"a\"><Span axis=\"X\"/></Box>"), "no end", "from, to", 1);
}
TEST_F(ObstacleRule, RefusesABoxThatCoversEverything) {
    expectRefused(inside("<Box name=\"a\"/>"), "cover everything", "<Span>", 1);
}
TEST_F(ObstacleRule, RefusesANegativeRadius) {
    expectRefused(inside("<Cylinder name=\"a\" radius=\"-1 mm\"><Centre axis=\"X\" at=\"1 mm\"/>"
                         "<Centre axis=\"Y\" at=\"1 mm\"/></Cylinder>"),
                  "radius", "above 0", 1);
}
TEST_F(ObstacleRule, RefusesANegativeClearance) {
    expectRefused("<Obstacles group=\"G\" clearance=\"-1 mm\"/>", "clearance", "0");
}
TEST_F(ObstacleRule, RefusesACylinderWithoutAPlane) {
    expectRefused(inside("<Cylinder name=\"a\" radius=\"1 mm\"><Centre axis=\"X\" at=\"1 mm\"/>"
                         "</Cylinder>"),
                  "1 <Centre>", "two", 1);
}
TEST_F(ObstacleRule, RefusesTwoKeepOutsOfOneName) {
    expectRefused(inside(std::string{GoodBox} + "\n" + GoodBox), "of this name in line",
                  "each name once", 3);
}
TEST_F(ObstacleRule, RefusesAGroupWhoseAxesHaveNoEnd) {
    softLimits_ = "softNegative=\"0 mm\"";
    const LoadResult result = loadObstacles(inside(GoodBox));
    EXPECT_FALSE(result.machine.has_value());
    EXPECT_EQ(result.diagnostics.errorCount(), 3U) << format(result.diagnostics);
    EXPECT_NE(format(result.diagnostics).find("axis 'Y' of the group has no softPositive"),
              std::string::npos);
}

}  // namespace
}  // namespace takt::config
