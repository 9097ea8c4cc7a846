#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "machine_parts.hpp"
#include "names.hpp"

namespace takt::config {

namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr std::int64_t Most32 = 0xFFFFFFFF;
constexpr core::Duration ShortestCycle = microseconds{50};
constexpr core::Duration LongestCycle = milliseconds{100};
// Watchdog register: 16 bits in units of 100 us (ETG.1000.4, 0x0400 and 0x0420 as delivered).
constexpr core::Duration WatchdogUnit = microseconds{100};
constexpr core::Duration LongestWatchdog = 65535 * WatchdogUnit;
// AssignActivate: the high byte goes to register 0x0981; bit 1 = SYNC0, bit 2 = SYNC1.
constexpr std::uint16_t ActivateSync0 = 0x0200;
constexpr std::uint16_t ActivateSync1 = 0x0400;

std::string show(core::Duration time) {
    if (time.count() % 1'000'000 == 0) return fmt::format("{} ms", time.count() / 1'000'000);
    if (time.count() % 1000 == 0) return fmt::format("{} us", time.count() / 1000);
    return fmt::format("{} ns", time.count());
}

void readDc(SlavePart& slave, core::Duration cycle) {
    ElementReader reader = slave.reader.childReader("Dc");
    const auto name = reader.text("mode");
    const auto shift = reader.time("shift", Sign::Any);
    reader.finish();
    const auto& modes = slave.params.device->dcModes;
    if (name == "off") return;
    std::vector<std::string> known{"off"};
    const wire::DcMode* chosen = nullptr;
    for (const wire::DcMode& mode : modes) {
        known.push_back(mode.name);
        const bool usual = (mode.assignActivate & ActivateSync0) != 0 &&
                           (mode.assignActivate & ActivateSync1) == 0;
        const bool wanted = name ? mode.name == *name : usual;
        if (chosen == nullptr && wanted) chosen = &mode;
    }
    if (chosen == nullptr) {
        if (name)
            reader.error("mode", fmt::format("the device has no DC mode '{}'", *name),
                         joined(known));
        return;
    }
    if ((chosen->assignActivate & ActivateSync1) != 0) {
        reader.error(
            "mode",
            fmt::format("the DC mode '{}' needs SYNC1, which is not supported", chosen->name),
            joined(known));
        return;
    }
    fieldbus::DcParams& dc = slave.params.dc;
    dc.assignActivate = chosen->assignActivate;
    dc.enabled = (chosen->assignActivate & ActivateSync0) != 0;
    dc.sync0Shift = shift.value_or(chosen->shiftSync0);
    dc.sync0Cycle = cycle;
    // Factor rule of ETG.2000 for a cycle time of 0: positive multiplies, negative divides.
    const std::int32_t factor = chosen->cycleSync0Factor;
    if (chosen->cycleSync0.count() != 0) {
        dc.sync0Cycle = chosen->cycleSync0;
    } else if (factor != 0) {
        dc.sync0Cycle = factor > 0 ? cycle * factor : cycle / -factor;
    }
    if (shift && (*shift >= cycle || *shift <= -cycle)) {
        reader.error("shift", "the shift is not below the cycle time",
                     fmt::format("-{} to {}", show(cycle), show(cycle)));
    }
}

void readWatchdog(SlavePart& slave, const fieldbus::NetworkParams& network) {
    ElementReader reader = slave.reader.childReader("Watchdog");
    const auto time = reader.time("time", Sign::Any, Presence::Required);
    reader.finish();
    slave.params.watchdog = time.value_or(slave.params.watchdog);
    // Twice what the master itself tolerates: a slave must not stop before the master reacts.
    const core::Duration least = 2 * std::int64_t{network.lostLimit} * network.cycle;
    const std::string allowed =
        fmt::format("multiples of 100 us from {} (twice {} lost cycles) to 6553500 us", show(least),
                    network.lostLimit);
    const core::Duration watchdog = slave.params.watchdog;
    const ElementReader& at = reader.present() ? reader : slave.reader;
    if (watchdog.count() == 0) {
        at.error("time", "the watchdog is off: outputs would stay on when the controller dies",
                 allowed);
    } else if (watchdog < least) {
        at.error("time", fmt::format("the watchdog of {} is too short", show(watchdog)), allowed,
                 "lengthen it, or lower lostFrames or cycle of the network");
    } else if (watchdog > LongestWatchdog || watchdog.count() % WatchdogUnit.count() != 0) {
        at.error("time", fmt::format("the watchdog cannot be set to {}", show(watchdog)), allowed);
    }
}

void readSlaveElement(SlavePart& slave, Catalogue& catalogue,
                      const fieldbus::NetworkParams& network) {
    ElementReader& reader = slave.reader;
    const auto name = reader.name("name");
    slave.params.name = name.value_or("");
    slave.params.origin = format(reader.place());
    if (name) reader.relabel(fmt::format("slave '{}'", *name));
    const auto type = reader.text("device", Presence::Required);
    WantedIdentity wanted;
    wanted.vendor = reader.integer("vendor", {0, Most32});
    wanted.product = reader.integer("product", {0, Most32});
    wanted.revision = reader.integer("revision", {0, Most32});
    using Rule = fieldbus::RevisionRule;
    const auto rule =
        reader.choice<Rule>("checkRevision", {{"equal", Rule::Equal},
                                              {"equalOrGreater", Rule::EqualOrGreater},
                                              {"ignore", Rule::Ignore}});
    slave.params.revisionRule = rule.value_or(Rule::Equal);
    const auto profile = reader.choice<std::string>(
        "profile", {{"cd300e", "cd300e"}, {"ra", "ra"}, {"generic", "generic"}});
    if (type) slave.params.device = selectDevice(*type, wanted, reader, catalogue);
    if (slave.params.device) {
        slave.profile = profile ? findProfile(*profile) : &profileOfType(slave.params.device->type);
        readDc(slave, network.cycle);
        readWatchdog(slave, network);
        readPdos(slave);
        readStartup(slave);
    } else {
        // Known, but not readable without a device description.
        for (const char* known : {"Dc", "Watchdog", "Pdo", "Startup"}) reader.children(known);
    }
    reader.finish();
}

void readSlaves(NetworkPart& network, Catalogue& catalogue) {
    constexpr std::size_t MostSlaves = 1000;
    const std::vector<XmlElement> elements = network.reader.children("Slave");
    if (elements.empty() || elements.size() > MostSlaves) {
        network.reader.error({}, fmt::format("the network has {} slaves", elements.size()),
                             "1 to 1000 <Slave>");
        return;
    }
    std::map<std::string, int> lines;
    for (const XmlElement element : elements) {
        SlavePart slave{
            {element, "slave", network.reader.place().file, network.reader.diagnostics()}};
        readSlaveElement(slave, catalogue, network.params);
        slave.params.position = static_cast<std::uint16_t>(network.slaves.size());
        const std::string& name = slave.params.name;
        const auto [first, fresh] = lines.emplace(name, element.line());
        if (!fresh && !name.empty()) {
            slave.reader.error(
                "name", fmt::format("there is a slave of this name in line {}", first->second),
                "each name once", "rename one of them");
        }
        network.slaves.push_back(std::move(slave));
    }
}

/// What the device description itself tells of the cycle times a device takes (ETG.1000.6, 1C32h).
bool takesCycle(const wire::DeviceDescription& device, core::Duration cycle) {
    const wire::ObjectDescription* const object = device.findObject(0x1C32);
    if (object == nullptr) return true;
    for (const wire::ObjectEntryDescription& entry : object->entries) {
        if (entry.subindex == 2 && entry.minimum && cycle.count() < *entry.minimum) return false;
        if (entry.subindex == 2 && entry.maximum && *entry.maximum > 0 &&
            cycle.count() > *entry.maximum) {
            return false;
        }
        if (entry.subindex != 5) continue;
        std::int64_t shortest = 0;
        for (std::size_t i = 0; i < entry.defaultValue.size() && i < 4; ++i) {
            shortest |= std::int64_t{entry.defaultValue[i]} << (8U * i);
        }
        if (cycle.count() < shortest) return false;
    }
    return true;
}

/// One message for all slaves of a kind.
void checkCycle(const NetworkPart& network) {
    std::map<std::string, std::pair<std::string, std::string>> refusing;
    const core::Duration cycle = network.params.cycle;
    for (const SlavePart& slave : network.slaves) {
        if (!slave.params.device) continue;
        const bool byProfile = takesCycle(*slave.profile, cycle);
        if (byProfile && takesCycle(*slave.params.device, cycle)) continue;
        auto& [names, allowed] = refusing[slave.params.device->type];
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", slave.params.name);
        allowed = byProfile ? "what object 1C32h of the device allows" : slave.profile->cycleText;
    }
    for (const auto& [type, entry] : refusing) {
        network.reader.error("cycle",
                             fmt::format("a cycle of {} is refused by the {} of slave {}",
                                         show(cycle), type, entry.first),
                             entry.second);
    }
}

void checkCycleRange(NetworkPart& network) {
    core::Duration& cycle = network.params.cycle;
    if (cycle >= ShortestCycle && cycle <= LongestCycle) return;
    network.reader.error("cycle", fmt::format("a cycle of {} is not supported", show(cycle)),
                         "50 us to 100 ms");
    cycle = milliseconds{1};
}

}  // namespace

