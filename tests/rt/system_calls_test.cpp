#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "namespaces.hpp"

namespace takt::test {
namespace {

using Counts = std::map<std::string, double>;

/// The calls of each thread in their order, by their name. Those on a futex tell what became of
/// them: "futex wake", "futex wait", or "futex passed", a wait that found the gate already back.
using Calls = std::vector<std::string>;

std::map<std::string, Calls> readCalls(const std::string& file) {
    std::map<std::string, Calls> threads;
    std::ifstream lines{file};
    const std::regex call{R"(^(\d+) +([a-z_0-9]+)\(.*)"};
    const std::regex resumed{R"(^(\d+) +<\.\.\. futex resumed>.*)"};
    for (std::string line; std::getline(lines, line);) {
        std::smatch parts;
        const bool passed = line.find("EAGAIN") != std::string::npos;
        if (std::regex_match(line, parts, resumed)) {
            if (passed) threads[parts[1]].back() = "futex passed";
        } else if (std::regex_match(line, parts, call)) {
            std::string name = parts[2];
            const bool wakes = line.find("FUTEX_WAKE") != std::string::npos;
            if (name == "futex") name += wakes ? " wake" : passed ? " passed" : " wait";
            threads[parts[1]].push_back(name);
        }
    }
    return threads;
}

bool makes(const Calls& calls, const char* what) {
    return std::find(calls.begin(), calls.end(), what) != calls.end();
}

/// While programs are called: from the first opening of a gate to the last one. Before and behind
/// it the network goes to OP and back, which takes as many cycles as it takes.
Counts inOperation(const Calls& calls) {
    const auto first = std::find(calls.begin(), calls.end(), "futex wake");
    const auto last = std::find(calls.rbegin(), calls.rend(), "futex wake").base();
    Counts counts;
    for (auto at = first; at < last; ++at) counts[*at] += 1;
    return counts;
}

/// What the thread of the cycle does in operation: the only one that sleeps and opens gates. The
/// one that began the process sleeps too.
Counts ofCycle(const std::map<std::string, Calls>& threads) {
    for (const auto& [thread, calls] : threads) {
        if (makes(calls, "clock_nanosleep") && makes(calls, "futex wake") &&
            makes(calls, "sendmmsg") && !makes(calls, "execve"))
            return inOperation(calls);
    }
    return {};
}

/// … and the thread of the program, which does nothing but wait for its gate and give it back.
Counts ofProgram(const std::map<std::string, Calls>& threads) {
    std::size_t most = 0;
    Counts best;
    for (const auto& [thread, calls] : threads) {
        if (makes(calls, "sendmmsg") || makes(calls, "execve")) continue;
        Counts counts = inOperation(calls);
        if (counts["futex wake"] <= static_cast<double>(most)) continue;
        most = static_cast<std::size_t>(counts["futex wake"]);
        best = counts;
    }
    return best;
}

/// Frames that were lost or late in both runs together.
double strayFrames(const std::string& output) {
    double sum = 0;
    const std::regex summary{R"((\d+) lost, (\d+) late)"};
    for (std::sregex_iterator at{output.begin(), output.end(), summary}, end; at != end; ++at) {
        sum += std::stod((*at)[1]) + std::stod((*at)[2]);
    }
    return sum;
}

/// Calls of one run, in operation. A loaded computer runs fewer cycles in the same time, so cycles
/// are counted by their sleeps.
struct CountedRun {
    explicit CountedRun(const std::string& file) {
        const auto threads = readCalls(file);
        cycle = ofCycle(threads);
        program = ofProgram(threads);
        cycles = cycle["clock_nanosleep"];
    }
    Counts cycle;
    Counts program;
    double cycles{0};
};

class SystemCalls : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_EQ(namespacesForbidden(), "");
        const std::string folder = freshFolder("system_calls");
        const ProcessResult result = inNamespaces("system_calls", folder);
        output_ = result.output;
        ASSERT_EQ(linesWith(output_, "run exit 0").size(), 2U) << output_;
        runs_.emplace_back(folder + "/calls.1s");
        runs_.emplace_back(folder + "/calls.3s");
        ASSERT_GT(runs_[0].cycles, 50) << output_;
        ASSERT_GT(runs_[1].cycles, runs_[0].cycles + 100) << output_;
    }
    /// What the longer run has more.
    double more(const char* call) { return runs_[1].cycle[call] - runs_[0].cycle[call]; }
    double moreOfProgram(const char* call) {
        return runs_[1].program[call] - runs_[0].program[call];
    }

    std::string output_;
    std::vector<CountedRun> runs_;
};

/// Beyond the named calls there are few, and no more in a longer run.
void expectNothingBut(const Counts& counts, const std::vector<std::string>& known) {
    constexpr double few = 10;
    for (const auto& [call, count] : counts) {
        if (std::find(known.begin(), known.end(), call) != known.end()) continue;
        EXPECT_LE(count, few) << call;
    }
}

TEST_F(SystemCalls, AreOneSendOneSleepAndOneOpeningOfEachGateInEveryCycle) {
    const double cycles = more("clock_nanosleep");
    // The stretch ends behind a send and before a sleep.
    EXPECT_NEAR(more("sendmmsg"), cycles, 2);
    // A call that is still out when its budget ends is waited for again in the next cycle instead
    // of being made, and costs a look at the processor time it has had.
    const double late = runs_[1].cycle["clock_gettime"] + runs_[0].cycle["clock_gettime"];
    EXPECT_LE(more("futex wake"), cycles + 2);
    EXPECT_GE(more("futex wake"), cycles - late - 2);
    EXPECT_NEAR(moreOfProgram("futex wake"), more("futex wake"), 4);
}

TEST_F(SystemCalls, AreAtMostOneReceiveAndOneWaitAtEachGateInEveryCycle) {
    for (CountedRun& run : runs_) {
        const double stray = strayFrames(output_);
        // A reply that is already there need not be waited for; a late one costs another wait.
        EXPECT_LE(run.cycle["ppoll"], run.cycles + stray + 2);
        // A call that is already back need not be waited for. One that comes back just before the
        // wait begins lets it pass, and its waking may then end the next wait too early.
        EXPECT_LE(run.cycle["futex wait"], run.cycles + run.cycle["futex passed"] + 2);
        EXPECT_LE(run.cycle["futex passed"], run.cycles + 2);
        expectNothingBut(run.cycle, {"sendmmsg", "ppoll", "clock_nanosleep", "futex wake",
                                     "futex wait", "futex passed", "clock_gettime"});
        EXPECT_LE(run.program["futex wait"], run.cycles + run.program["futex passed"] + 2);
        EXPECT_LE(run.program["futex passed"], run.cycles + 2);
        expectNothingBut(run.program, {"futex wake", "futex wait", "futex passed"});
    }
}

}  // namespace
}  // namespace takt::test
