#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <thread>

#include "machine_files.hpp"
#include "running_takt.hpp"
#include "takt_process.hpp"
#include "trace_file.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// CiA 402: bits of a statusword that tell the state, and Operation enabled.
constexpr unsigned StateMask = 0x6FU;
constexpr unsigned OperationEnabled = 0x27U;

struct Ending {
    ProcessResult result;
    TraceFile trace;
};

/// Runs the gantry until the program raises a signal in a phase of its motion.
Ending endIn(const std::string& phase, const std::vector<std::string>& environment = {},
             const std::string& machine = Gantry) {
    const std::string folder =
        freshFolder("shutdown_" + phase + std::to_string(environment.size()));
    std::vector<std::string> settings{"TAKT_TEST_PHASE=" + phase};
    settings.insert(settings.end(), environment.begin(), environment.end());
    auto result = runTakt({"run", machine, "--fast", "--program", programPath("signals"), "--for",
                           "20s", "--trace", "t.csv"},
                          folder, settings);
    TraceFile trace{folder + "/t.csv"};
    // No axis follows set-points before it is on, nor while the drive homes by itself.
    if (phase == "enable" || phase == "homing") return {std::move(result), std::move(trace)};
    const auto judged =
        runCommand({"python3", std::string{TAKT_SOURCE_DIR} + "/tests/machine/continuity.py",
                    "t.csv", "--machine", machine},
                   folder);
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
    return {std::move(result), std::move(trace)};
}

void expectDisabledAtTheEnd(const Ending& ending) {
    for (const char* axis : {"X", "Y", "Z"}) {
        const auto status = static_cast<unsigned>(
            std::strtoul(ending.trace.last(std::string{axis} + ".statusword").c_str(), nullptr, 0));
        EXPECT_NE(status & StateMask, OperationEnabled) << axis;
        EXPECT_EQ(ending.trace.last(std::string{axis} + ".state"), "Disabled") << axis;
    }
}

class Interrupt : public testing::TestWithParam<const char*> {};

TEST_P(Interrupt, StopsTheAxesWithinTheirLimitsAndDisablesThem) {
    const Ending ending = endIn(GetParam());
    EXPECT_EQ(ending.result.exitCode, 130) << ending.result.output;
    EXPECT_THAT(ending.result.output, HasSubstr(" 0 lost"));
    ASSERT_GT(ending.trace.size(), 0U);
    expectDisabledAtTheEnd(ending);
    EXPECT_FALSE(ending.trace.everWas("X.state", "ErrorStop"));
    EXPECT_NEAR(ending.trace.number(ending.trace.size() - 1, "X.actualVel"), 0.0,
                3.0);  // one count and a half
}

INSTANTIATE_TEST_SUITE_P(InEveryPhase, Interrupt,
                         testing::Values("enable", "homing", "acceleration", "constant",
                                         "deceleration", "standstill"),
                         [](const auto& phase) { return std::string{phase.param}; });

TEST(Shutdown, TheAxisGoesThroughStoppingAndNeverJumpsToRest) {
    const Ending ending = endIn("constant");
    EXPECT_TRUE(ending.trace.everWas("X.state", "Stopping"));
    double before = 0.0;
    for (std::size_t row = 0; row < ending.trace.size(); ++row) {
        const double velocity = ending.trace.number(row, "X.setVel");
        // 6000 mm/s² of the stop ramp are 6 mm/s in a cycle; 300 mm/s cannot go in one.
        EXPECT_LE(before - velocity, 6.001) << "row " << row;
        before = velocity;
    }
}

TEST(Shutdown, AHangUpOfTheTerminalIsAControlledStopToo) {
    const Ending ending = endIn("constant", {"TAKT_TEST_SIGNAL=1"});
    EXPECT_EQ(ending.result.exitCode, 129) << ending.result.output;
    EXPECT_TRUE(ending.trace.everWas("X.state", "Stopping"));
    expectDisabledAtTheEnd(ending);
}

TEST(Shutdown, ASuspendKeyAndAClosedPipeDoNotTouchTheMachine) {
    for (const char* number : {"TAKT_TEST_SIGNAL=13", "TAKT_TEST_SIGNAL=20"}) {
        const auto result =
            runTakt({"run", Gantry, "--fast", "--program", programPath("signals"), "--for", "3s"},
                    TAKT_BINARY_DIR, {"TAKT_TEST_PHASE=constant", number});
        EXPECT_EQ(result.exitCode, 0) << number << "\n" << result.output;
    }
}

