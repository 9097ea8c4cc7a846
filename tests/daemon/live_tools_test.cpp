#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "machine_files.hpp"
#include "running_takt.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = SocketClient::Json;

/// Waits until commands count.
void awaitOperation(const RunningTakt& machine) {
    SocketClient watcher{machine.socket()};
    while (watcher.status().at("phase") != "operating") {
        SocketClient::pause();
    }
}

TEST(LiveTools, ShowTheDevicesOfTheRunningMachine) {
    RunningTakt machine{"tools_show", {"run", Gantry, "--sim", "--manual"}};
    awaitOperation(machine);
    const auto slaves = machine.tell({"slaves"});
    EXPECT_EQ(slaves.exitCode, 0) << slaves.output;
    EXPECT_THAT(slaves.output, HasSubstr("z                 OP              RA"));
    const auto states = machine.tell({"states", "--slave", "y", "--json"});
    EXPECT_THAT(states.output, HasSubstr(R"("pos":1,"name":"y","state":"OP","error":false)"));
    const auto refused = machine.tell({"states", "INIT"});
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_THAT(refused.output, HasSubstr("a running machine leads its devices itself"));
    EXPECT_THAT(machine.terminate().output, HasSubstr(" 0 lost"));
}

TEST(LiveTools, ReadAndWriteObjectsBesideTheCycle) {
    RunningTakt machine{"tools_objects", {"run", Gantry, "--sim", "--manual"}};
    awaitOperation(machine);
    EXPECT_THAT(machine.tell({"upload", "x", "0x1018:2"}).output,
                HasSubstr("12779744  0x00C300E0  uint32  Product code"));
    EXPECT_EQ(machine.tell({"download", "0", "0x6065", "1234"}).exitCode, 0);
    EXPECT_THAT(machine.tell({"upload", "x", "0x6065"}).output, HasSubstr("1234  0x000004D2"));
    const auto aborted = machine.tell({"upload", "y", "0x9999"});
    EXPECT_EQ(aborted.exitCode, 2);
    EXPECT_THAT(aborted.output, HasSubstr("0x06020000 object does not exist"));
    const auto cyclic = machine.tell({"download", "x", "0x6040", "6", "--force"});
    EXPECT_EQ(cyclic.exitCode, 2);
    EXPECT_THAT(cyclic.output, HasSubstr("the cycle writes this object with the process data"));
    EXPECT_THAT(machine.terminate().output, HasSubstr("working counter errors 0"));
}

TEST(LiveTools, WriteNothingUnderARunningProgramUnlessForced) {
    RunningTakt machine{"tools_program",
                        {"run", Gantry, "--sim", "--program", programPath("signals")},
                        {"TAKT_TEST_PHASE=never"}};
    awaitOperation(machine);
    const auto refused = machine.tell({"download", "y", "0x6065", "1234"});
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_THAT(refused.output, HasSubstr("program 'signals' runs"));
    EXPECT_THAT(machine.tell({"upload", "y", "0x6065"}).output, Not(HasSubstr("0x000004D2")));
    EXPECT_EQ(machine.tell({"download", "y", "0x6065", "1234", "--force"}).exitCode, 0);
    EXPECT_THAT(machine.tell({"upload", "y", "0x6065"}).output, HasSubstr("0x000004D2"));
    EXPECT_EQ(machine.tell({"program", "stop", "signals"}).exitCode, 0);
    SocketClient{machine.socket()}.awaitState("X", "Standstill");
    EXPECT_EQ(machine.tell({"download", "y", "0x6065", "1235"}).exitCode, 0);
    machine.terminate();
}

TEST(LiveTools, TellHowCycleClocksAndDevicesAreDoing) {
    RunningTakt machine{"tools_diag", {"run", Gantry, "--sim", "--manual"}};
    awaitOperation(machine);
    const auto table = machine.tell({"diag"});
    EXPECT_EQ(table.exitCode, 0) << table.output;
    for (const char* expected : {"clock locked", "0 by the host, 0 by the bus", "wake-up late",
                                 "reply there", "cycle done", "off SYNC0 grid"}) {
        EXPECT_THAT(table.output, HasSubstr(expected));
    }
    EXPECT_THAT(table.output, HasSubstr("2  z       OP                        0  good"));
    const Json reply = Json::parse(machine.tell({"diag", "--json"}).output);
    const Json& network = reply.at("network");
    EXPECT_EQ(network.at("devices").size(), 3U);
    EXPECT_EQ(network.at("devices")[0].at("expected"), 9) << "three drives, read and written";
    EXPECT_EQ(network.at("devices")[0].at("wrong"), 0);
    std::uint64_t sum = 0;
    for (const Json& bin : network.at("reply").at("bins")) sum += bin.at("count").get<unsigned>();
    EXPECT_EQ(sum, network.at("reply").at("count"));
    EXPECT_EQ(sum, network.at("cycle"));
    machine.terminate();
}

TEST(LiveTools, NameTheDatagramWhoseRepliesWereLost) {
    const std::string folder = freshFolder("tools_lost_faults");
    writeFile(folder + "/faults.xml",
              "<Faults><LostFrames cycle=\"300\" cycles=\"2\"/></Faults>\n");
    RunningTakt machine{"tools_lost",
                        {"run", Gantry, "--sim", "--manual", "--faults", folder + "/faults.xml"}};
    SocketClient watcher{machine.socket()};
    while (watcher.status().at("cycle") < 310) {
        SocketClient::pause();
    }
    EXPECT_THAT(machine.tell({"diag"}).output,
                HasSubstr("no reply in 2 cycles; the same datagram serves x, z"));
    machine.terminate();
}

TEST(LiveTools, SayWhereTheyLookWhenNoMachineRunsThere) {
    for (const char* verb : {"slaves", "states", "diag"}) {
        const auto result = runTakt({verb, "--socket", "/nowhere/s.sock"}, TAKT_BINARY_DIR);
        EXPECT_EQ(result.exitCode, 2);
        EXPECT_THAT(result.output, HasSubstr("/nowhere/s.sock"));
        EXPECT_THAT(result.output, HasSubstr("is the machine running?"));
    }
}

}  // namespace
}  // namespace takt::test
