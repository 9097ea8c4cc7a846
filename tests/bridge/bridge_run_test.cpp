// The bridge of a paced machine, seen from other processes. Takes wall time, but no rule depends on
// how fast this computer is: what is counted is counted in cycles.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <future>
#include <map>
#include <random>
#include <sstream>

#include "bridged_takt.hpp"
#include "dds_client.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::size_t Stations = 16;
constexpr double StartTime = 20.0;  ///< s, more than any start takes

const std::string Wave = std::string{TAKT_BINARY_DIR} + "/test_programs/endless_wave.so";

std::vector<std::string> arguments(const OwnMachine& machine, const std::string& length,
                                   const std::vector<std::string>& more) {
    std::vector<std::string> words{"run",      machine.file,   "--for",   length,
                                   "--socket", machine.socket, "--trace", "t.csv"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// The same machine without any bridge, as fast as it goes, judged; made while the other one runs.
class UndisturbedRun {
public:
    UndisturbedRun(const OwnMachine& machine, const std::string& length, const std::string& folder)
        : folder_{folder}, judged_{std::async(std::launch::async, [=] {
              const std::string judge =
                  std::string{TAKT_SOURCE_DIR} + "/tests/machine/continuity.py";
              const auto run = runTakt({"run", machine.file, "--for", length, "--fast", "--program",
                                        Wave, "--trace", "undisturbed.csv"},
                                       folder);
              if (run.exitCode != 0) return run;
              return runCommand({"python3", judge, "undisturbed.csv", "--machine", machine.file},
                                folder);
          })} {}

    /// The trace of the other run is the same, byte for byte.
    void expectSame() {
        const ProcessResult judged = judged_.get();
        EXPECT_EQ(judged.exitCode, 0) << judged.output;
        const auto same = runCommand({"cmp", "t.csv", "undisturbed.csv"}, folder_);
        EXPECT_EQ(same.exitCode, 0) << same.output;
    }

private:
    std::string folder_;
    std::future<ProcessResult> judged_;
};

void expectAnArmedTrapThatFoundNothing(const std::string& folder, const ProcessResult& result) {
    EXPECT_NE(result.exitCode, 99) << result.output;
    if (readFile(std::string{TAKT_BINARY_DIR} + "/libtakt_trap.so").empty()) return;
    const std::string report = readFile(folder + "/trap.txt");
    EXPECT_THAT(report, HasSubstr("no hit"));
    const std::string before = "armed ";
    ASSERT_EQ(report.compare(0, before.size(), before), 0) << report;
    EXPECT_GT(std::stoul(report.substr(before.size())), 10000U);
}

std::string procFile(pid_t pid, const std::string& name) {
    return readFile("/proc/" + std::to_string(pid) + "/" + name);
}

/// Of one axis, as a subscriber wrote them down.
struct Series {
    std::vector<std::uint64_t> cycles;
};

std::map<std::string, Series> readSeries(const std::string& csv) {
    std::map<std::string, Series> series;
    std::istringstream text{csv};
    std::string line;
    std::getline(text, line);
    while (std::getline(text, line)) {
        std::istringstream cells{line};
        std::string machine;
        std::string axis;
        std::string cycle;
        std::getline(cells, machine, ',');
        std::getline(cells, axis, ',');
        std::getline(cells, cycle, ',');
        series[axis].cycles.push_back(std::stoull(cycle));
    }
    return series;
}

TEST(Bridge, GivesASubscriberEverySampleOfSixteenAxes) {
    const std::string folder = freshFolder("bridge_samples");
    const OwnMachine machine = ownMachine(folder, "rate=\"100 Hz\"");
    BridgedTakt takt{arguments(machine, "11s", {"--sim", "--program", Wave}), folder};
    UndisturbedRun undisturbed{machine, "11s", folder};
    // Cycles are the clock of both: 10 s are 10000 of them, however long they take here.
    const auto subscriber = runCommand({"sh", "-c",
                                        "timeout 60 " TAKT_BINARY_DIR "/dds_subscriber " +
                                            std::to_string(machine.domain) + " 10 > samples.csv"},
                                       folder);
    EXPECT_EQ(subscriber.exitCode, 0) << subscriber.output;
    EXPECT_THAT(subscriber.output, HasSubstr("axis S16 Disabled -> Standstill"));
    const ProcessResult result = takt.finish();
    EXPECT_EQ(result.exitCode, 0) << result.output;
    const auto series = readSeries(readFile(folder + "/samples.csv"));
    EXPECT_EQ(series.size(), Stations);
    for (const auto& [axis, seen] : series) {
        EXPECT_GE(seen.cycles.size(), 950U) << axis;
        for (std::size_t i = 1; i < seen.cycles.size(); ++i) {
            EXPECT_GT(seen.cycles[i], seen.cycles[i - 1]) << axis;
            EXPECT_LE(seen.cycles[i] - seen.cycles[i - 1], 50U) << axis;
        }
    }
    expectAnArmedTrapThatFoundNothing(folder, result);
    undisturbed.expectSame();
}

TEST(Bridge, MayBeKilledAtAnyInstantWithoutAnEffectOnTheMachine) {
    constexpr double shortest = 0.2;
    constexpr double longest = 1.0;
    const std::string folder = freshFolder("bridge_killed");
    const OwnMachine machine = ownMachine(folder);
    DdsClient client{machine.domain, machine.name, 1};
    BridgedTakt takt{arguments(machine, "30s", {"--sim", "--program", Wave}), folder};
    UndisturbedRun undisturbed{machine, "30s", folder};

    std::mt19937 random{20250};  // NOLINT: a fixed seed is what is wanted
    const auto interval = [&random] {
        const double share = static_cast<double>(random()) / static_cast<double>(random.max());
        return shortest + share * (longest - shortest);
    };
    int kills = 0;
    int attachedKills = 0;
    std::uint64_t killedWriter = 0;
    for (double next = now() + interval(); !takt.ended(); pauseFor(0.005)) {
        client.listen();
        if (now() < next) continue;
        next = now() + interval();
        const pid_t bridge = takt.bridge();
        if (bridge == 0) continue;
        client.listen();
        // Samples of this very bridge have come.
        const bool attached = client.lastWriter() != killedWriter;
        ::kill(bridge, SIGKILL);
        killedWriter = client.lastWriter();
        ++kills;
        if (attached) ++attachedKills;
    }
    const ProcessResult result = takt.finish();
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_GE(attachedKills, 20) << "of " << kills;
    RecordProperty("kills", kills);
    RecordProperty("attachedKills", attachedKills);
    expectAnArmedTrapThatFoundNothing(folder, result);
    undisturbed.expectSame();
}

TEST(Bridge, IsAProcessWithoutRightsAndTheMachineOneWithoutDds) {
    const std::string folder = freshFolder("bridge_rights");
    const OwnMachine machine = ownMachine(folder);
    DdsClient client{machine.domain, machine.name, 1};
    BridgedTakt takt{arguments(machine, "60s", {"--sim", "--program", Wave}), folder};
    ASSERT_TRUE(waitFor(
        [&] {
            client.listen();
            return client.machineSamples() > 0;
        },
        StartTime));
    const pid_t bridge = takt.bridge();
    ASSERT_NE(bridge, 0);
    const std::string status = procFile(bridge, "status");
    for (const char* set : {"CapInh", "CapPrm", "CapEff", "CapAmb"}) {
        EXPECT_THAT(status, HasSubstr(std::string{set} + ":\t0000000000000000"));
    }
    EXPECT_THAT(status, HasSubstr("NoNewPrivs:\t1"));
    EXPECT_THAT(status, Not(HasSubstr("Uid:\t0\t")));
    EXPECT_THAT(procFile(takt.pid(), "maps"), HasSubstr("takt-status"));
    EXPECT_THAT(procFile(takt.pid(), "maps"), Not(HasSubstr("libddsc")));
    EXPECT_THAT(procFile(takt.pid(), "cmdline"), HasSubstr("takt"));

    // Even where nothing of the daemon runs any more, nothing of the bridge stays behind.
    takt.kill(SIGKILL);
    EXPECT_EQ(takt.finish().exitCode, 128 + SIGKILL);
    const auto isGone = [bridge] {
        const std::string left = procFile(bridge, "status");
        return left.empty() || left.find("State:\tZ") != std::string::npos;
    };
    EXPECT_TRUE(waitFor(isGone, StartTime));
}

TEST(Bridge, ThatHangsIsStartedAnew) {
    const std::string folder = freshFolder("bridge_hangs");
    const OwnMachine machine = ownMachine(folder);
    DdsClient client{machine.domain, machine.name, 1};
    BridgedTakt takt{arguments(machine, "60s", {"--sim", "--program", Wave}), folder};
    const auto heardOf = [&client](const std::string& text) {
        return waitFor(
            [&] {
                client.listen();
                return client.machineSamples() > 0 && client.heardOf(text);
            },
            StartTime);
    };
    ASSERT_TRUE(heardOf("bridge started"));
    const pid_t bridge = takt.bridge();
    const auto watched = runTakt({"watch", "--once", "--socket", machine.socket}, folder);
    EXPECT_THAT(watched.output, HasSubstr("bridge process " + std::to_string(bridge)));
    ::kill(bridge, SIGSTOP);
    EXPECT_TRUE(heardOf("process " + std::to_string(bridge) + ", ended by signal 9"));
    EXPECT_NE(takt.bridge(), bridge);
}

TEST(Bridge, IsToldByTheCheckOfAMachine) {
    const std::string folder = freshFolder("bridge_check");
    const OwnMachine machine = ownMachine(folder, "rate=\"50 Hz\"");
    const auto checked = runTakt({"check", machine.file}, folder);
    EXPECT_EQ(checked.exitCode, 0) << checked.output;
    EXPECT_THAT(checked.output, HasSubstr("bridge: DDS domain " + std::to_string(machine.domain) +
                                          " on lo, status at 50 Hz, commands off"));
}

TEST(Bridge, ThatCannotWorkIsTriedAgainAndTheMachineRuns) {
    const std::string folder = freshFolder("bridge_no_interface");
    const OwnMachine machine = ownMachine(folder, "interface=\"nosuch0\"");
    const auto result = runTakt(arguments(machine, "1s", {"--sim", "--program", Wave}), folder);
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("on interface 'nosuch0': no domain"));
    std::size_t tries = 0;
    for (std::size_t at = 0; (at = result.output.find("takt-bridge: DDS", at)) != std::string::npos;
         ++at) {
        ++tries;
    }
    // 50 ms, then twice as long each time.
    EXPECT_GE(tries, 2U);
    EXPECT_LE(tries, 6U);
}

}  // namespace
}  // namespace takt::test
