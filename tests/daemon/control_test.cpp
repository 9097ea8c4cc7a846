#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "machine_files.hpp"
#include "takt_process.hpp"
#include "trace_file.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A run without programs whose operator is a command file.
struct Operated {
    Operated(const std::string& name, const std::string& commands, const std::string& length,
             const std::string& machine = Gantry)
        : folder{freshFolder("control_" + name)} {
        writeFile(folder + "/in.txt", commands);
        result = runTakt({"run", machine, "--fast", "--manual", "--for", length, "--commands",
                          "in.txt", "--record-commands", "out.txt", "--trace", "t.csv"},
                         folder);
        EXPECT_EQ(result.exitCode, 0) << result.output;
        const auto judged =
            runCommand({"python3", std::string{TAKT_SOURCE_DIR} + "/tests/machine/continuity.py",
                        "t.csv", "--machine", machine},
                       folder);
        EXPECT_EQ(judged.exitCode, 0) << judged.output;
    }
    [[nodiscard]] TraceFile trace() const { return TraceFile{folder + "/t.csv"}; }

    std::string folder;
    ProcessResult result;
};

std::string heartbeats(int from, int to) {
    std::string text;
    for (int cycle = from; cycle < to; cycle += 50) text += std::to_string(cycle) + " heartbeat\n";
    return text;
}

/// X stands at 120 mm at the start.
constexpr double Start = 120.0;

TEST(Operator, MovesAnAxisByExactlyOneInch) {
    const Operated run{"inch", "200 power-on X\n300 inch X 2.5 50\n" + heartbeats(310, 800), "1s"};
    EXPECT_NEAR(run.trace().number(run.trace().size() - 1, "X.set"), Start + 2.5, 0.002);
    EXPECT_EQ(run.trace().at(320, "X.state"), "DiscreteMotion");
}

TEST(Operator, StopsTheAxisWhenNoSignOfLifeComesFor100Milliseconds) {
    const Operated run{"deadman", "200 power-on X\n300 inch X 200 100\n", "2s"};
    const TraceFile trace = run.trace();
    // The command itself is a sign of life; in cycle 401 it is more than 100 cycles old.
    EXPECT_DOUBLE_EQ(trace.number(399, "X.setVel"), trace.number(400, "X.setVel"));
    EXPECT_LT(trace.number(401, "X.setVel"), trace.number(400, "X.setVel"));
    EXPECT_LT(trace.number(trace.size() - 1, "X.set"), Start + 50.0);
    EXPECT_EQ(trace.number(1000, "X.setVel"), 0.0);
}

TEST(Operator, StopsTheAxisAtOnceWhenHeLeaves) {
    const Operated run{"leave", "200 power-on X\n300 inch X 200 100\n340 leave\n", "1s"};
    const TraceFile trace = run.trace();
    EXPECT_LT(trace.number(trace.size() - 1, "X.set"), Start + 10.0);
    EXPECT_EQ(trace.last("X.state"), "Disabled");
}

TEST(Operator, HomesAnAxisWhileHeGivesSignsOfLife) {
    const Operated run{"home", "200 power-on X\n300 home X\n" + heartbeats(350, 4000), "4s"};
    const TraceFile trace = run.trace();
    EXPECT_EQ(trace.at(400, "X.state"), "Homing");
    EXPECT_NEAR(trace.number(3900, "X.set"), 0.0, 0.01);
    EXPECT_EQ(trace.at(3900, "X.state"), "Standstill");
}

TEST(Operator, StopsAHomingWhenHeIsGone) {
    const Operated run{"home_lost", "200 power-on X\n300 home X\n", "2s"};
    const TraceFile trace = run.trace();
    EXPECT_EQ(trace.at(390, "X.state"), "Homing");
    EXPECT_NE(trace.at(900, "X.state"), "Homing");
    EXPECT_NEAR(trace.number(1500, "X.actualVel"), 0.0, 0.5);
    EXPECT_GT(trace.number(1500, "X.actual"), 20.0);  // far from the switch
}

TEST(Operator, SwitchesAnAxisOffInMotionOnItsRamp) {
    const Operated run{"off", "200 power-on X\n300 inch X 200 100\n350 power-off X\n", "1s"};
    const TraceFile trace = run.trace();
    EXPECT_EQ(trace.at(352, "X.state"), "Stopping");
    EXPECT_EQ(trace.at(900, "X.state"), "Disabled");
}

