#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <takt/daemon/control_socket.hpp>

#include "machine_files.hpp"
#include "rate_limit.hpp"
#include "running_takt.hpp"

namespace takt::test {
namespace {

using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using Json = SocketClient::Json;

/// The gantry without programs, as slow as the wall clock.
class LiveMachine : public testing::Test {
protected:
    void SetUp() override {
        const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
        machine_ = std::make_unique<RunningTakt>(
            std::string{"live_"} + test->name(),
            std::vector<std::string>{"run", Gantry, "--sim", "--manual"});
        SocketClient watcher{machine_->socket()};
        while (watcher.status().at("phase") != "operating") {
            SocketClient::pause();
        }
    }
    void TearDown() override {
        if (machine_) machine_->terminate();
    }
    /// X on, and on a way that takes far longer than anything here.
    int sendOnALongWay(SocketClient& client) {
        EXPECT_EQ(client.ask({{"do", "power-on"}, {"axis", "X"}}).at("is"), "done");
        return client.send({{"do", "inch"}, {"axis", "X"}, {"distance", 250.0}, {"velocity", 1.0}});
    }
    [[nodiscard]] const std::string& socket() const { return machine_->socket(); }

    std::unique_ptr<RunningTakt> machine_;
};

TEST_F(LiveMachine, ShowsTheSameToTwoWatchers) {
    SocketClient first{socket()};
    SocketClient second{socket()};
    const Json a = first.status();
    const Json b = second.status();
    EXPECT_EQ(a.at("machine"), "gantry");
    EXPECT_EQ(a.at("pid"), machine_->process());
    EXPECT_EQ(a.at("axes").size(), 3U);
    EXPECT_EQ(a.at("axes")[2].at("name"), b.at("axes")[2].at("name"));
    EXPECT_LE(a.at("cycle"), b.at("cycle"));
    while (first.status().at("cycle") == b.at("cycle")) {
        SocketClient::pause();
    }
    EXPECT_EQ(b.at("owner"), "") << "who only looks owns nothing";
}

TEST_F(LiveMachine, BelongsToWhoCommandsFirstAndMayBeStoppedByAnybody) {
    SocketClient owner{socket()};
    SocketClient other{socket()};
    EXPECT_EQ(owner.ask({{"do", "power-on"}, {"axis", "X"}, {"who", "panel"}}).at("is"), "done");
    owner.send({{"do", "heartbeat"}});
    const Json refused = other.ask({{"do", "power-on"}, {"axis", "Y"}});
    EXPECT_EQ(refused.at("is"), "refused");
    EXPECT_THAT(refused.at("error").get<std::string>(), HasSubstr("operated by panel (process "));
    EXPECT_EQ(other.axis("Y").at("powered"), false);
    EXPECT_EQ(other.ask({{"do", "stop"}}).at("is"), "done");
    EXPECT_EQ(other.awaitState("X", "Disabled").at("needsEnableEdge"), true);
}

TEST_F(LiveMachine, IsTakenOverWhenItsOwnerHasGone) {
    auto owner = std::make_unique<SocketClient>(socket());
    SocketClient heir{socket()};
    EXPECT_EQ(owner->ask({{"do", "power-on"}, {"axis", "X"}}).at("is"), "done");
    owner.reset();
    Json reply = heir.ask({{"do", "power-on"}, {"axis", "Y"}});
    while (reply.at("is") == "refused") {
        SocketClient::pause();
        EXPECT_THAT(reply.at("error").get<std::string>(),
                    AnyOf(HasSubstr("operated by"), HasSubstr("has just left")));
        reply = heir.ask({{"do", "power-on"}, {"axis", "Y"}});
    }
    EXPECT_EQ(reply.at("is"), "done");
    EXPECT_EQ(heir.axis("X").at("powered"), true) << "leaving switches nothing off";
}

TEST_F(LiveMachine, IsFreeWhenItsOwnerLeavesAndNobodyElseCanLeaveForHim) {
    SocketClient owner{socket()};
    SocketClient other{socket()};
    EXPECT_EQ(owner.ask({{"do", "power-on"}, {"axis", "X"}}).at("is"), "done");
    EXPECT_EQ(other.ask({{"do", "leave"}}).at("error"), "this client does not operate the machine");
    EXPECT_EQ(owner.ask({{"do", "leave"}}).at("is"), "done");
    EXPECT_EQ(other.status().at("owner"), "");
    EXPECT_EQ(other.ask({{"do", "power-on"}, {"axis", "Y"}}).at("is"), "done");
}

TEST_F(LiveMachine, StopsTheAxisWhoseOwnerDisconnects) {
    auto owner = std::make_unique<SocketClient>(socket());
    SocketClient watcher{socket()};
    sendOnALongWay(*owner);
    watcher.awaitState("X", "DiscreteMotion");
    owner.reset();
    const Json axis = watcher.awaitState("X", "Standstill");
    EXPECT_LT(axis.at("set"), 120.0 + 249.0);
    EXPECT_EQ(watcher.status().at("owner"), "");
}

TEST_F(LiveMachine, StopsTheAxisWhoseOwnerIsSilent) {
    SocketClient owner{socket()};
    SocketClient watcher{socket()};
    const int inch = sendOnALongWay(owner);
    watcher.awaitState("X", "DiscreteMotion");
    const Json axis = watcher.awaitState("X", "Standstill");
    EXPECT_LT(axis.at("set"), 120.0 + 249.0);
    EXPECT_NE(owner.await(inch).at("is"), "refused");
    EXPECT_THAT(watcher.events(), Contains("axis X stops: no sign of life from the operator"));
}

TEST_F(LiveMachine, TakesNoSignOfLifeFromSomebodyElse) {
    SocketClient owner{socket()};
    SocketClient other{socket()};
    sendOnALongWay(owner);
    other.awaitState("X", "DiscreteMotion");
    while (other.axis("X").at("state") != "Standstill") {
        SocketClient::pause();
        other.send({{"do", "heartbeat"}});
        EXPECT_NE(other.ask({{"do", "upload"}, {"device", "x"}, {"object", "0x6064:0"}}).at("is"),
                  "refused");
    }
    EXPECT_THAT(other.events(), Contains("axis X stops: no sign of life from the operator"));
}

TEST_F(LiveMachine, HasRoomForSixteenClients) {
    std::vector<std::unique_ptr<SocketClient>> clients;
    for (int i = 0; i < 16; ++i) {
        clients.push_back(std::make_unique<SocketClient>(socket()));
        EXPECT_EQ(clients.back()->status().at("machine"), "gantry");
    }
    SocketClient tooMany{socket()};
    const Json refused = tooMany.receive();
    EXPECT_EQ(refused.at("is"), "refused");
    EXPECT_EQ(refused.at("error"), "too many clients");
    EXPECT_TRUE(tooMany.receive().is_null()) << "and the connection is closed";
    clients.pop_back();
    for (bool served = false; !served;) {
        SocketClient next{socket()};
        next.send({{"do", "status"}});
        const Json line = next.receive();
        served = line.at("is") == "done";
    }
}

TEST_F(LiveMachine, DropsAClientWhoseLineNeverEnds) {
    SocketClient client{socket()};
    client.sendRaw(std::string(10'000, 'x'));
    const Json refused = client.receive();
    EXPECT_EQ(refused.at("is"), "refused");
    EXPECT_EQ(refused.at("error"), "a request is longer than 4096 characters");
    EXPECT_TRUE(client.receive().is_null());
    EXPECT_EQ(SocketClient{socket()}.status().at("machine"), "gantry");
}

TEST_F(LiveMachine, RefusesGarbageLineByLineAndGoesOn) {
    const std::array<std::string, 8> garbage{"hello",
                                             "[1,2,3]",
                                             std::string("\0\0\xff\xfe", 4),
                                             std::string(4000, '['),
                                             "{\"do\":7}",
                                             "{\"id\":-1,\"do\":\"status\"}",
                                             "{\"id\":1}",
                                             "{\"do\":\"inch\",\"axis\":\"X\",\"distance\":1e999}"};
    SocketClient client{socket()};
    for (const std::string& line : garbage) {
        client.sendRaw(line + "\n");
        const Json reply = client.receive();
        ASSERT_FALSE(reply.is_null()) << line;
        EXPECT_EQ(reply.at("is"), "refused") << line;
        EXPECT_NE(reply.at("error"), "") << line;
    }
    EXPECT_EQ(client.ask({{"do", "fly"}}).at("error"), "there is no request 'fly'");
    EXPECT_EQ(client.ask({{"do", "home"}, {"axis", "Q"}}).at("error"),
              "there is no axis 'Q'; allowed: X, Y, Z");
    EXPECT_EQ(client.status().at("machine"), "gantry");
}

TEST_F(LiveMachine, AnswersRequestsThatComeInPieces) {
    SocketClient client{socket()};
    client.sendRaw("{\"id\":77,\"do\":");
    EXPECT_EQ(SocketClient{socket()}.status().at("machine"), "gantry");
    client.sendRaw("\"status\"}\n{\"id\":78,\"do\":\"status\"}\n");
    EXPECT_EQ(client.receive().at("id"), 77);
    EXPECT_EQ(client.receive().at("id"), 78);
}

TEST_F(LiveMachine, TellsEventsInOrderAndOnlyTheNewOnes) {
    SocketClient client{socket()};
    const Json before = client.ask({{"do", "events"}}).at("events");
    ASSERT_FALSE(before.empty());
    const auto last = before.back().at("number").get<int>();
    EXPECT_EQ(client.ask({{"do", "power-on"}, {"axis", "Z"}}).at("is"), "done");
    std::vector<std::string> texts;
    int number = last;
    while (texts.empty() || texts.back() != "axis Z Disabled -> Standstill") {
        SocketClient::pause();
        const Json reply = client.ask({{"do", "events"}, {"after", number}});
        for (const Json& event : reply.at("events")) {
            EXPECT_EQ(event.at("number"), ++number);
            texts.push_back(event.at("text"));
        }
    }
    EXPECT_EQ(texts.front(), "command power-on Z");
}

TEST_F(LiveMachine, EndsConnectionsInOrder) {
    SocketClient client{socket()};
    EXPECT_EQ(client.status().at("machine"), "gantry");
    machine_->terminate();
    EXPECT_TRUE(client.receive().is_null());
    EXPECT_THROW(SocketClient{socket()}, std::runtime_error) << "the socket is gone";
}

TEST_F(LiveMachine, RefusesTheRequestsOfAClientThatFloodsItButNotItsStop) {
    SocketClient flood{socket()};
    SocketClient other{socket()};
    constexpr int many = 4000;
    std::string lines;
    for (int i = 0; i < many; ++i) lines += "{\"id\":1,\"do\":\"heartbeats\"}\n";
    flood.sendRaw(lines);
    int tooMany = 0;
    for (int i = 0; i < many; ++i) {
        const Json reply = flood.receive();
        ASSERT_EQ(reply.at("is"), "refused");
        if (reply.at("error") == "too many requests; allowed: 500 in a second") ++tooMany;
    }
    EXPECT_GT(tooMany, 0);
    EXPECT_EQ(flood.ask({{"do", "stop"}}).at("is"), "done");
    EXPECT_EQ(other.status().at("machineStop"), "operator");
}

TEST(Rate, LetsThroughSoManyInASecondAndAsManyAtOnceAfterAPause) {
    using namespace std::chrono_literals;
    daemon::RateLimit::Time now{};
    daemon::RateLimit limit{10, now};
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(limit.take(now)) << i;
    EXPECT_FALSE(limit.take(now));
    EXPECT_FALSE(limit.take(now += 99ms));
    EXPECT_TRUE(limit.take(now += 1ms));
    EXPECT_FALSE(limit.take(now));
    now += 1h;
    int passed = 0;
    while (limit.take(now)) ++passed;
    EXPECT_EQ(passed, 10) << "a long pause is not saved up";
}

TEST(ProgramReset, IsRefusedWhileAnAxisMovesAndGivesAFreshProgramOtherwise) {
    RunningTakt machine{"live_reset", {"run", Gantry, "--sim", "--program", programPath("counts")}};
    SocketClient watcher{machine.socket()};
    const auto program = [&watcher] { return watcher.status().at("programs").at(0); };
    while (program().at("watches").at("calls") < 50.0) {
        SocketClient::pause();
    }
    watcher.awaitState("X", "DiscreteMotion");
    const auto refused = machine.tell({"program", "reset", "counts"});
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_THAT(refused.output, HasSubstr("axis X moves; do: stop it first"));
    EXPECT_EQ(program().at("state"), "running");

    EXPECT_EQ(machine.tell({"program", "stop", "counts"}).exitCode, 0);
    watcher.awaitState("X", "Standstill");
    const auto reset = machine.tell({"program", "reset", "counts"});
    EXPECT_EQ(reset.exitCode, 0) << reset.output;
    while (program().at("watches").at("calls") != 0.0) {
        SocketClient::pause();
    }
    EXPECT_EQ(program().at("state"), "stopped");
    EXPECT_EQ(program().at("watches").at("instance"), 3.0) << "the second one was refused";
    EXPECT_EQ(machine.tell({"program", "start", "counts"}).exitCode, 0);
    watcher.awaitState("X", "DiscreteMotion");
    const auto result = machine.terminate();
    EXPECT_THAT(result.output, Not(HasSubstr("ErrorStop")));
}

TEST(Peers, AreThisUserRootAndMembersOfItsGroup) {
    using daemon::mayConnect;
    const std::array<unsigned, 2> none{7, 8};
    const std::array<unsigned, 2> member{7, 200};
    EXPECT_TRUE(mayConnect({100, 1}, none, {100, 200})) << "the user";
    EXPECT_TRUE(mayConnect({0, 0}, none, {100, 200})) << "root";
    EXPECT_TRUE(mayConnect({101, 200}, none, {100, 200})) << "his group";
    EXPECT_TRUE(mayConnect({101, 1}, member, {100, 200})) << "a member of it";
    EXPECT_FALSE(mayConnect({101, 1}, none, {100, 200})) << "a stranger";
    EXPECT_FALSE(mayConnect({200, 100}, {}, {100, 200})) << "numbers of another kind";
}

}  // namespace
}  // namespace takt::test