NetworkPart readNetwork(ElementReader networkReader, const std::filesystem::path& folder) {
    NetworkPart network{std::move(networkReader)};
    ElementReader& reader = network.reader;
    reader.relabel("network");
    fieldbus::NetworkParams& params = network.params;
    const auto cycle = reader.time("cycle", Sign::Positive);
    params.cycle = cycle.value_or(params.cycle);
    checkCycleRange(network);
    params.lostLimit = static_cast<std::uint32_t>(
        reader.integer("lostFrames", {1, 1000}).value_or(params.lostLimit));
    params.sendJitter = reader.time("sendJitter").value_or(params.sendJitter);
    params.dcLimit = reader.time("dcLimit", Sign::Positive).value_or(params.dcLimit);
    params.dcDriftFrames = static_cast<std::uint32_t>(
        reader.integer("dcDriftFrames", {0, 1'000'000}).value_or(params.dcDriftFrames));
    params.interface = reader.text("interface").value_or("");
    constexpr std::size_t LongestInterface = 15;  // IFNAMSIZ without its end
    if (params.interface.size() > LongestInterface ||
        params.interface.find_first_of(" /") != std::string::npos) {
        reader.error("interface",
                     fmt::format("'{}' is no name of a network interface", params.interface),
                     "at most 15 characters without blanks and '/', for example \"eth1\"");
    }
    network.catalogue = readCatalogue(reader, folder);
    if (const auto eni = reader.text("eni")) {
        readListedSlaves(network, (folder / *eni).lexically_normal(), cycle);
        checkCycleRange(network);
    } else {
        readSlaves(network, network.catalogue);
    }
    checkCycle(network);
    reader.finish();
    return network;
}

}  // namespace takt::config
