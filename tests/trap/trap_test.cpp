#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace takt {
namespace {

struct Outcome {
    int code{-1};
    std::string output;
};

/// Runs the probe with the trap in front of it.
Outcome probe(const std::string& what, const std::string& where, const std::string& more = {}) {
    const std::string command = more + " LD_PRELOAD=" TAKT_TRAP_LIBRARY " " TAKT_TRAP_PROBE " " +
                                what + " " + where + " 2>&1 </dev/null";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    Outcome outcome;
    std::array<char, 4096> buffer{};
    while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
        outcome.output.append(buffer.data(), size);
    }
    const int status = ::pclose(pipe);
    if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
    return outcome;
}

class TrapFor : public testing::TestWithParam<const char*> {};

TEST_P(TrapFor, StopsItInsideTheCycleAndNamesIt) {
    const Outcome outcome = probe(GetParam(), "inside");
    EXPECT_EQ(outcome.code, 99);
    EXPECT_NE(outcome.output.find("takt trap: "), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("takt_trap_probe"), std::string::npos) << outcome.output;
}

TEST_P(TrapFor, LetsItPassOutsideTheCycle) {
    const Outcome outcome = probe(GetParam(), "outside");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
}

TEST_P(TrapFor, LetsItPassWhereTheGuardPauses) {
    const Outcome outcome = probe(GetParam(), "paused");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
}

TEST_P(TrapFor, LetsItPassOnAnotherThread) {
    const Outcome outcome = probe(GetParam(), "otherthread");
    EXPECT_EQ(outcome.code, 0) << outcome.output;
}

INSTANTIATE_TEST_SUITE_P(Everything, TrapFor,
                         testing::Values("malloc", "calloc", "realloc", "free", "new", "vector",
                                         "aligned", "memalign", "mutex", "rdlock", "wrlock",
                                         "semaphore", "atomicwait", "thread", "sleep", "usleep",
                                         "open", "write", "read", "fopen", "printf", "fprintf",
                                         "puts", "cout", "dlopen", "mmap", "static", "throw"),
                         [](const auto& deed) { return std::string{deed.param}; });

TEST(Trap, LetsAProgramThrowButNotAllocate) {
    EXPECT_EQ(probe("throw", "program").code, 0);
    EXPECT_EQ(probe("malloc", "program").code, 99);
}

TEST(Trap, IsArmedAgainAfterAProgramThatThrew) {
    EXPECT_EQ(probe("malloc", "afterprogram").code, 99);
}

TEST(Trap, LetsAnEmptyCyclePass) {
    EXPECT_EQ(probe("nothing", "inside").code, 0);
}

TEST(Trap, ReportsHowOftenItWasArmed) {
    const auto path =
        std::filesystem::temp_directory_path() / ("takt_trap_report_" + std::to_string(::getpid()));
    EXPECT_EQ(probe("nothing", "inside", "TAKT_TRAP_REPORT=" + path.string()).code, 0);
    std::ifstream in{path};
    const std::string text{std::istreambuf_iterator<char>{in}, {}};
    EXPECT_NE(text.find("armed 1 times, no hit\n"), std::string::npos) << text;
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace takt
