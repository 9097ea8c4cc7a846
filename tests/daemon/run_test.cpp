#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "machine_files.hpp"
#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Runs the gantry's machine with another program.
ProcessResult runWith(const std::string& program, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run", Gantry, "--fast", "--program", program};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runTakt(arguments, TAKT_BINARY_DIR);
}

TEST(Run, RefusesAProgramLibraryThatIsMissing) {
    const auto result = runWith("nowhere/libnothing.so");
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.output, HasSubstr("nowhere/libnothing.so"));
    EXPECT_THAT(result.output, HasSubstr("does not exist"));
}

TEST(Run, RefusesALibraryWithoutEntryPoint) {
    const auto result = runWith(programPath("no_entry"));
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.output, HasSubstr("no entry point 'taktProgramEntry'"));
    EXPECT_THAT(result.output, HasSubstr("TAKT_PROGRAM"));
}

TEST(Run, RefusesAProgramBuiltForAnotherAbiWithoutRunningItsCode) {
    const auto result = runWith(programPath("other_abi"));
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.output, HasSubstr("program ABI 2, this takt needs 1"));
}

TEST(Run, RefusesAProgramThatAsksForAnUnknownAxisAndNamesTheKnownOnes) {
    const auto result = runWith(programPath("unknown_axis"));
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.output, HasSubstr("'unknown_axis' asks for axis 'Q'"));
    EXPECT_THAT(result.output, HasSubstr("allowed: X, Y, Z"));
}

TEST(Run, NamesTheLineOfAProgramThatIsRefused) {
    const std::string file = changedMachine("program_line", "libgantry.so", "libnot_there.so");
    const auto result = runTakt({"run", file, "--fast"}, TAKT_BINARY_DIR);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.output, HasSubstr("machine.xml:"));
    EXPECT_THAT(result.output, HasSubstr("libnot_there.so"));
}

TEST(Run, RefusesEverythingThatIsWrongAtOnceAndStartsNothing) {
    const std::string file = changedMachine("half_started", "cycle=\"1 ms\"", "cycle=\"3 ms\"");
    const std::string trace = std::filesystem::path{file}.parent_path() / "a.csv";
    const auto result = runTakt(
        {"run", file, "--fast", "--trace", trace, "--program", "nowhere.so"}, TAKT_BINARY_DIR);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_FALSE(std::filesystem::exists(trace));
}

TEST(Run, StopsTheAxesOfAProgramThatThrowsAndKeepsTheBusInOp) {
    const std::string folder = freshFolder("throws");
    const std::string trace = folder + "/throws.csv";
    const auto result = runWith(programPath("throws"), {"--trace", trace});
    EXPECT_EQ(result.exitCode, 3) << result.output;
    EXPECT_THAT(result.output, HasSubstr("'throws'"));
    EXPECT_THAT(result.output, HasSubstr("the part is missing"));
    EXPECT_THAT(result.output, HasSubstr("0 lost"));
    EXPECT_THAT(result.output, HasSubstr("working counter errors 0"));
    const auto judged =
        runCommand({"python3", std::string{TAKT_SOURCE_DIR} + "/tests/machine/continuity.py", trace,
                    "--machine", Gantry},
                   folder);
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
    const std::string text = readFile(trace);
    EXPECT_THAT(text, HasSubstr("ContinuousMotion"));
    EXPECT_THAT(text, Not(HasSubstr("ErrorStop")));
}

TEST(Run, TellsWhyAProgramFailedAndWhatItWatches) {
    const auto result = runWith(programPath("fails"));
    EXPECT_EQ(result.exitCode, 3);
    EXPECT_THAT(result.output, HasSubstr("no part in the gripper"));
    EXPECT_THAT(result.output, HasSubstr("grip = 7"));
}

TEST(Run, RunsAProgramThatIsLinkedIntoTheExecutable) {
    const std::string file = changedMachine("linked", "library=\"libgantry.so\"", "");
    const auto result = runCommand(
        {std::string{TAKT_BINARY_DIR} + "/test_programs/linked_program", "run", file, "--fast"},
        TAKT_BINARY_DIR);
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("'pick'"));
}