TEST(Operator, IsHeardInTheSameCyclesWhenTheCommandsAreReplayed) {
    const std::string commands = "200 power-on X\n300 inch X -3 20\n" + heartbeats(310, 700) +
                                 "700 stop\n" + "900 reset-stop\n950 power-on X\n";
    const Operated first{"replay_a", commands, "1500ms"};
    EXPECT_EQ(readFile(first.folder + "/out.txt"), commands);
    const Operated again{"replay_b", readFile(first.folder + "/out.txt"), "1500ms"};
    EXPECT_TRUE(readFile(first.folder + "/t.csv") == readFile(again.folder + "/t.csv"));
    EXPECT_EQ(first.trace().at(1200, "X.state"), "Standstill");
}

TEST(Operator, RefusedCommandsChangeNothing) {
    const std::string folder = freshFolder("control_refused");
    // All axes are held by the program; the inch is out of any range as well.
    writeFile(
        folder + "/in.txt",
        "150 power-off X\n1000 halt X\n1500 inch X 1e9 1e9\n2000 home Y\n2500 program-start pick\n"
        "3000 reset-stop\n4000 reset Z\n");
    const auto with =
        runTakt({"run", Gantry, "--fast", "--commands", "in.txt", "--trace", "a.csv"}, folder);
    const auto without = runTakt({"run", Gantry, "--fast", "--trace", "b.csv"}, folder);
    EXPECT_EQ(with.exitCode, 0) << with.output;
    EXPECT_EQ(without.exitCode, 0) << without.output;
    EXPECT_TRUE(readFile(folder + "/a.csv") == readFile(folder + "/b.csv"));
}

TEST(Operator, StopsAProgramOnItsPathAndLetsItGoOn) {
    const std::string folder = freshFolder("control_program");
    writeFile(folder + "/in.txt", "400 program-stop signals\n1500 program-start signals\n");
    const auto result = runTakt({"run", Gantry, "--fast", "--program", programPath("signals"),
                                 "--for", "3s", "--commands", "in.txt", "--trace", "t.csv"},
                                folder, {"TAKT_TEST_PHASE=never"});
    EXPECT_EQ(result.exitCode, 0) << result.output;
    const TraceFile trace{folder + "/t.csv"};
    EXPECT_GT(trace.number(399, "X.setVel"), 100.0);
    EXPECT_EQ(trace.at(401, "X.state"), "Stopping");
    EXPECT_EQ(trace.at(1400, "X.state"), "Standstill");
}

TEST(Operator, ResetsAProgramAndStartsItAfresh) {
    const std::string folder = freshFolder("control_program_reset");
    // The first reset comes in motion and is refused: the program goes on as if nothing was.
    writeFile(folder + "/in.txt",
              "380 program-reset signals\n400 program-stop signals\n1500 program-reset signals\n"
              "1600 program-start signals\n");
    const auto result =
        runTakt({"run", Gantry, "--fast", "--program", programPath("signals"), "--for", "3s",
                 "--commands", "in.txt", "--record-commands", "out.txt", "--trace", "t.csv"},
                folder, {"TAKT_TEST_PHASE=never"});
    EXPECT_EQ(result.exitCode, 0) << result.output;
    const TraceFile trace{folder + "/t.csv"};
    EXPECT_EQ(trace.at(399, "X.state"), "DiscreteMotion");
    EXPECT_EQ(trace.at(1598, "X.state"), "Standstill");
    // A program that only goes on would find its move aborted and stay where it is.
    EXPECT_EQ(trace.at(1700, "X.state"), "DiscreteMotion");
    EXPECT_NEAR(trace.number(2990, "X.set"), trace.number(1598, "X.set") + 200.0, 0.01);
    EXPECT_EQ(readFile(folder + "/out.txt"), readFile(folder + "/in.txt"));
    const auto judged =
        runCommand({"python3", std::string{TAKT_SOURCE_DIR} + "/tests/machine/continuity.py",
                    "t.csv", "--machine", Gantry},
                   folder);
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
}

TEST(Operator, GivesAFailedProgramAnotherTry) {
    const std::string folder = freshFolder("control_program_again");
    const std::string machine = changedMachine(
        "control_two_programs", "<Program name=\"pick\" library=\"libgantry.so\"",
        "<Program name=\"fails\" library=\"" + programPath("fails") +
            "\"/>\n  <Program name=\"signals\" library=\"" + programPath("signals") + "\"");
    writeFile(folder + "/in.txt", "500 program-reset fails\n600 program-start fails\n");
    const auto result = runTakt({"run", machine, "--fast", "--for", "2s", "--commands", "in.txt"},
                                folder, {"TAKT_TEST_PHASE=never"});
    EXPECT_EQ(result.exitCode, 3) << "a failure counts, whatever came after";
    const std::string words = "failed: no part in the gripper";
    const std::size_t first = result.output.find(words);
    ASSERT_NE(first, std::string::npos) << result.output;
    EXPECT_NE(result.output.find(words, first + 1), std::string::npos) << result.output;
}

