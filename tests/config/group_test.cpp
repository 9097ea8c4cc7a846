#include <gtest/gtest.h>

#include "machine_base.hpp"

namespace takt::config {
namespace {

/// The base has a linear axis X and a modulo axis Z; a group goes where its program stands.
class GroupRule : public test::MachineFile {
protected:
    static constexpr std::string_view Place = "  <Program name=\"pick\"";

    static std::string with(const std::string& group) { return group + std::string{Place}; }
    void expectRefused(const std::string& group, std::string_view what, std::string_view allowed,
                       int lines = 0) {
        expectError(Place, with(group), what, allowed, lines);
    }
    static std::string group(const std::string& members) {
        return "<Group name=\"G\">\n" + members +
               "\n<Limits velocity=\"1 mm/s\" acceleration=\"2 mm/s^2\"/></Group>\n";
    }
};

TEST_F(GroupRule, ReadsMembersLimitsAndDefaults) {
    const auto result = loadWith(Place, with(R"(<Group name="G"><Member axis="X"/>
        <Limits velocity="0.2 m/s" acceleration="3 m/s^2" jerk="60000 mm/s^3"/></Group>)"));
    ASSERT_TRUE(result.machine.has_value()) << format(result.diagnostics);
    ASSERT_EQ(result.machine->groups.size(), 1U);
    const axis::GroupParams& group = result.machine->groups[0];
    EXPECT_EQ(group.name, "G");
    EXPECT_EQ(group.unit, "mm");
    EXPECT_EQ(group.axes, std::vector<std::size_t>{0});
    EXPECT_EQ(group.limits.velocity.count(), 200.0);
    EXPECT_EQ(group.limits.acceleration.count(), 3000.0);
    EXPECT_EQ(group.limits.deceleration.count(), 3000.0);
    EXPECT_EQ(group.limits.jerk.count(), 60000.0);
    EXPECT_EQ(group.queueDepth, 32U);
    EXPECT_EQ(group.latencyCycles, 4U);
    EXPECT_NE(group.origin.find("machine.xml:"), std::string::npos);
}
TEST_F(GroupRule, BuildsAccelerationUpInATenthOfASecondWithoutAJerk) {
    const auto result = loadWith(Place, with(group("<Member axis=\"X\"/>")));
    ASSERT_TRUE(result.machine.has_value()) << format(result.diagnostics);
    EXPECT_EQ(result.machine->groups[0].limits.jerk.count(), 20.0);
}
TEST_F(GroupRule, TakesQueueAndLatency) {
    const auto result =
        loadWith(Place, with(R"(<Group name="G" queue="3" latency="7"><Member axis="X"/>
            <Limits velocity="1 mm/s" acceleration="2 mm/s^2"/></Group>)"));
    ASSERT_TRUE(result.machine.has_value()) << format(result.diagnostics);
    EXPECT_EQ(result.machine->groups[0].queueDepth, 3U);
    EXPECT_EQ(result.machine->groups[0].latencyCycles, 7U);
}
TEST_F(GroupRule, RefusesAnUnknownAxisInItsLine) {
    expectRefused(group("<Member axis=\"Q\"/>"), "there is no axis 'Q'", "X, Z", 1);
}
TEST_F(GroupRule, RefusesAnAxisTwiceInTheLineOfTheSecond) {
    expectRefused(group("<Member axis=\"X\"/>\n<Member axis=\"X\"/>"), "is in the group already",
                  "each axis once", 2);
}
TEST_F(GroupRule, RefusesAModuloAxis) {
    expectRefused(group("<Member axis=\"X\"/>\n<Member axis=\"Z\"/>"), "is a modulo axis",
                  "linear axes", 2);
}
TEST_F(GroupRule, RefusesAGroupWithoutAxes) {
    expectRefused(group(""), "the group has no axis", "X, Z");
}
TEST_F(GroupRule, RefusesTheNameOfAnAxis) {
    expectRefused(
        "<Group name=\"X\"><Member axis=\"X\"/>"
        "<Limits velocity=\"1 mm/s\" acceleration=\"2 mm/s^2\"/></Group>\n",
        "there is an axis 'X', too", "no axis has");
}
TEST_F(GroupRule, RefusesALimitOfZero) {
    expectRefused(
        "<Group name=\"G\"><Member axis=\"X\"/>\n"
        "<Limits velocity=\"0 mm/s\" acceleration=\"2 mm/s^2\"/></Group>\n",
        "velocity", "above 0", 1);
}
TEST_F(GroupRule, RefusesAGroupWithoutLimits) {
    expectRefused("<Group name=\"G\"><Member axis=\"X\"/></Group>\n", "<Limits> is missing", "");
}
TEST_F(GroupRule, RefusesTwoGroupsOfOneName) {
    const std::string one = group("<Member axis=\"X\"/>");
    expectRefused(one + one, "there is a group of this name", "each name once", 3);
}
TEST_F(GroupRule, RefusesAQueueLongerThanThereIsRoom) {
    expectRefused(
        "<Group name=\"G\" queue=\"33\"><Member axis=\"X\"/>"
        "<Limits velocity=\"1 mm/s\" acceleration=\"2 mm/s^2\"/></Group>\n",
        "queue", "1 to 32");
}

}  // namespace
}  // namespace takt::config