TEST(Run, RefusesAProgramThatShouldBeLinkedInAndIsNot) {
    const std::string file = changedMachine("not_linked", "library=\"libgantry.so\"", "");
    const auto result = runTakt({"run", file, "--fast"}, TAKT_BINARY_DIR);
    EXPECT_EQ(result.exitCode, 1) << result.output;
    EXPECT_THAT(result.output, HasSubstr("machine.xml:"));
    EXPECT_THAT(result.output, HasSubstr("program 'pick' has no library and is not linked in"));
}

TEST(Run, EndsAfterTheTimeAskedForWithoutPrograms) {
    const auto result =
        runTakt({"run", Gantry, "--fast", "--manual", "--for", "500ms"}, TAKT_BINARY_DIR);
    EXPECT_EQ(result.exitCode, 0) << result.output;
}

TEST(Run, SaysWhichFileCannotBeWrittenBeforeAnythingMoves) {
    const auto result =
        runTakt({"run", Gantry, "--fast", "--trace", "/nowhere/a.csv"}, TAKT_BINARY_DIR);
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.output, HasSubstr("/nowhere/a.csv"));
    EXPECT_THAT(result.output, Not(HasSubstr("devices")));
}

TEST(Run, RefusesACommandLineItDoesNotUnderstand) {
    EXPECT_EQ(runTakt({"run", Gantry, "--fats"}, TAKT_BINARY_DIR).exitCode, 1);
    EXPECT_EQ(runTakt({"run", Gantry, "--fast", "--for", "10 apples"}, TAKT_BINARY_DIR).exitCode,
              1);
}

/// A run of the gantry in which frames get lost while X and Y travel.
ProcessResult runWithLostFrames(const std::string& name, int cycles, const std::string& trace) {
    const std::string faults = freshFolder(name) + "/faults.xml";
    writeFile(faults, "<Faults><LostFrames cycle=\"7000\" cycles=\"" + std::to_string(cycles) +
                          "\"/></Faults>");
    return runTakt({"run", Gantry, "--fast", "--faults", faults, "--trace", trace},
                   TAKT_BINARY_DIR);
}

TEST(Run, CarriesOnOverAsManyLostFramesAsTheNetworkTolerates) {
    const std::string trace = freshFolder("lost_three") + "/a.csv";
    const auto result = runWithLostFrames("lost_three_faults", 3, trace);
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr(" 3 lost"));
    EXPECT_THAT(readFile(trace), Not(HasSubstr("ErrorStop")));
}

TEST(Run, StopsTheAxesWhenMoreFramesAreLost) {
    const std::string trace = freshFolder("lost_four") + "/a.csv";
    const auto result = runWithLostFrames("lost_four_faults", 4, trace);
    EXPECT_EQ(result.exitCode, 3) << result.output;
    EXPECT_THAT(result.output, HasSubstr("CommunicationLost"));
    EXPECT_THAT(readFile(trace), HasSubstr("ErrorStop"));
}

TEST(Run, RefusesAFaultFileWithItsLine) {
    const std::string faults = freshFolder("bad_faults") + "/faults.xml";
    writeFile(faults, "<Faults>\n  <LostFrames cycle=\"-1\"/>\n</Faults>\n");
    const auto result = runTakt({"run", Gantry, "--fast", "--faults", faults}, TAKT_BINARY_DIR);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_THAT(result.output, HasSubstr("faults.xml:2"));
}

TEST(Check, SaysWhatTheNetworkNeedsAndThatTheMachineIsGood) {
    const auto result = runTakt({"check", Gantry}, TAKT_BINARY_DIR);
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("receive deadline"));
    EXPECT_THAT(result.output, HasSubstr("SYNC0"));
    EXPECT_THAT(result.output, HasSubstr("machine.xml: good"));
}

TEST(Check, CannotRunWithoutAFile) {
    EXPECT_EQ(runTakt({"check", "nowhere.xml"}, TAKT_BINARY_DIR).exitCode, 2);
}

}  // namespace
}  // namespace takt::test