TEST(Operator, WritesObjectsInTheSameCyclesWhenTheCommandsAreReplayed) {
    const std::string commands =
        "200 download x 0x6065:0 E8030000\n260 upload x 0x6065:0\n300 power-on X\n"
        "400 download y 0x6065:0 E8030000 force\n";
    const Operated first{"objects_a", commands, "1s"};
    EXPECT_EQ(readFile(first.folder + "/out.txt"), commands);
    const Operated again{"objects_b", readFile(first.folder + "/out.txt"), "1s"};
    EXPECT_TRUE(readFile(first.folder + "/t.csv") == readFile(again.folder + "/t.csv"));
}

TEST(CommandFile, IsRefusedWithLineAndReason) {
    const std::string folder = freshFolder("control_file");
    writeFile(folder + "/in.txt",
              "# a comment\n100 jump X\n200 inch Q 1 1\n300 inch X 1\n150 halt X\n100 halt X\n400 "
              "stop now\nx stop\n"
              "500 inch X nan 1\n");
    const auto result = runTakt(
        {"run", Gantry, "--fast", "--manual", "--for", "1s", "--commands", "in.txt"}, folder);
    EXPECT_EQ(result.exitCode, 1);
    for (const char* expected :
         {"in.txt:2: there is no order 'jump'", "in.txt:3: there is no 'Q'; allowed: X, Y, Z",
          "in.txt:4: expected: distance and velocity", "in.txt:6: cycle 100 comes after cycle 150",
          "in.txt:7: 'now' is too much", "in.txt:8: expected: CYCLE ORDER",
          "in.txt:9: expected: distance"}) {
        EXPECT_THAT(result.output, HasSubstr(expected));
    }
}

TEST(MachineStop, ByAProgramHoldsUntilResetAndANewEdgeOfEnable) {
    const std::string folder = freshFolder("control_stop_program");
    const auto result = runTakt({"run", Gantry, "--fast", "--program", programPath("control_probe"),
                                 "--for", "20s", "--trace", "t.csv"},
                                folder);
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("by program 'control_probe': guard door open"));
    EXPECT_THAT(result.output, HasSubstr("machine stop reset"));
    EXPECT_TRUE(TraceFile{folder + "/t.csv"}.everWas("X.state", "Stopping"));
}

TEST(MachineStop, ByAnInputStopsTheMachineAndCannotBeResetWhileItIsActive) {
    // Bit 2 of 60FDh is the home switch of Z; homing runs onto it.
    const std::string machine =
        changedMachine("stop_input_machine", "<Program ",
                       "<MachineStop><Input slave=\"z\" index=\"0x60FD\" bit=\"2\" "
                       "active=\"high\"/></MachineStop>\n  <Program ");
    const Operated run{"stop_input",
                       "200 power-on Z\n300 home Z\n" + heartbeats(350, 4000) +
                           "4000 reset-stop\n4100 power-on Z\n",
                       "5s", machine};
    EXPECT_THAT(run.result.output, HasSubstr("by input 'z 60FDh bit 2'"));
    EXPECT_THAT(run.result.output, Not(HasSubstr("machine stop reset")));
    EXPECT_EQ(run.trace().last("Z.state"), "Disabled");
    EXPECT_FALSE(run.trace().everWas("Z.state", "ErrorStop"));
}

TEST(MachineStop, ByTheOperatorStopsTheAxisThatMoves) {
    const Operated run{"stop", "200 power-on X\n200 power-on Y\n300 inch X 200 100\n350 stop\n",
                       "1s"};
    const TraceFile trace = run.trace();
    EXPECT_EQ(trace.at(350, "X.state"), "Stopping");
    EXPECT_EQ(trace.at(350, "Y.state"), "Disabled");
    EXPECT_EQ(trace.at(900, "X.state"), "Disabled");
    EXPECT_THAT(run.result.output, HasSubstr("machine stop in cycle 350 by operator"));
}

/// The gantry with a machine stop of its own, and the program that moves X for ever.
struct Stopped {
    Stopped(const std::string& name, const std::string& machineStop, const std::string& faults,
            const std::string& program = "signals")
        : folder{freshFolder("stop_" + name)} {
        const std::string machine =
            changedMachine("stop_machine_" + name, "<Program ", machineStop + "\n  <Program ");
        std::vector<std::string> arguments{
            "run",   machine, "--fast",  "--program", programPath(program),
            "--for", "2s",    "--trace", "t.csv"};
        if (!faults.empty()) {
            writeFile(folder + "/faults.xml", "<Faults>" + faults + "</Faults>\n");
            arguments.insert(arguments.end(), {"--faults", "faults.xml"});
        }
        result = runTakt(arguments, folder, {"TAKT_TEST_PHASE=never"});
    }
    [[nodiscard]] TraceFile trace() const { return TraceFile{folder + "/t.csv"}; }

