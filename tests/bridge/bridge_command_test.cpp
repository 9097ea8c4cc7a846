// Commands over DDS to a paced machine without programs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <limits>
#include <thread>

#include "bridged_takt.hpp"
#include "dds_client.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;

constexpr double StartTime = 20.0;

/// A machine that takes commands, and one client that may give them.
class CommandedOverDds : public testing::Test {
protected:
    CommandedOverDds()
        : folder{freshFolder(std::string{"bridge_"} +
                             testing::UnitTest::GetInstance()->current_test_info()->name())},
          machine{ownMachine(folder, "commands=\"on\"")},
          client{machine.domain, machine.name, 1},
          takt{{"run", machine.file, "--sim", "--manual", "--for", "60s", "--socket",
                machine.socket, "--trace", "t.csv", "--record-commands", "taken.txt"},
               folder} {}

    void SetUp() override {
        ASSERT_TRUE(waitFor(
            [this] {
                client.listen();
                return client.operating() && client.axes().size() == 16 && client.mayCommand();
            },
            StartTime));
    }
    /// On a busy computer this process may be silent for 100 ms, which stops the axis: then it goes
    /// on from there.
    bool moveTo(const std::string& axis, double target) {
        constexpr int tries = 20;
        for (int i = 0; i < tries; ++i) {
            const double distance = target - client.axes().at(axis).actual;
            const auto end = client.answer(client.send("inch", axis, distance, 50.0), true);
            if (end && end->kind == "done") return true;
        }
        return false;
    }
    /// Ends the run as a user does.
    ProcessResult interrupt() {
        takt.kill(SIGINT);
        return takt.finish();
    }

    std::string folder;
    OwnMachine machine;
    DdsClient client;
    BridgedTakt takt;
};

TEST_F(CommandedOverDds, AnAxisMovesAndTheCommandsAreRecordedWithTheirCycles) {
    const auto power = client.answer(client.send("power-on", "S03"), true);
    ASSERT_TRUE(power.has_value());
    EXPECT_EQ(power->kind, "done") << power->why;
    ASSERT_TRUE(moveTo("S03", 3.0));
    EXPECT_TRUE(waitFor(
        [this] {
            client.listen();
            return std::abs(client.axes().at("S03").actual - 3.0) < 0.05;
        },
        StartTime));
    const std::uint64_t seen = client.axes().at("S03").cycle;
    EXPECT_EQ(interrupt().exitCode, 128 + SIGINT);

    // Replayed without any bridge they do the same in the same cycles.
    const std::string taken = readFile(folder + "/taken.txt");
    EXPECT_THAT(taken, HasSubstr(" power-on S03\n"));
    EXPECT_THAT(taken, HasSubstr(" inch S03 3 50\n"));
    const auto replayed = runTakt({"run", machine.file, "--fast", "--manual", "--for", "2s",
                                   "--commands", "taken.txt", "--trace", "replayed.csv"},
                                  folder);
    EXPECT_EQ(replayed.exitCode, 0) << replayed.output;
    const std::string live = readFile(folder + "/t.csv");
    const std::string again = readFile(folder + "/replayed.csv");
    // The operated run was ended at some cycle after the last status that was seen.
    const std::size_t common = live.find("\n" + std::to_string(seen) + ",");
    ASSERT_NE(common, std::string::npos);
    EXPECT_GT(common, 100'000U);
    EXPECT_TRUE(live.substr(0, common) == again.substr(0, common));
}

TEST_F(CommandedOverDds, TheMachineHasOneOwnerOverBothDoors) {
    ASSERT_EQ(client.answer(client.send("power-on", "S01"), true)->kind, "done");
    DdsClient other{machine.domain, machine.name, 2};
    ASSERT_TRUE(waitFor(
        [&] {
            client.send("heartbeat");
            other.listen();
            return other.mayCommand();
        },
        StartTime));
    {
        // The owner is there all the while.
        std::jthread owner{[this](const std::stop_token& end) {
            for (; !end.stop_requested(); pauseFor(0.02)) client.send("reset", "S01");
        }};
        const auto refused = other.answer(other.send("power-on", "S02"), false);
        ASSERT_TRUE(refused.has_value());
        EXPECT_EQ(refused->kind, "refused");
        EXPECT_THAT(refused->why, HasSubstr("operated by client 1 (DDS)"));
        const auto socket = runTakt({"power", "on", "S02", "--socket", machine.socket}, folder);
        EXPECT_NE(socket.exitCode, 0);
        EXPECT_THAT(socket.output, HasSubstr("operated by client 1 (DDS)"));
    }
    client.send("leave");
    const auto taken = other.answer(other.send("power-on", "S02"), true);
    ASSERT_TRUE(taken.has_value());
    EXPECT_EQ(taken->kind, "done") << taken->why;
}

TEST_F(CommandedOverDds, ARefusedCommandSaysWhy) {
    const auto unknown = client.answer(client.send("power-on", "Q"), false);
    ASSERT_TRUE(unknown.has_value());
    EXPECT_EQ(unknown->kind, "refused");
    EXPECT_THAT(unknown->why, HasSubstr("there is no axis 'Q'; allowed: S01, S02"));
    const auto infinite = client.answer(
        client.send("inch", "S01", std::numeric_limits<double>::infinity(), 1.0), false);
    ASSERT_TRUE(infinite.has_value());
    EXPECT_EQ(infinite->kind, "refused");
    EXPECT_THAT(infinite->why, HasSubstr("not finite"));
    const auto off = client.answer(client.send("inch", "S01", 1.0, 10.0), true);
    ASSERT_TRUE(off.has_value());
    EXPECT_EQ(off->kind, "refused");
    EXPECT_THAT(off->why, HasSubstr("NotPowered"));
}

TEST_F(CommandedOverDds, TheAxisStopsWhenTheBridgeIsGone) {
    ASSERT_EQ(client.answer(client.send("power-on", "S04"), true)->kind, "done");
    ASSERT_TRUE(waitFor(
        [this] {
            if (client.axes().at("S04").state == "Standstill")
                client.send("inch", "S04", 100.0, 20.0);
            client.send("heartbeat");
            client.listen();
            return client.axes().at("S04").state == "DiscreteMotion";
        },
        StartTime));
    ASSERT_NE(takt.bridge(), 0);
    ::kill(takt.bridge(), SIGKILL);
    // Told by the bridge that was started in its place, with what happened before.
    EXPECT_TRUE(waitFor(
        [this] {
            client.listen();
            return client.heardOf("ended by signal 9; started again in 50 ms") &&
                   client.axes().at("S04").state == "Standstill";
        },
        StartTime));
    EXPECT_LT(client.axes().at("S04").actual, 90.0);
}

}  // namespace
}  // namespace takt::test
