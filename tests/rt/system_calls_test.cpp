#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>

#include "namespaces.hpp"

namespace takt::test {
namespace {

using Counts = std::map<std::string, double>;

/// Of an strace: the calls of each thread by their name.
std::map<std::string, Counts> readCalls(const std::string& file) {
    std::map<std::string, Counts> threads;
    std::ifstream lines{file};
    const std::regex call{R"(^(\d+) +([a-z_0-9]+)\(.*)"};
    for (std::string line; std::getline(lines, line);) {
        std::smatch parts;
        if (std::regex_match(line, parts, call)) threads[parts[1]][parts[2]] += 1;
    }
    return threads;
}

/// The thread that does most of a call.
Counts busiest(const std::map<std::string, Counts>& threads, const std::string& call,
               const std::string& butNot = {}) {
    Counts best;
    for (const auto& [thread, counts] : threads) {
        if (!butNot.empty() && counts.contains(butNot)) continue;
        const auto found = counts.find(call);
        if (found != counts.end() && (!best.contains(call) || found->second > best[call]))
            best = counts;
    }
    return best;
}

Counts difference(const Counts& longer, const Counts& shorter) {
    Counts rest;
    for (const auto& [call, count] : longer) {
        const auto found = shorter.find(call);
        const double more = count - (found == shorter.end() ? 0 : found->second);
        if (more != 0) rest[call] = more;
    }
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

/// Two lengths of the same run: what the longer one has more is what cycles cost.
TEST(SystemCalls, AreOneSendOneReceiveOneSleepAndTwoAtEachGate) {
    ASSERT_EQ(namespacesForbidden(), "");
    const std::string folder = freshFolder("system_calls");
    const ProcessResult result = inNamespaces("system_calls", folder);
    const auto exits = linesWith(result.output, "run exit 0");
    ASSERT_EQ(exits.size(), 2U) << result.output;
    const auto shorter = readCalls(folder + "/calls.1s");
    const auto longer = readCalls(folder + "/calls.3s");

    // Bring-up sends too, in another thread: the cycle's is the one that waits at gates.
    Counts cycle = difference(busiest(longer, "clock_nanosleep", "execve"),
                              busiest(shorter, "clock_nanosleep", "execve"));
    const double cycles = cycle["sendmmsg"];
    ASSERT_GT(cycles, 400) << result.output;
    EXPECT_EQ(cycle["clock_nanosleep"], cycles);
    // A reply or a call that is already back need not be waited for. On a busy computer a reply may
    // be late, which costs one more wait, and so may a call, which costs a look at the processor
    // time it has had.
    const double spare = 0.02 * cycles;
    const double lateCalls = cycle["clock_gettime"];
    EXPECT_LE(cycle["ppoll"], cycles + spare + strayFrames(result.output));
    EXPECT_GE(cycle["futex"], cycles - lateCalls);
    EXPECT_LE(cycle["futex"], 2 * cycles + spare);
    cycle.erase("clock_gettime");
    for (const auto& [call, count] : cycle) {
        const bool known =
            call == "sendmmsg" || call == "ppoll" || call == "clock_nanosleep" || call == "futex";
        EXPECT_TRUE(known || count < spare)
            << call << ": " << count << " more in " << cycles << " cycles";
    }
    Counts program =
        difference(busiest(longer, "futex", "sendmmsg"), busiest(shorter, "futex", "sendmmsg"));
    EXPECT_LE(program["futex"], 2 * cycles + spare);
    EXPECT_GE(program["futex"], cycles - lateCalls);
    program.erase("futex");
    for (const auto& [call, count] : program) EXPECT_LT(count, spare) << call;
}

}  // namespace
}  // namespace takt::test
