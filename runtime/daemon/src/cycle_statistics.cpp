#include "cycle_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace takt::daemon {

namespace {

std::string microseconds(std::uint64_t nanoseconds) {
    return fmt::format("{:.1f}", static_cast<double>(nanoseconds) / 1000.0);
}

std::string summary(const char* what, const record::Histogram& times) {
    return fmt::format("{:<14}{:>10}{:>10}{:>10}{:>10}{:>10}", what, microseconds(times.min()),
                       microseconds(times.mean()), microseconds(times.atMost(990)),
                       microseconds(times.atMost(999)), microseconds(times.max()));
}

}  // namespace

std::vector<std::string> describe(const CycleStatistics& statistics) {
    const std::array<const record::Histogram*, 3> all{&statistics.lateness, &statistics.reply,
                                                      &statistics.execution};
    std::vector<std::string> lines{
        fmt::format("{:<14}{:>10}{:>10}{:>10}{:>10}{:>10}", "times in us", "least", "mean",
                    "99 % <=", "99.9 % <=", "most"),
        summary("wake-up late", statistics.lateness), summary("reply there", statistics.reply),
        summary("cycle done", statistics.execution)};
    lines.push_back(
        fmt::format("{:<14}{:>10}{:>10}{:>10}", "up to us", "wake-up", "reply", "done"));
    for (std::size_t bin = 0; bin < record::Histogram::Bins - 1; ++bin) {
        const bool used =
            std::any_of(all.begin(), all.end(), [bin](const auto* h) { return h->bin(bin) > 0; });
        if (!used) continue;
        lines.push_back(fmt::format("{:<14}{:>10}{:>10}{:>10}",
                                    microseconds((std::uint64_t{1} << bin) - 1), all[0]->bin(bin),
                                    all[1]->bin(bin), all[2]->bin(bin)));
    }
    return lines;
}

}  // namespace takt::daemon
