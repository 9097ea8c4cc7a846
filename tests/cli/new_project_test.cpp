#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string Devices = std::string{TAKT_SOURCE_DIR} + "/samples/devices/";

/// A folder for one test, in which projects are made.
class NewProject : public testing::Test {
protected:
    ProcessResult make(const std::string& name, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"new", name};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runTakt(arguments, folder_);
    }
    /// The drives come to OP and go down again; the program is not built here.
    [[nodiscard]] ProcessResult runWithoutProgram(const std::string& name) const {
        return runTakt({"run", name + "/machine.xml", "--fast", "--manual", "--for", "100ms"},
                       folder_);
    }
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }

    const std::string folder_{freshFolder(
        std::string{"new_"} + testing::UnitTest::GetInstance()->current_test_info()->name())};
};

TEST_F(NewProject, HasAMachineProgramBuildTestAndCiFile) {
    const auto made = make("first");
    ASSERT_EQ(made.exitCode, 0) << made.output;
    for (const char* file :
         {"machine.xml", "first.cpp", "CMakeLists.txt", "test/trace_test.cpp", "README.md",
          ".github/workflows/ci.yml", "machine.xsd", "devices/cd300e.xml"}) {
        EXPECT_FALSE(readFile(path("first/") + file).empty()) << file;
        EXPECT_THAT(made.output, HasSubstr(file));
    }
    EXPECT_THAT(readFile(path("first/first.cpp")), Not(HasSubstr("{{")));
    EXPECT_THAT(readFile(path("first/CMakeLists.txt")), Not(HasSubstr("{{")));
}

TEST_F(NewProject, BringsTheDrivesOfItsDeviceFilesToOp) {
    const auto made = make("two", {"--esi", Devices + "ra.xml", "--esi", Devices + "cd300e.xml"});
    ASSERT_EQ(made.exitCode, 0) << made.output;
    const auto run = runWithoutProgram("two");
    EXPECT_EQ(run.exitCode, 0) << run.output;
    EXPECT_THAT(run.output, HasSubstr("2 devices, 2 axes"));
}

TEST_F(NewProject, TakesTheNamedDevicesInTheOrderInWhichTheyAreNamed) {
    const auto made = make("three", {"--esi", Devices + "ra.xml", "--esi", Devices + "cd300e.xml",
                                     "--device", "CD300E", "--device", "RA", "--device", "CD300E"});
    ASSERT_EQ(made.exitCode, 0) << made.output;
    EXPECT_THAT(made.output, HasSubstr("X (CD300E), Y (RA), Z (CD300E)"));
    EXPECT_EQ(runWithoutProgram("three").exitCode, 0);
}

TEST_F(NewProject, WorksForADriveThatNobodyKnows) {
    std::string esi = readFile(Devices + "ra.xml");
    const std::string type = ">RA</Type>";
    const std::size_t at = esi.find(type);
    ASSERT_NE(at, std::string::npos);
    esi.replace(at, type.size(), ">SV &amp; 1</Type>");
    writeFile(path("other.xml"), esi);
    const auto made = make("unknown", {"--esi", "other.xml"});
    ASSERT_EQ(made.exitCode, 0) << made.output;
    EXPECT_THAT(readFile(path("unknown/machine.xml")), HasSubstr("device=\"SV &amp; 1\""));
    EXPECT_THAT(readFile(path("unknown/machine.xml")), HasSubstr("countsPerTurn="));
    const auto run = runWithoutProgram("unknown");
    EXPECT_EQ(run.exitCode, 0) << run.output;
}

