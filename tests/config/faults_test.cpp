#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <takt/config/load_faults.hpp>

#include "test_files.hpp"

namespace takt::config::test {
namespace {

class FaultFile : public testing::Test {
protected:
    std::optional<twin::FaultParams> load(std::string_view text) {
        return loadFaults(folder_.write("faults.xml", text), diagnostics);
    }
    Diagnostics diagnostics;

private:
    ScratchFolder folder_;
};

TEST_F(FaultFile, GivesLostFramesInAscendingOrder) {
    const auto faults = load(
        "<Faults>\n<LostFrames cycle=\"900\" cycles=\"4\"/>\n<LostFrames "
        "cycle=\"70\"/>\n</Faults>");
    ASSERT_TRUE(faults) << format(diagnostics);
    ASSERT_EQ(faults->lostFrames.size(), 2U);
    EXPECT_EQ(faults->lostFrames[0].cycle, 70U);
    EXPECT_EQ(faults->lostFrames[0].cycles, 1U);
    EXPECT_EQ(faults->lostFrames[1].cycle, 900U);
    EXPECT_EQ(faults->lostFrames[1].cycles, 4U);
}

TEST_F(FaultFile, RefusesATypoWithItsLine) {
    EXPECT_FALSE(load("<Faults>\n<LostFrame cycle=\"70\"/>\n</Faults>"));
    EXPECT_THAT(format(diagnostics), testing::HasSubstr("faults.xml:2"));
    EXPECT_THAT(format(diagnostics), testing::HasSubstr("LostFrames"));
}

TEST_F(FaultFile, RefusesACycleThatIsNoNumberAndAnotherRoot) {
    EXPECT_FALSE(load("<Faults>\n<LostFrames cycle=\"soon\"/>\n</Faults>"));
    EXPECT_THAT(format(diagnostics), testing::HasSubstr("faults.xml:2"));
    EXPECT_FALSE(load("<Machine/>"));
}

}  // namespace
}  // namespace takt::config::test