    std::string folder;
    ProcessResult result;
};

TEST(MachineStop, ByALostInputStopsTheMachine) {
    // Bit 2 of the inputs of Z is low here; six cycles without inputs are more than the three that
    // are borne. The axes themselves are off, all but X.
    const Stopped run{"lost_input",
                      "<MachineStop onFault=\"false\"><Input slave=\"z\" index=\"0x60FD\" "
                      "bit=\"2\" active=\"high\"/></MachineStop>",
                      "<LostFrames cycle=\"400\" cycles=\"6\"/>"};
    EXPECT_THAT(run.result.output, HasSubstr("by input 'z 60FDh bit 2'"));
    EXPECT_THAT(run.result.output, Not(HasSubstr("by fault")));
    EXPECT_EQ(run.trace().number(1500, "X.setVel"), 0.0);
}

TEST(MachineStop, ByAFaultOfOneAxisStopsAllOfThem) {
    const Stopped run{"fault", "<MachineStop onFault=\"true\"/>",
                      "<LostFrames cycle=\"400\" cycles=\"6\"/>"};
    EXPECT_EQ(run.result.exitCode, 3) << run.result.output;
    EXPECT_THAT(run.result.output, HasSubstr("by fault of axis X"));
    EXPECT_THAT(run.result.output, HasSubstr("axis X ended in ErrorStop"));
}

TEST(MachineStop, LeavesTheRestAloneWhenAFaultIsNotToStopTheMachine) {
    const Stopped run{"no_fault", "<MachineStop onFault=\"false\"/>",
                      "<LostFrames cycle=\"400\" cycles=\"6\"/>"};
    EXPECT_EQ(run.result.exitCode, 3) << run.result.output;
    EXPECT_THAT(run.result.output, Not(HasSubstr("machine stop")));
}

TEST(MachineStop, ByAFailedProgramStopsTheAxesOfTheOthers) {
    const std::string folder = freshFolder("stop_program_fault");
    const std::string machine = changedMachine(
        "stop_two_programs", "<Program name=\"pick\" library=\"libgantry.so\"",
        "<MachineStop onFault=\"true\"/>\n  <Program name=\"fails\" every=\"10\" library=\"" +
            programPath("fails") + "\"/>\n  <Program name=\"signals\" library=\"" +
            programPath("signals") + "\"");
    const auto result = runTakt({"run", machine, "--fast", "--for", "2s", "--trace", "t.csv"},
                                folder, {"TAKT_TEST_PHASE=never"});
    EXPECT_EQ(result.exitCode, 3) << result.output;
    EXPECT_THAT(result.output, HasSubstr("by failure of program 'fails'"));
    const TraceFile trace{folder + "/t.csv"};
    EXPECT_TRUE(trace.everWas("X.state", "Stopping"));
    EXPECT_EQ(trace.at(1500, "X.state"), "Disabled");
    EXPECT_FALSE(trace.everWas("X.state", "ErrorStop"));
}

TEST(MachineStop, LetsTheDriveStopAnAxisThatTakesTooLong) {
    // 300 mm/s on a ramp of 6000 mm/s² take 50 ms and more.
    const std::string folder = freshFolder("stop_overdue");
    const std::string machine = changedMachine("stop_overdue_machine", "<Program ",
                                               "<MachineStop time=\"20 ms\"/>\n  <Program ");
    const auto result = runTakt({"run", machine, "--fast", "--program",
                                 programPath("control_probe"), "--for", "2s", "--trace", "t.csv"},
                                folder);
    EXPECT_EQ(result.exitCode, 5) << result.output;
    EXPECT_THAT(result.output, HasSubstr("axis X did not stop and power off within the 0.02 s of "
                                         "the machine stop; its drive stops it now"));
    EXPECT_THAT(result.output, Not(HasSubstr("axis Y did not")));
    // Quick stop: enable voltage without bit 2 (CiA 402 controlword 0x0002).
    const TraceFile trace{folder + "/t.csv"};
    bool quick = false;
    for (std::size_t row = 0; row < trace.size(); ++row)
        quick = quick ||
                (std::strtoul(trace.at(row, "X.controlword").c_str(), nullptr, 0) & 0x87U) == 0x02U;
    EXPECT_TRUE(quick);
}

}  // namespace
}  // namespace takt::test
