#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "takt_process.hpp"

namespace takt::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string Source = TAKT_SOURCE_DIR;

/// Every numbered folder is a sample; a new one is tested without being named here.
std::vector<std::string> samples() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator{Source + "/samples"}) {
        const std::string name = entry.path().filename().string();
        if (entry.is_directory() && name.front() >= '0' && name.front() <= '9')
            names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

/// A sample is run once, with all outputs on; the rules below look at what it left.
class Sample : public testing::TestWithParam<std::string> {
protected:
    struct Run {
        std::string folder;
        ProcessResult result;
    };

    static const Run& run() {
        static std::map<std::string, Run> runs;
        const auto [place, fresh] = runs.try_emplace(GetParam());
        if (fresh) {
            place->second.folder = freshFolder(folderName());
            place->second.result = runTakt({"run", machine(), "--fast", "--trace", "a.csv",
                                            "--plot", "a.svg", "--pcap", "a.pcapng"},
                                           place->second.folder);
        }
        return place->second;
    }
    /// One for each test: ctest runs them side by side, in processes of their own.
    static std::string folderName() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        std::string name = std::string{"sample_"} + test->name();
        std::replace(name.begin(), name.end(), '/', '_');
        return name;
    }
    static std::string folder() { return Source + "/samples/" + GetParam(); }
    static std::string machine() { return folder() + "/machine.xml"; }
    static ProcessResult judge(const std::vector<std::string>& arguments) {
        std::vector<std::string> command{"python3"};
        command.insert(command.end(), arguments.begin(), arguments.end());
        return runCommand(command, run().folder);
    }
};

TEST_P(Sample, EndsWellWithoutLosingAFrame) {
    EXPECT_EQ(run().result.exitCode, 0) << run().result.output;
    EXPECT_THAT(run().result.output, HasSubstr("finished"));
    EXPECT_THAT(run().result.output, HasSubstr(" 0 lost, 0 late; working counter errors 0"));
}

TEST_P(Sample, KeepsTheLimitsOfEveryAxisInEveryCycle) {
    ASSERT_EQ(run().result.exitCode, 0);
    const auto judged =
        judge({Source + "/tests/machine/continuity.py", "a.csv", "--machine", machine()});
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
}

TEST_P(Sample, GetsTheWorkingCountersThatTheMachineFileForetells) {
    ASSERT_EQ(run().result.exitCode, 0);
    const auto judged =
        judge({Source + "/tests/machine/working_counters.py", "a.pcapng", machine()});
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
}

TEST_P(Sample, ShowsThePlotOfARunOfToday) {
    ASSERT_EQ(run().result.exitCode, 0);
    EXPECT_TRUE(readFile(folder() + "/plot.svg") == readFile(run().folder + "/a.svg"))
        << "samples/" << GetParam()
        << "/plot.svg shows another run; draw it anew with scripts/plots";
}

TEST_P(Sample, SaysWhatItIsAndHowToRunIt) {
    EXPECT_THAT(
        readFile(folder() + "/README.md"),
        AllOf(HasSubstr("takt run"), HasSubstr("machine.xml --fast"), HasSubstr("](plot.svg)")));
}

INSTANTIATE_TEST_SUITE_P(All, Sample, testing::ValuesIn(samples()),
                         [](const auto& sample) { return sample.param; });

}  // namespace
}  // namespace takt::test
