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

Counts difference(const Counts& longer, const Counts& shorter) {
    Counts rest = longer;
    for (const auto& [call, count] : shorter) rest[call] -= count;
    return rest;
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

/// Two lengths of the same run: what the longer one has more is what cycles cost. A loaded computer
/// runs fewer cycles in the same time, so cycles are counted by their sleeps.
class SystemCalls : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_EQ(namespacesForbidden(), "");
        const std::string folder = freshFolder("system_calls");
        const ProcessResult result = inNamespaces("system_calls", folder);
        output_ = result.output;
        ASSERT_EQ(linesWith(output_, "run exit 0").size(), 2U) << output_;
        const auto shorter = readCalls(folder + "/calls.1s");
        const auto longer = readCalls(folder + "/calls.3s");
        cycle_ = difference(ofCycle(longer), ofCycle(shorter));
        program_ = difference(ofProgram(longer), ofProgram(shorter));
        cycles_ = cycle_["clock_nanosleep"];
        ASSERT_GT(cycles_, 100) << output_;
        // The end of a stretch may lie on either side of a call.
        spare_ = 2 + 0.02 * cycles_;
    }
    /// Whatever is in `counts` beyond the named calls.
    void expectNothingBut(const Counts& counts, const std::vector<std::string>& known) const {
        for (const auto& [call, count] : counts) {
            if (std::find(known.begin(), known.end(), call) != known.end()) continue;
            EXPECT_LE(count, spare_) << call << " in " << cycles_ << " cycles";
        }
    }

    std::string output_;
    Counts cycle_;
    Counts program_;
    double cycles_{0};
    double spare_{0};
};

TEST_F(SystemCalls, AreOneSendOneReceiveOneSleepAndTwoAtEachGate) {
    // Each cycle between two calls of the program has both; the last one has no sleep behind it.
    EXPECT_NEAR(cycle_["sendmmsg"], cycles_, 1);
    // A reply that is already there need not be waited for; one that is late costs another wait.
    EXPECT_LE(cycle_["ppoll"], cycles_ + spare_ + strayFrames(output_));
    // A call that is still out when its budget ends is waited for again in the next cycle instead
    // of being made, and costs a look at the processor time it has had.
    const double lateCalls = cycle_["clock_gettime"];
    EXPECT_LE(cycle_["futex wake"], cycles_ + 1);
    EXPECT_GE(cycle_["futex wake"], cycles_ - lateCalls - 1);
    // A call that is already back need not be waited for. One that comes back just before the wait
    // begins lets it pass, and its waking may then end the next wait too early.
    EXPECT_LE(cycle_["futex wait"], cycles_ + lateCalls + spare_);
    EXPECT_LE(cycle_["futex passed"], cycles_ + spare_);
    expectNothingBut(cycle_, {"sendmmsg", "ppoll", "clock_nanosleep", "futex wake", "futex wait",
                              "futex passed", "clock_gettime"});

    const double calls = cycle_["futex wake"];
    EXPECT_NEAR(program_["futex wake"], calls, 2);
    EXPECT_LE(program_["futex wait"], calls + spare_);
    EXPECT_LE(program_["futex passed"], calls + spare_);
    expectNothingBut(program_, {"futex wake", "futex wait", "futex passed"});
}

}  // namespace
}  // namespace takt::test
