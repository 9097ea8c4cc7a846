#include <gmock/gmock.h>

#include <takt/plcopen/plcopen.hpp>
#include <takt/program/inspector.hpp>

namespace takt::program {
namespace {

std::vector<std::string> namesOf(const Inspector& inspector) {
    std::vector<std::string> names;
    for (const Watch& watch : inspector.watches()) names.push_back(watch.name);
    return names;
}

TEST(Inspector, ListsThePinsThatABlockHas) {
    const plcopen::MC_MoveAbsolute move;
    const plcopen::MC_Power power;
    Inspector inspector;
    inspector.block("move", move);
    inspector.block("power", power);
    EXPECT_THAT(
        namesOf(inspector),
        testing::ElementsAre("move.Execute", "move.Busy", "move.Active", "move.Done",
                             "move.CommandAborted", "move.Error", "move.ErrorID", "power.Enable",
                             "power.Status", "power.Valid", "power.Error", "power.ErrorID"));
}

TEST(Inspector, ShowsAPinAsItIsNow) {
    plcopen::MC_MoveAbsolute move;
    Inspector inspector;
    inspector.block("move", move);
    EXPECT_EQ(inspector.watches()[0].number(), 0.0);
    move.Execute = true;
    EXPECT_EQ(inspector.watches()[0].number(), 1.0);
}

TEST(Inspector, TellsPinsFromVariables) {
    const plcopen::MC_Power power;
    const int step = 3;
    Inspector inspector;
    inspector.watch("step", step);
    inspector.block("power", power);
    EXPECT_FALSE(inspector.watches()[0].pin);
    EXPECT_TRUE(inspector.watches()[1].pin);
}

}  // namespace
}  // namespace takt::program