TEST(Shutdown, ASecondSignalLetsTheDriveStopQuickly) {
    const std::string folder = freshFolder("shutdown_second");
    const auto result = runTakt({"run", Gantry, "--fast", "--program", programPath("signals"),
                                 "--for", "20s", "--trace", "t.csv"},
                                folder, {"TAKT_TEST_PHASE=constant", "TAKT_TEST_COUNT=2"});
    EXPECT_EQ(result.exitCode, 130) << result.output;
    const TraceFile trace{folder + "/t.csv"};
    // Quick stop: enable voltage without bit 2 (CiA 402 controlword 0x0002).
    bool quick = false;
    for (std::size_t row = 0; row < trace.size(); ++row) {
        const unsigned long control =
            std::strtoul(trace.at(row, "X.controlword").c_str(), nullptr, 0);
        const bool running = (std::strtoul(trace.at(row, "X.statusword").c_str(), nullptr, 0) &
                              StateMask) == OperationEnabled;
        quick = quick || (running && (control & 0x87U) == 0x02U);
    }
    EXPECT_TRUE(quick);
}

TEST(Shutdown, ASignalDuringBringUpBreaksItOffAndLeadsTheNetworkToInit) {
    // The capture goes into a pipe that nobody empties, so that the bring-up stands in its middle.
    const std::string pipe = freshFolder("shutdown_bring_up") + "/capture";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    const int size = ::fcntl(reader, F_SETPIPE_SZ, 4096);
    ASSERT_GT(size, 0);
    RunningTakt machine{"shutdown_bring_up_run",
                        {"run", Gantry, "--sim", "--manual", "--pcap", pipe}};
    for (int waiting = 0; waiting < size / 2; ::poll(nullptr, 0, 1))
        ASSERT_EQ(::ioctl(reader, FIONREAD, &waiting), 0);
    machine.signal(SIGINT);
    std::thread drain{[reader] {
        ::fcntl(reader, F_SETFL, 0);
        std::array<char, 4096> buffer{};
        while (::read(reader, buffer.data(), buffer.size()) > 0) {
        }
    }};
    const auto result = machine.end();
    drain.join();
    ::close(reader);
    EXPECT_EQ(result.exitCode, 130) << result.output;
    EXPECT_THAT(result.output, HasSubstr("broken off; all devices were sent to INIT"));
    EXPECT_THAT(result.output, Not(HasSubstr("network in OP")));
}

TEST(Shutdown, NamesTheErrorStopOfAnAxisAlsoWhenASignalEndsTheRun) {
    const std::string folder = freshFolder("shutdown_error_stop");
    writeFile(folder + "/faults.xml",
              "<Faults><LostFrames cycle=\"400\" cycles=\"6\"/></Faults>\n");
    RunningTakt machine{"shutdown_error_stop_run",
                        {"run", Gantry, "--sim", "--program", programPath("signals"), "--faults",
                         folder + "/faults.xml"},
                        {"TAKT_TEST_PHASE=never"}};
    SocketClient{machine.socket()}.awaitState("X", "ErrorStop");
    machine.signal(SIGINT);
    const auto result = machine.end();
    EXPECT_EQ(result.exitCode, 130) << result.output;
    EXPECT_THAT(result.output, HasSubstr("axis X ended in ErrorStop"));
}

TEST(Shutdown, NamesTheAxisThatDoesNotStopInTime) {
    const std::string machine =
        changedMachine("shutdown_slow", "stopDeceleration=\"6000 mm/s^2\"",
                       "stopDeceleration=\"10 mm/s^2\"");  // from 100 mm/s: 11 s
    const auto result =
        runTakt({"run", machine, "--fast", "--program", programPath("signals"), "--for", "30s"},
                TAKT_BINARY_DIR, {"TAKT_TEST_PHASE=acceleration"});
    EXPECT_EQ(result.exitCode, 5) << result.output;
    EXPECT_THAT(result.output, HasSubstr("axis X did not stop and power off within 10 s"));
    EXPECT_THAT(result.output, Not(HasSubstr("axis Y did not")));
}

TEST(Shutdown, GoesOnWhenItsOutputIsClosed) {
    // The shell's reader ends after one line; the run itself must not.
    const std::string folder = freshFolder("shutdown_pipe");
    const auto result = runCommand(
        {"bash", "-c",
         std::string{TAKT_BINARY_DIR} + "/takt run " + Gantry +
             " --fast --trace t.csv | head -n 1 > /dev/null; " + "echo run ${PIPESTATUS[0]}"},
        folder);
    EXPECT_THAT(result.output, HasSubstr("run 0"));
    EXPECT_EQ(TraceFile{folder + "/t.csv"}.last("X.state"), "Disabled");
}

}  // namespace
}  // namespace takt::test
