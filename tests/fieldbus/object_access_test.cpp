#include "master_fixture.hpp"

namespace {

using namespace takt;
using core::ObjectState;
using test::MasterOnFake;
using testing::IsEmpty;

class ObjectsInOp : public MasterOnFake {
protected:
    void SetUp() override {
        build(test::exampleNetwork(2));
        ASSERT_THAT(bringUp(), IsEmpty());
        ASSERT_TRUE(toOp());
    }
    core::ObjectReply await(std::size_t slave, std::size_t limit = 100) {
        for (std::size_t i = 0; i < limit; ++i) {
            if (master->objects(slave).reply().state != ObjectState::Pending) break;
            cycle();
        }
        return master->objects(slave).reply();
    }
};

TEST_F(ObjectsInOp, ReadsAnExpeditedValue) {
    segment.devices[1].objects[0x606400] = {0x78, 0x56, 0x34, 0x12};
    ASSERT_TRUE(master->objects(1).startRead({0x6064, 0}));
    EXPECT_EQ(master->objects(1).reply().state, ObjectState::Pending);
    const auto reply = await(1);
    EXPECT_EQ(reply.state, ObjectState::Done);
    EXPECT_EQ(reply.value.size, 4);
    EXPECT_EQ(reply.value.bytes[0], 0x78);
    EXPECT_EQ(reply.value.bytes[3], 0x12);
}

TEST_F(ObjectsInOp, ReadsEightBytesByANormalUpload) {
    segment.devices[0].objects[0x201001] = {1, 2, 3, 4, 5, 6, 7, 8};
    ASSERT_TRUE(master->objects(0).startRead({0x2010, 1}));
    const auto reply = await(0);
    EXPECT_EQ(reply.state, ObjectState::Done);
    EXPECT_EQ(reply.value.size, 8);
    EXPECT_EQ(reply.value.bytes[7], 8);
}

TEST_F(ObjectsInOp, RefusesAValueLongerThanEightBytes) {
    segment.devices[0].objects[0x100800] = std::vector<std::uint8_t>(20, 'x');
    ASSERT_TRUE(master->objects(0).startRead({0x1008, 0}));
    const auto reply = await(0);
    EXPECT_EQ(reply.state, ObjectState::Failed);
    EXPECT_EQ(reply.abortCode, 0x06070012U);
}

TEST_F(ObjectsInOp, WritesOneToEightBytes) {
    for (std::uint8_t size = 1; size <= 8; ++size) {
        core::ObjectValue value;
        value.size = size;
        for (std::uint8_t i = 0; i < size; ++i)
            value.bytes[i] = static_cast<std::uint8_t>(size * 16 + i);
        ASSERT_TRUE(master->objects(0).startWrite({0x2020, size}, value));
        EXPECT_EQ(await(0).state, ObjectState::Done);
        const auto& stored = segment.devices[0].objects.at(0x202000U + size);
        EXPECT_EQ(stored,
                  std::vector<std::uint8_t>(value.bytes.begin(), value.bytes.begin() + size));
    }
}

TEST_F(ObjectsInOp, HandsTheAbortCodeOn) {
    segment.devices[0].aborts[0x607A00] = 0x06010002;
    ASSERT_TRUE(master->objects(0).startWrite({0x607A, 0}, {{1}, 1}));
    const auto reply = await(0);
    EXPECT_EQ(reply.state, ObjectState::Failed);
    EXPECT_EQ(reply.abortCode, 0x06010002U);
}

TEST_F(ObjectsInOp, TakesOneRequestAtATimePerDevice) {
    segment.devices[0].objects[0x606400] = {1};
    segment.devices[1].objects[0x606400] = {2};
    ASSERT_TRUE(master->objects(0).startRead({0x6064, 0}));
    EXPECT_FALSE(master->objects(0).startRead({0x6064, 0}));
    EXPECT_FALSE(master->objects(0).startWrite({0x6064, 0}, {{1}, 1}));
    EXPECT_TRUE(master->objects(1).startRead({0x6064, 0}));
    EXPECT_EQ(await(0).value.bytes[0], 1);
    EXPECT_EQ(await(1).value.bytes[0], 2);
}

TEST_F(ObjectsInOp, GivesEachUserTheReplyToHisOwnRequest) {
    using fieldbus::ethercat::ObjectUser;
    segment.devices[0].objects[0x606400] = {1};
    segment.devices[0].objects[0x606500] = {2};
    auto& ofAxis = master->objects(0);
    auto& ofOperator = master->objects(0, ObjectUser::Operator);
    ASSERT_TRUE(ofOperator.startRead({0x6065, 0}));
    EXPECT_FALSE(ofAxis.startRead({0x6064, 0})) << "the wire is taken";
    EXPECT_EQ(ofAxis.reply().state, ObjectState::Idle) << "and nothing has changed";
    for (int i = 0; i < 100 && ofOperator.reply().state == ObjectState::Pending; ++i) cycle();
    EXPECT_EQ(ofOperator.reply().value.bytes[0], 2);
    ASSERT_TRUE(ofAxis.startRead({0x6064, 0}));
    EXPECT_EQ(await(0).value.bytes[0], 1);
    EXPECT_EQ(ofOperator.reply().value.bytes[0], 2) << "still his";
}

TEST_F(ObjectsInOp, SurvivesLossOfAnyOneFrameOnTheWay) {
    for (std::uint64_t lost = 0; lost < 8; ++lost) {
        const auto value = static_cast<std::uint8_t>(0x40 + lost);
        segment.devices[0].objects[0x606400] = {value, 0};
        segment.lose = {segment.frameNumber + lost};
        ASSERT_TRUE(master->objects(0).startRead({0x6064, 0}));
        const auto reply = await(0);
        EXPECT_EQ(reply.state, ObjectState::Done) << "frame " << lost;
        EXPECT_EQ(reply.value.bytes[0], value) << "frame " << lost;
        cycle(20);
    }
}

TEST_F(ObjectsInOp, ARequestStartedBetweenPrepareAndExchangeIsNotLost) {
    segment.devices[0].objects[0x606400] = {7};
    // The frame under way already carries a datagram of the same mailbox.
    segment.devices[0].emergency(0x1000);
    cycle(3);
    ASSERT_TRUE(master->objects(0).startRead({0x6064, 0}));
    EXPECT_EQ(await(0, 20).value.bytes[0], 7);
}

TEST_F(ObjectsInOp, FailsByTimeOutWithoutHoldingUpOthers) {
    segment.devices[0].mailboxSilent = true;
    segment.devices[1].objects[0x606400] = {9};
    ASSERT_TRUE(master->objects(0).startRead({0x6064, 0}));
    ASSERT_TRUE(master->objects(1).startRead({0x6064, 0}));
    EXPECT_EQ(await(1, 20).state, ObjectState::Done);
    const auto reply = await(0, 10'000);
    EXPECT_EQ(reply.state, ObjectState::Failed);
    EXPECT_EQ(reply.abortCode, 0x05040000U);
}

TEST_F(ObjectsInOp, CountsEmergenciesWithinTenCycles) {
    segment.devices[1].emergency(0x2310);
    cycle(10);
    EXPECT_EQ(master->emergencies(1), 1U);
    EXPECT_EQ(master->lastEmergency(1).errorCode, 0x2310);
    EXPECT_EQ(master->lastEmergency(1).deviceData[0], 0xAA);
    EXPECT_EQ(master->counters().emergencies, 1U);
}

TEST_F(ObjectsInOp, CountsEmergenciesOfADeviceWithoutMailboxStateFmmu) {
    auto params = test::exampleNetwork(1);
    auto device = test::exampleDrive();
    device.fmmus.pop_back();
    params.slaves[0].device = std::make_shared<const wire::DeviceDescription>(device);
    build(params);
    ASSERT_THAT(bringUp(), IsEmpty());
    ASSERT_TRUE(toOp());
    segment.devices[0].emergency(0x2310);
    cycle(12);
    EXPECT_EQ(master->emergencies(0), 1U);
}

TEST_F(ObjectsInOp, SurvivesAStormOfEmergencies) {
    for (int i = 0; i < 50; ++i) segment.devices[0].emergency(0x8000);
    segment.devices[0].objects[0x606400] = {3};
    ASSERT_TRUE(master->objects(0).startRead({0x6064, 0}));
    EXPECT_EQ(await(0, 400).value.bytes[0], 3);
    cycle(200);
    EXPECT_EQ(master->emergencies(0), 50U);
}

TEST_F(ObjectsInOp, RefusesADeviceWithoutMailboxAtOnce) {
    auto params = test::exampleNetwork(1);
    auto device = test::exampleDrive();
    device.mailbox.reset();
    params.slaves[0].device = std::make_shared<const wire::DeviceDescription>(device);
    build(params);
    ASSERT_THAT(bringUp(), IsEmpty());
    ASSERT_TRUE(master->objects(0).startRead({0x6064, 0}));
    EXPECT_EQ(master->objects(0).reply().state, ObjectState::Failed);
    EXPECT_EQ(master->objects(0).reply().abortCode, 0x08000023U);
}

}  // namespace
