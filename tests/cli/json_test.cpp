#include "json.hpp"

#include <gtest/gtest.h>

namespace takt::cli {
namespace {

TEST(Json, EscapesWhatEndsAStringOrALine) {
    EXPECT_EQ(jsonText("a\"b\\c\nd\x01"), R"("a\"b\\c\u000ad\u0001")");
}

TEST(Json, KeepsTheOrderOfMembers) {
    JsonObject object;
    object.add("name", "x").addRaw("pos", "3").add("dc", true);
    EXPECT_EQ(object.text(), R"({"name":"x","pos":3,"dc":true})");
    EXPECT_EQ(jsonArray({object.text(), "1"}), R"([{"name":"x","pos":3,"dc":true},1])");
    EXPECT_EQ(jsonArray({}), "[]");
}

}  // namespace
}  // namespace takt::cli
