#include <gtest/gtest.h>

#include "devices.hpp"
#include "test_master.hpp"

namespace takt::twin::test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

using Status = std::pair<std::uint16_t, std::uint16_t>;

class TwinAlState : public ::testing::Test {
protected:
    TwinParams params = lineOf(1, "cd300e");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};

    void SetUp() override { master.addressAll(); }
    void toPreOp() {
        master.setMailboxes(0);
        ASSERT_EQ(master.requestState(0, 2), (Status{2, 0}));
    }
    void toSafeOp() {
        toPreOp();
        master.setProcessData(0);
        ASSERT_EQ(master.requestState(0, 4), (Status{4, 0}));
    }
    void startSync0(core::Duration cycleTime) {
        master.setUpClocks(100);
        master.startSync0(cycleTime, cycleTime / 2);
    }
};

TEST_F(TwinAlState, RefusesToSkipAState) {
    EXPECT_EQ(master.requestState(0, 4), (Status{0x11, 0x0011}));
    EXPECT_EQ(master.requestState(0, 0x11), (Status{1, 0}));
    EXPECT_EQ(master.requestState(0, 8), (Status{0x11, 0x0011}));
}

TEST_F(TwinAlState, RefusesUnknownStatesAndBoot) {
    EXPECT_EQ(master.requestState(0, 7), (Status{0x11, 0x0012}));
    EXPECT_EQ(master.requestState(0, 0x11), (Status{1, 0}));
    EXPECT_EQ(master.requestState(0, 3), (Status{0x11, 0x0013}));
}

TEST_F(TwinAlState, AnswersTheOwnStateAsSuccess) {
    EXPECT_EQ(master.requestState(0, 1), (Status{1, 0}));
}

TEST_F(TwinAlState, TakesItsTime) {
    master.setMailboxes(0);
    master.write(0, 0x0120, le16(2));
    EXPECT_EQ(number(master.read(0, 0x0130, 2).data), 1U);
    master.sleep(milliseconds{3});
    EXPECT_EQ(number(master.read(0, 0x0130, 2).data), 2U);
}

TEST_F(TwinAlState, ChecksTheMailboxOnTheWayToPreOp) {
    EXPECT_EQ(master.requestState(0, 2), (Status{0x11, 0x0016}));
    master.requestState(0, 0x11);
    master.setMailboxes(0);
    master.write(0, 0x0806, {0});
    master.write(0, 0x0802, {0x40, 0x00});  // another size
    master.write(0, 0x0806, {1});
    EXPECT_EQ(master.requestState(0, 2), (Status{0x11, 0x0016}));
}

TEST_F(TwinAlState, IgnoresAHigherStateUntilTheErrorIsAcknowledged) {
    EXPECT_EQ(master.requestState(0, 2), (Status{0x11, 0x0016}));
    master.setMailboxes(0);
    EXPECT_EQ(master.requestState(0, 2), (Status{0x11, 0x0016}));
    EXPECT_EQ(master.requestState(0, 0x12), (Status{2, 0}));
}

TEST_F(TwinAlState, ChecksTheLengthsOfTheProcessData) {
    toPreOp();
    master.setProcessData(0, 8, 13);
    EXPECT_EQ(master.requestState(0, 4), (Status{0x12, 0x001D}));
    master.write(0, 0x0816, {0});
    master.write(0, 0x081E, {0});
    master.setProcessData(0, 7, 12);
    EXPECT_EQ(master.requestState(0, 0x14), (Status{0x12, 0x001E}));
    master.write(0, 0x0816, {0});
    master.write(0, 0x081E, {0});
    master.setProcessData(0);
    EXPECT_EQ(master.requestState(0, 0x14), (Status{4, 0}));
}

TEST_F(TwinAlState, RefusesASync0CycleThatTheDriveDoesNotHave) {
    toPreOp();
    master.setProcessData(0);
    startSync0(milliseconds{3});
    EXPECT_EQ(master.requestState(0, 4), (Status{0x12, 0x0036}));
}

TEST_F(TwinAlState, RefusesCyclicOperationWithoutSync0) {
    toPreOp();
    master.setProcessData(0);
    master.write(0, 0x0981, {0x01});
    EXPECT_EQ(master.requestState(0, 4), (Status{0x12, 0x0030}));
}

