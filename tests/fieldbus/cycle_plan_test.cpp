#include "cycle_plan.hpp"

#include <gtest/gtest.h>

#include "example_network.hpp"
#include "listed_network.hpp"

namespace {

using namespace takt;
using namespace takt::fieldbus::ethercat;
using Kind = fieldbus::CyclicCommand::Kind;

CyclePlan planOf(const fieldbus::NetworkParams& network) {
    return makePlan(network, makeLayout(network));
}

fieldbus::NetworkParams listedExample(std::size_t count) {
    auto network = test::exampleNetwork(count);
    test::makeListed(network);
    return network;
}

TEST(CyclePlan, SendsEverythingInEveryStateUnlessAListSaysOtherwise) {
    const CyclePlan own = planOf(test::exampleNetwork(3));
    EXPECT_FALSE(own.byState);
    for (const PlannedDatagram& datagram : own.datagrams) EXPECT_EQ(datagram.states, SentAlways);
    const CyclePlan listed = planOf(listedExample(3));
    EXPECT_TRUE(listed.byState);
    EXPECT_EQ(listed.datagrams[0].states, SentAlways);
    EXPECT_EQ(listed.datagrams[1].states, SentInSafeOp | SentInOp);
}

TEST(CyclePlan, BeginsWithTheReferenceTimeAndEndsWithTheStates) {
    const CyclePlan plan = planOf(test::exampleNetwork(3));
    EXPECT_EQ(plan.datagrams.front().kind, Kind::ReferenceTime);
    EXPECT_EQ(plan.datagrams.front().command, wire::Command::Frmw);
    EXPECT_EQ(plan.datagrams.back().kind, Kind::AlStatus);
    EXPECT_EQ(plan.frames(), 1U);
}

TEST(CyclePlan, TakesDatagramsOfAListAsTheyAre) {
    const CyclePlan plan = planOf(listedExample(2));
    ASSERT_EQ(plan.datagrams.size(), 3U);
    EXPECT_EQ(plan.datagrams[0].command, wire::Command::Armw);
    EXPECT_EQ(plan.datagrams[0].length, 4);
    const PlannedDatagram& data = plan.datagrams[1];
    EXPECT_EQ(data.address, test::ListedLogical);
    EXPECT_EQ(data.outputAt, test::ImageStart);
    EXPECT_EQ(data.inputAt, test::ImageStart);
    EXPECT_EQ(data.outputBytes, 40) << "a listed window is copied as a whole";
    ASSERT_EQ(plan.groups.size(), 1U);
    EXPECT_EQ(plan.groups[0].expected, 6);
}

TEST(CyclePlan, GivesASlaveTheBytesThatItsBitsTouch) {
    auto network = listedExample(2);
    network.slaves[0].listed->inputs = {8 * 30 + 5, 6};
    network.slaves[1].listed->outputs = {};
    const CyclePlan plan = planOf(network);
    EXPECT_EQ(plan.slaves[0].inputAt, 30U);
    EXPECT_EQ(plan.slaves[0].inputBytes, 2U);
    EXPECT_EQ(plan.slaves[1].outputBytes, 0U);
    EXPECT_EQ(plan.slaves[1].outputGroup, plan.slaves[1].inputGroup);
}

TEST(CyclePlan, LetsASlaveHangOnTheDatagramsThatCarryIt) {
    auto network = listedExample(2);
    auto& frame = network.listed->frames[0];
    fieldbus::CyclicCommand inputs = frame[1];
    inputs.command = 10;  // LRD
    inputs.inputOffset = 100;
    inputs.length = 13;
    frame.push_back(inputs);
    network.listed->inputBytes = 113;
    network.slaves[1].listed->inputs = {8 * 100, 8 * 13};
    const CyclePlan plan = planOf(network);
    ASSERT_EQ(plan.groups.size(), 2U);
    EXPECT_EQ(plan.slaves[1].outputGroup, 0);
    EXPECT_EQ(plan.slaves[1].inputGroup, 1);
}

TEST(CyclePlan, KnowsTheSlavesOfScatteredMailboxBits) {
    auto network = listedExample(2);
    network.slaves[0].listed->mailboxStateBit = 5;
    network.slaves[1].listed->mailboxStateBit = 2;
    const CyclePlan plan = planOf(network);
    ASSERT_EQ(plan.mailboxSlave.size(), 6U);
    EXPECT_EQ(plan.mailboxSlave[5], 0);
    EXPECT_EQ(plan.mailboxSlave[2], 1);
    EXPECT_EQ(plan.mailboxSlave[0], CyclePlan::NoSlave);
}

}  // namespace
