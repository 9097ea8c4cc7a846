#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <takt/daemon/network_report.hpp>

namespace takt::daemon {

namespace {

struct NamedTimes {
    const char* name;
    const char* brief;
    const TimesReport* times;
};

std::array<NamedTimes, 4> timesOf(const NetworkReport& network) {
    return {{{"wake-up late", "wake-up", &network.lateness},
             {"reply there", "reply", &network.reply},
             {"cycle done", "done", &network.execution},
             {"off SYNC0 grid", "off SYNC0", &network.phaseError}}};
}

std::string microseconds(std::uint64_t nanoseconds) {
    return fmt::format("{:.1f}", static_cast<double>(nanoseconds) / 1000.0);
}

}  // namespace

std::string frameSummary(const NetworkReport& network) {
    std::string text = fmt::format(
        "frames {} sent, {} lost, {} late; working counter errors {}; largest DC phase error {} "
        "ns, controller's clock {:+.1f} ppm against the reference",
        network.framesSent, network.framesLost, network.framesLate, network.workingCounterErrors,
        network.phaseError.most, network.driftPpm);
    const std::array<std::pair<const char*, std::uint64_t>, 4> oddities{
        {{"double", network.framesDuplicate},
         {"malformed", network.framesMalformed},
         {"foreign", network.framesForeign},
         {"not sent", network.sendFailures}}};
    for (const auto& [what, count] : oddities) {
        if (count > 0) text += fmt::format("; {} frames {}", count, what);
    }
    return text;
}

std::vector<std::string> timeTable(const NetworkReport& network) {
    std::vector<std::string> lines{
        fmt::format("missed cycles {}, in {} late wake-ups: {} by the host, {} by the bus, {} by "
                    "programs, {} by axes; DC lock lost {} times",
                    network.missedCycles, network.lateWakeUps, network.missedByHost,
                    network.missedByBus, network.missedByPrograms, network.missedByAxes,
                    network.relocks),
        fmt::format("{:<15}{:>10}{:>10}{:>10}{:>10}{:>10}", "times in us", "least", "mean",
                    "99 % <=", "99.9 % <=", "most")};
    const auto all = timesOf(network);
    std::map<std::uint64_t, std::array<std::uint64_t, 4>> bins;
    std::string heading = fmt::format("{:<15}", "up to us");
    for (std::size_t i = 0; i < all.size(); ++i) {
        const TimesReport& times = *all[i].times;
        lines.push_back(fmt::format("{:<15}{:>10}{:>10}{:>10}{:>10}{:>10}", all[i].name,
                                    microseconds(times.least), microseconds(times.mean),
                                    microseconds(times.mostOf99), microseconds(times.mostOf999),
                                    microseconds(times.most)));
        heading += fmt::format("{:>10}", all[i].brief);
        for (const TimesReport::Bin& bin : times.bins) bins[bin.upTo][i] = bin.count;
    }
    lines.push_back(heading);
    for (const auto& [upTo, counts] : bins) {
        lines.push_back(fmt::format("{:<15.3f}{:>10}{:>10}{:>10}{:>10}",
                                    static_cast<double>(upTo) / 1000.0, counts[0], counts[1],
                                    counts[2], counts[3]));
    }
    return lines;
}

std::vector<std::string> deviceTable(const NetworkReport& network) {
    std::size_t width = 6;
    for (const DeviceReport& device : network.devices) width = std::max(width, device.name.size());
    std::vector<std::string> lines{fmt::format("{:>3}  {:<{}}  {:<14}  {:>11}  {}", "pos", "device",
                                               width, "state", "emergencies",
                                               "AL status, working counter")};
    for (const DeviceReport& device : network.devices) {
        std::string words = device.problem;
        if (!device.workingCounter.empty())
            words += (words.empty() ? "" : "; ") + device.workingCounter;
        std::string emergencies = std::to_string(device.emergencies);
        if (device.emergencies > 0) emergencies += fmt::format(" (0x{:04X})", device.lastEmergency);
        lines.push_back(fmt::format("{:>3}  {:<{}}  {:<14}  {:>11}  {}", device.position,
                                    device.name, width,
                                    device.state + (device.error ? " + ERROR" : ""), emergencies,
                                    words.empty() ? "good" : words));
    }
    return lines;
}

}  // namespace takt::daemon
