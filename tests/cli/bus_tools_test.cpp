#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string Gantry = std::string{TAKT_SOURCE_DIR} + "/samples/03_gantry/machine.xml";

/// Runs a verb on the gantry's simulated network.
ProcessResult onGantry(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--sim", Gantry});
    return runTakt(arguments, TAKT_BINARY_DIR);
}

TEST(Scan, TellsIdentityTypeAndDeviceFileOfEachDevice) {
    const auto result = onGantry({"scan"});
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("0xFFFF0CD3  0x00C300E0  0x00010002"));
    EXPECT_THAT(result.output, HasSubstr("cd300e.xml"));
    EXPECT_THAT(result.output, HasSubstr("ra.xml"));
}

TEST(Scan, TellsTheSameAsJson) {
    const auto result = onGantry({"scan", "--json"});
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_THAT(result.output, HasSubstr(R"("pos":2,"name":"z","type":"RA")"));
    EXPECT_THAT(result.output,
                HasSubstr(R"("vendor":4294905043,"product":12779744,"revision":65538)"));
    const auto parsed =
        runCommand({"python3", "-c", "import json,sys; json.loads(sys.argv[1])", result.output},
                   TAKT_BINARY_DIR);
    EXPECT_EQ(parsed.exitCode, 0) << parsed.output;
}

TEST(Slaves, ShowsOneLineForEachDeviceWithNameAndState) {
    const auto result = onGantry({"slaves"});
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("z                 INIT"));
    EXPECT_THAT(result.output, HasSubstr("Simphoenix CD300E servo drive")) << "as its EEPROM says";
}

TEST(States, LeadsAllDevicesToPreOp) {
    const auto result = onGantry({"states", "preop", "--json"});
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr(R"("name":"x","state":"PREOP","error":false)"));
    EXPECT_THAT(result.output, HasSubstr(R"("name":"z","state":"PREOP","error":false)"));
}

TEST(States, ExplainsTheStatusCodeOfADeviceThatRefuses) {
    const auto result = onGantry({"states", "SAFEOP", "--slave", "z"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.output,
                HasSubstr("device 2 stays in PREOP + ERROR: 0x001D invalid output configuration"));
    EXPECT_THAT(result.output, Not(HasSubstr("x     "))) << "the other devices were not asked";
}

TEST(States, RefusesAStateThatThereIsNot) {
    const auto result = onGantry({"states", "RUN"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.output, HasSubstr("there are INIT, PREOP, SAFEOP and OP"));
}

TEST(Upload, ReadsAnObjectWithTheTypeOfTheDeviceFile) {
    const auto result = onGantry({"upload", "x", "0x1018:2"});
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("12779744  0x00C300E0  uint32  Product code"));
}

TEST(Upload, ShowsTheValueAsTheTypeThatIsAskedFor) {
    const auto result = onGantry({"upload", "2", "0x6064", "--type", "uint32"});
    EXPECT_EQ(result.exitCode, 0) << result.output;
    // 60 mm below the zero of the mechanics, 32768 counts for 10 mm.
    EXPECT_THAT(result.output, HasSubstr("4294770688  0xFFFD0000  uint32"));
    EXPECT_THAT(onGantry({"upload", "2", "0x6064"}).output, HasSubstr("-196608"));
}

TEST(Upload, PutsAnAbortIntoWords) {
    const auto result = onGantry({"upload", "0", "0x1018:9"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.output,
                HasSubstr("device 0, object 0x1018:09: 0x06090011 sub-index does not exist"));
}

TEST(Upload, NamesTheDevicesThatThereAre) {
    const auto result = onGantry({"upload", "q", "0x6064"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.output, HasSubstr("there are: 0 or x, 1 or y, 2 or z"));
}

TEST(Download, WritesAnObject) {
    const auto result = onGantry({"download", "x", "0x6065", "0x3E8", "--json"});
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr(R"("type":"uint32","value":"1000","hex":"0x000003E8")"));
}

TEST(Download, TellsWhatTheDeviceRefuses) {
    EXPECT_THAT(onGantry({"download", "x", "0x605A", "77"}).output,
                HasSubstr("0x06090031 value too high"));
    EXPECT_THAT(onGantry({"download", "x", "0x6041", "1"}).output, HasSubstr("0x06010002"));
    EXPECT_EQ(onGantry({"download", "x", "0x6041", "1"}).exitCode, 2);
}

TEST(Download, AsksForTheTypeOfAnObjectThatNoFileKnows) {
    const auto result = onGantry({"download", "x", "0x2FFF", "1"});
    EXPECT_EQ(result.exitCode, 2);
    EXPECT_THAT(result.output, HasSubstr("name it with --type"));
}

TEST(BusTools, NeedAPlaceToLookAt) {
    const auto nowhere = runTakt({"scan"}, TAKT_BINARY_DIR);
    EXPECT_EQ(nowhere.exitCode, 2);
    EXPECT_THAT(nowhere.output, HasSubstr("--interface IF"));
    for (const char* verb : {"scan", "slaves", "states"}) {
        const auto missing = runTakt({verb, "--interface", "nowhere0"}, TAKT_BINARY_DIR);
        EXPECT_EQ(missing.exitCode, 2);
        EXPECT_THAT(missing.output, HasSubstr("interface 'nowhere0': does not exist"));
        EXPECT_EQ(std::count(missing.output.begin(), missing.output.end(), '\n'), 1) << "one line";
    }
}

TEST(BusTools, WorkForAMachineWhoseProgramIsNotBuilt) {
    std::string text = readFile(Gantry);
    const std::string library = "libgantry.so";
    text.replace(text.find(library), library.size(), "libnot_built.so");
    for (std::size_t p = 0; (p = text.find("../devices/", p)) != std::string::npos;) {
        text.replace(p, 3, std::string{TAKT_SOURCE_DIR} + "/samples/");
    }
    const std::string file = freshFolder("tools_not_built") + "/machine.xml";
    writeFile(file, text);
    const auto result = runTakt({"slaves", "--sim", file}, TAKT_BINARY_DIR);
    EXPECT_EQ(result.exitCode, 0) << result.output;
}

}  // namespace
}  // namespace takt::test
