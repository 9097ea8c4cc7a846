#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "takt_process.hpp"

// The sample's own tests judge its limits, its working counters and its plot.
namespace takt::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string Source = TAKT_SOURCE_DIR;
const std::string Folder = Source + "/samples/06_eni/";

std::string folderName() {
    return std::string{"eni_"} + testing::UnitTest::GetInstance()->current_test_info()->name();
}

void replace(std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << "the sample no longer has " << from;
    text.replace(at, from.size(), to);
}

TEST(EniRun, PutsNoMalformedFrameOnTheWire) {
    const std::string folder = freshFolder(folderName());
    const auto run =
        runTakt({"run", Folder + "machine.xml", "--fast", "--pcap", "a.pcapng"}, folder);
    ASSERT_EQ(run.exitCode, 0) << run.output;
    const auto malformed = runCommand({"tshark", "-r", "a.pcapng", "-Y", "_ws.malformed"}, folder);
    EXPECT_EQ(malformed.exitCode, 0) << malformed.output;
    EXPECT_EQ(malformed.output.find("ECAT"), std::string::npos) << malformed.output.substr(0, 2000);
}

TEST(EniRun, LeavesTheSameTraceByteForByteWhenRunAgain) {
    const std::string folder = freshFolder(folderName());
    for (const char* const trace : {"a.csv", "b.csv"}) {
        const auto run =
            runTakt({"run", Folder + "machine.xml", "--fast", "--trace", trace}, folder);
        ASSERT_EQ(run.exitCode, 0) << run.output;
    }
    EXPECT_GT(readFile(folder + "/a.csv").size(), 100000U);
    EXPECT_TRUE(readFile(folder + "/a.csv") == readFile(folder + "/b.csv"));
}

TEST(EniRun, IsWatchedByTheTrapInEveryCycle) {
    if (readFile(std::string{TAKT_BINARY_DIR} + "/libtakt_trap.so").empty()) {
        SUCCEED() << "the sanitizers of this build replace what the trap watches";
        return;
    }
    const std::string folder = freshFolder(folderName());
    const auto watched = runTakt({"run", Folder + "machine.xml", "--fast", "--quiet"}, folder,
                                 {"TAKT_TRAP_REPORT=trap.txt"});
    ASSERT_EQ(watched.exitCode, 0) << watched.output;
    const std::string report = readFile(folder + "/trap.txt");
    EXPECT_THAT(report, HasSubstr("no hit"));
    EXPECT_GT(std::stoul(report.substr(report.find(' ') + 1)), 2500U) << report;
}

TEST(EniRun, RefusesAFileWhoseIdentityContradictsItself) {
    std::string eni = readFile(Folder + "line.eni.xml");
    replace(eni, "<ProductCode>12779744</ProductCode>", "<ProductCode>12779745</ProductCode>");
    const std::string folder = freshFolder(folderName());
    writeFile(folder + "/line.eni.xml", eni);
    writeFile(folder + "/machine.xml", readFile(Folder + "machine.xml"));
    const auto checked = runTakt({"check", "machine.xml"}, folder);
    EXPECT_EQ(checked.exitCode, 1) << "refused: the configuration is wrong";
    EXPECT_THAT(checked.output,
                HasSubstr("line.eni.xml:103: error: slave 'Drive 1 (CD300E)' has product "
                          "0x00c300e1, but the init command in line 179 wants 0x00c300e0"));
}

TEST(EniRun, RefusesADeviceThatIsNotTheOneOfTheFile) {
    std::string eni = readFile(Folder + "line.eni.xml");
    replace(eni, "<ProductCode>12779744</ProductCode>", "<ProductCode>12779745</ProductCode>");
    replace(eni, "<Data>E000C300</Data>", "<Data>E100C300</Data>");
    std::string machine = readFile(Folder + "machine.xml");
    replace(machine, "../devices/cd300e.xml", Source + "/samples/devices/cd300e.xml");
    replace(machine, "../devices/ra.xml", Source + "/samples/devices/ra.xml");
    replace(machine, "<Device slave=\"Drive 1 (CD300E)\"",
            "<Device slave=\"Drive 1 (CD300E)\" device=\"CD300E\"");
    const std::string folder = freshFolder(folderName());
    writeFile(folder + "/line.eni.xml", eni);
    writeFile(folder + "/machine.xml", machine);
    const auto run = runTakt({"run", "machine.xml", "--fast"}, folder);
    EXPECT_EQ(run.exitCode, 2) << "could not run: another device stands there";
    EXPECT_THAT(run.output,
                AllOf(HasSubstr("line.eni.xml:103: slave 0 'Drive 1 (CD300E)': expected "
                                "product 0x00c300e1, found 0x00c300e0"),
                      HasSubstr("check the network file")));
}

}  // namespace
}  // namespace takt::test