TEST_F(TwinAlState, RefusesOpWithoutOutputs) {
    toSafeOp();
    EXPECT_EQ(master.requestState(0, 8, milliseconds{400}), (Status{0x14, 0x0019}));
}

TEST_F(TwinAlState, RefusesOpWhenSync0NeverComes) {
    toPreOp();
    master.setProcessData(0);
    master.write(0, 0x09A0, le32(1'000'000));
    master.write(0, 0x0990, le64(1));  // long past
    master.write(0, 0x0981, {0x03});
    ASSERT_EQ(master.requestState(0, 4), (Status{4, 0}));
    EXPECT_EQ(master.requestState(0, 8, milliseconds{400}), (Status{0x14, 0x002D}));
}

TEST_F(TwinAlState, GivesValidInputsFromSafeOpOn) {
    toPreOp();
    master.setProcessData(0);
    EXPECT_EQ(master.read(0, 0x1400, 13).wkc, 0);
    master.requestState(0, 4);
    EXPECT_EQ(master.read(0, 0x1400, 13).wkc, 1);
}

TEST_F(TwinAlState, FallsToSafeOpWhenTheWatchdogExpires) {
    master.write(0, 0x0420, le16(200));  // 20 ms
    master.toOp();
    ASSERT_TRUE(master.enable(0, 8));
    const auto lastFrame = twin.trueTime();
    master.sleep(milliseconds{15});
    EXPECT_EQ(twin.probe(0).alState, wire::AlState::Op);
    EXPECT_EQ(number(master.read(0, 0x0440, 2).data), 1U);
    master.sleep(milliseconds{8});
    EXPECT_GT(twin.trueTime() - lastFrame, milliseconds{20});
    EXPECT_EQ(number(master.read(0, 0x0130, 2).data), 0x14U);
    EXPECT_EQ(number(master.read(0, 0x0134, 2).data), 0x001BU);
    EXPECT_EQ(number(master.read(0, 0x0440, 2).data), 0U);
    EXPECT_EQ(master.read(0, 0x0442, 1).data[0], 1);
    EXPECT_NE(twin.probe(0).driveState, core::cia402::DriveState::OperationEnabled);
    // Acknowledge, outputs again, OP again.
    master.write(0, 0x0120, le16(0x14));
    master.cycles(20);
    master.write(0, 0x0120, le16(0x08));
    master.cycles(20);
    EXPECT_EQ(twin.probe(0).alState, wire::AlState::Op);
    EXPECT_EQ(master.errorCode(0), 0x8700);
}

TEST_F(TwinAlState, NoticesThatSync0Stops) {
    master.toOp();
    master.write(0, 0x0981, {0x00});
    master.sleep(milliseconds{5});
    EXPECT_EQ(number(master.read(0, 0x0130, 2).data), 0x14U);
    EXPECT_EQ(number(master.read(0, 0x0134, 2).data), 0x002CU);
}

TEST_F(TwinAlState, ReachesOpInFreeRunToo) {
    toSafeOp();
    master.write(0, 0x0120, le16(8));
    master.cycles(80);
    EXPECT_EQ(twin.probe(0).alState, wire::AlState::Op);
    EXPECT_TRUE(master.enable(0, 8));
}

TEST_F(TwinAlState, GoesDownInOneStep) {
    master.toOp();
    EXPECT_EQ(master.requestState(0, 2), (Status{2, 0}));
    EXPECT_EQ(master.requestState(0, 1), (Status{1, 0}));
}

TEST(TwinAlStateRa, CountsMissingOutputsAndFallsAfterFour) {
    const TwinParams params = lineOf(1, "ra");
    Twin twin{params, descriptionsFor(params), milliseconds{1}};
    TestMaster master{twin};
    master.toOp();
    ASSERT_EQ(twin.probe(0).alState, wire::AlState::Op);
    ASSERT_EQ(twin.probe(0).missedOutputs, 0U);
    master.sleep(microseconds{3500});
    EXPECT_EQ(twin.probe(0).alState, wire::AlState::Op);
    master.sleep(milliseconds{3});
    EXPECT_EQ(twin.probe(0).missedOutputs, 4U);
    EXPECT_EQ(twin.probe(0).alState, wire::AlState::SafeOp);
    EXPECT_EQ(twin.probe(0).alStatusCode, 0x001A);
    EXPECT_EQ(twin.probe(0).driveState, core::cia402::DriveState::Fault);
}

}  // namespace
}  // namespace takt::twin::test
