#include <regex>

#include "segment_test.hpp"

namespace takt::test {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::SizeIs;

constexpr int Devices = 80;

/// So many drives that their process data do not fit into one frame; the axis is on the last one.
class TwoFrames : public SegmentTest {
protected:
    void SetUp() override {
        SegmentTest::SetUp();
        const std::string source = TAKT_SOURCE_DIR;
        std::string text = readFile(source + "/tests/rt/machine.xml");
        const std::size_t begin = text.find("<Slave name=\"x\"");
        const std::string end = "</Slave>\n";
        const std::string slave = text.substr(begin, text.find(end) + end.size() - begin);
        for (int i = Devices - 1; i > 0; --i) {
            std::string another = slave;
            another.replace(another.find("\"x\""), 3, "\"d" + std::to_string(i) + "\"");
            text.insert(begin, another);
        }
        text.replace(text.find("../../samples"), 13, source + "/samples");
        machine_ = folder_ + "/machine.xml";
        writeFile(machine_, text);
    }
    std::string machine_;
};

TEST_F(TwoFrames, CarryALongLineInMemory) {
    const auto result = runTakt({"run", machine_, "--fast", "--program",
                                 std::string{TAKT_BINARY_DIR} + "/test_programs/two_moves.so",
                                 "--trace", "trace.csv", "--pcap", "run.pcapng"},
                                folder_);
    EXPECT_EQ(result.exitCode, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr(" 0 lost, 0 late; working counter errors 0"));
    std::smatch counts;
    ASSERT_TRUE(std::regex_search(result.output, counts,
                                  std::regex{R"(in (\d+) cycles.*frames (\d+) sent)"}));
    EXPECT_GE(std::stoi(counts[2]), 2 * std::stoi(counts[1]));
    expectSmoothTrace();
    const auto judged =
        runCommand({"python3", std::string{TAKT_SOURCE_DIR} + "/tests/machine/working_counters.py",
                    "run.pcapng", machine_},
                   folder_);
    EXPECT_EQ(judged.exitCode, 0) << judged.output;
}

TEST_F(TwoFrames, CarryALongLineOverAnInterface) {
    play("long_line", {machine_});
    EXPECT_THAT(result_.output, HasSubstr("run exit 0"));
    expectTakenDown();
    const auto ends = linesWith(result_.output, " end: ");
    EXPECT_THAT(ends, SizeIs(Devices));
    EXPECT_THAT(ends, Each(HasSubstr(": INIT, drive Switch on disabled")));
    const auto last = linesWith(result_.output, "end: x:");
    ASSERT_THAT(last, SizeIs(1)) << result_.output;
    EXPECT_NEAR(std::stod(last[0].substr(last[0].find("motor at ") + 9)), 0.625, 0.01);
    expectSmoothTrace();
}

}  // namespace
}  // namespace takt::test
