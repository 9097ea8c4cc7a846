#include <gtest/gtest.h>

#include "devices.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

using std::chrono::milliseconds;

TEST(TwinBringUp, ThreeDrivesReachOp) {
    const TwinParams params = lineOf(3, "cd300e");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.toOp();
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(twin.probe(i).alState, wire::AlState::Op)
            << std::hex << twin.probe(i).alStatusCode;
    }
    EXPECT_EQ(master.lastWkc, 9);
}

TEST(TwinBringUp, ADriveFollowsACyclicTarget) {
    const TwinParams params = lineOf(1, "cd300e");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.toOp();
    ASSERT_TRUE(master.enable(0, 8));
    std::int32_t target = master.position(0);
    for (int i = 0; i < 500; ++i) {
        target += i < 100 ? i / 5 : 20;
        master.command(0, 0x000F, 8, target);
        master.cycle();
        ASSERT_LT(std::abs(master.lag(0)), 30) << i;
    }
    for (int i = 0; i < 200; ++i) master.cycle();
    EXPECT_NEAR(master.position(0), target, 1);
}

}  // namespace
}  // namespace takt::twin::test
