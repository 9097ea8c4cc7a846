#include <fmt/format.h>

#include <algorithm>
#include <takt/bridge/bridge_params.hpp>

#include "machine_parts.hpp"

namespace takt::config {

namespace {

using namespace std::chrono_literals;

constexpr std::int64_t HighestDomain = 230;  // beyond, ports of the domain do not exist
constexpr std::int64_t MostCycles = 100'000;
constexpr core::Duration UsualPeriod = 10ms;
constexpr std::size_t LongestInterface = 15;  // IFNAMSIZ without its end
constexpr double Second = 1e9;

double hertz(double cycles, core::Duration cycle) {
    return Second / (cycles * static_cast<double>(cycle.count()));
}

/// A whole number of cycles, or the subscriber would see a beat of both.
std::optional<std::uint32_t> cyclesOf(const Quantity& rate, core::Duration cycle,
                                      const ElementReader& reader) {
    const auto cycleRatio = makeRatio(cycle.count(), static_cast<std::int64_t>(Second));
    const auto ratio = rate.exact && cycleRatio ? multiply(*rate.exact, *cycleRatio) : std::nullopt;
    const double cycles = Second / (rate.value * static_cast<double>(cycle.count()));
    if (ratio && ratio->numerator == 1 && ratio->denominator <= MostCycles) {
        return static_cast<std::uint32_t>(ratio->denominator);
    }
    const double below = std::clamp(static_cast<double>(static_cast<std::int64_t>(cycles)), 1.0,
                                    static_cast<double>(MostCycles));
    reader.error("rate", "status is published in every n-th cycle, which this rate does not give",
                 fmt::format("{:g} Hz, {:g} Hz and others that divide {:g} Hz", hertz(below, cycle),
                             hertz(below + 1, cycle), hertz(1, cycle)));
    return std::nullopt;
}

bridge::DdsParams readDds(ElementReader reader, core::Duration cycle) {
    bridge::DdsParams dds;
    if (!reader.present()) return dds;
    dds.enabled = true;
    dds.everyCycles = static_cast<std::uint32_t>(std::max<std::int64_t>(1, UsualPeriod / cycle));
    if (const auto rate = reader.quantity("rate", Dimension::Rate, Sign::Positive)) {
        dds.everyCycles = cyclesOf(*rate, cycle, reader).value_or(dds.everyCycles);
    }
    dds.domain = static_cast<std::uint32_t>(
        reader.integer("domain", {0, HighestDomain}).value_or(dds.domain));
    dds.interface = reader.name("interface", Presence::Optional).value_or(dds.interface);
    dds.commands =
        reader.choice<bool>("commands", {{"off", false}, {"on", true}}).value_or(dds.commands);
    reader.finish();
    if (dds.interface.size() > LongestInterface) {
        reader.error("interface", "no network interface has so long a name", "up to 15 characters");
    }
    if (dds.commands && dds.interface != "lo") {
        reader.error("commands", "whoever reaches this interface could move the axes",
                     "off, or on with interface=\"lo\"",
                     "let a program on this computer send the commands");
    }
    return dds;
}

}  // namespace

bridge::BridgeParams readBridge(ElementReader reader, core::Duration cycle) {
    bridge::BridgeParams params;
    if (!reader.present()) return params;
    params.dds = readDds(reader.childReader("Dds", Presence::Required), cycle);
    reader.finish();
    return params;
}

}  // namespace takt::config