TEST_F(NewProject, TakesTheDevicesOfANetworkFile) {
    const std::string eni = std::string{TAKT_SOURCE_DIR} + "/samples/06_eni/line.eni.xml";
    const auto made = make("plant", {"--eni", eni});
    ASSERT_EQ(made.exitCode, 0) << made.output;
    EXPECT_THAT(made.output, HasSubstr("X (CD300E), Y (CD300E), Z (RA), A (Servo402)"));
    const std::string machine = readFile(path("plant/machine.xml"));
    EXPECT_THAT(machine, HasSubstr("<Network eni=\"line.eni.xml\">"));
    EXPECT_THAT(machine, HasSubstr("<Drive slave=\"Drive 1 (CD300E)\""));
    EXPECT_THAT(machine, HasSubstr("<Esi file=\"devices/cd300e.xml\"/>"));
    EXPECT_THAT(machine, Not(HasSubstr("<Slave ")));
    EXPECT_EQ(readFile(path("plant/line.eni.xml")), readFile(eni));
    const auto run = runWithoutProgram("plant");
    EXPECT_EQ(run.exitCode, 0) << run.output;
}

TEST_F(NewProject, SaysInWhichLineANetworkFileIsWrong) {
    std::string eni = readFile(std::string{TAKT_SOURCE_DIR} + "/samples/06_eni/line.eni.xml");
    const std::string counter = "<Cnt>12</Cnt>";
    ASSERT_NE(eni.find(counter), std::string::npos);
    eni.replace(eni.find(counter), counter.size(), "<Cnt>11</Cnt>");
    writeFile(path("bad.eni.xml"), eni);
    const auto made = make("plant", {"--eni", "bad.eni.xml"});
    EXPECT_EQ(made.exitCode, 2);
    EXPECT_THAT(made.output, HasSubstr("bad.eni.xml:1824: error: <Cnt> is 11"));
    EXPECT_FALSE(std::filesystem::exists(path("plant")));
}

TEST_F(NewProject, LeavesAFolderAloneThatIsNotEmpty) {
    std::filesystem::create_directory(path("full"));
    writeFile(path("full/mine.txt"), "mine");
    const auto refused = make("full");
    EXPECT_EQ(refused.exitCode, 2);
    EXPECT_THAT(refused.output, HasSubstr("full is not empty"));
    const auto files = std::filesystem::directory_iterator{path("full")};
    EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST_F(NewProject, TakesAnEmptyFolder) {
    std::filesystem::create_directory(path("empty"));
    EXPECT_EQ(make("empty").exitCode, 0);
}

TEST_F(NewProject, WritesNothingWhenItIsRefused) {
    EXPECT_EQ(make("none", {"--esi", "nowhere.xml"}).exitCode, 2);
    EXPECT_EQ(make("none", {"--device", "XY9"}).exitCode, 2);
    EXPECT_EQ(make("none", {"--scan", "nowhere0"}).exitCode, 2);
    EXPECT_EQ(make("none", {"--eni", "plant.xml"}).exitCode, 2);
    EXPECT_FALSE(std::filesystem::exists(path("none")));
}

TEST_F(NewProject, SaysWhatIsAllowed) {
    EXPECT_THAT(make("none", {"--device", "XY9"}).output, HasSubstr("there are: CD300E"));
    EXPECT_THAT(make("none", {"--eni", "plant.xml"}).output,
                HasSubstr("there is no network file plant.xml"));
    EXPECT_THAT(make("none", {"--esi", "nowhere.xml"}).output,
                HasSubstr("there is no device file nowhere.xml"));
}

TEST_F(NewProject, MakesNamesThatCompilersTakeOutOfAnyFolderName) {
    const auto made = make("4 axes-and more");
    ASSERT_EQ(made.exitCode, 0) << made.output;
    EXPECT_THAT(readFile(path("4 axes-and more/machine.xml")),
                HasSubstr("name=\"machine_4_axes_and_more\""));
    EXPECT_TRUE(std::filesystem::exists(path("4 axes-and more/machine_4_axes_and_more.cpp")));
    EXPECT_EQ(runWithoutProgram("4 axes-and more").exitCode, 0);
}

TEST_F(NewProject, TellsTheResultAsJson) {
    EXPECT_THAT(make("json", {"--json"}).output,
                HasSubstr(R"({"name":"json","axes":1,"files":["machine.xml",)"));
}

}  // namespace
}  // namespace takt::test
