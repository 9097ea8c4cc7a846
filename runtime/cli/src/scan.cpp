#include <fmt/format.h>

#include <stdexcept>

#include "bus_verbs.hpp"
#include "json.hpp"

namespace takt::cli {

namespace {

std::string portsOf(std::uint8_t open) {
    std::string text;
    for (unsigned port = 0; port < 4; ++port) {
        if (((open >> port) & 1U) != 0) text += std::to_string(port);
    }
    return text.empty() ? "-" : text;
}

std::string jsonOf(const ToolDevice& device) {
    const auto& found = *device.found;
    JsonObject object;
    object.addRaw("pos", std::to_string(found.position))
        .add("name", device.name)
        .add("type", device.type())
        .add("text", found.name)
        .addRaw("vendor", std::to_string(found.identity.vendor))
        .addRaw("product", std::to_string(found.identity.product))
        .addRaw("revision", std::to_string(found.identity.revision))
        .addRaw("serial", std::to_string(found.identity.serial))
        .addRaw("alias", std::to_string(found.alias))
        .add("dc", found.clock)
        .add("coe", found.coe)
        .add("ports", portsOf(found.openPorts))
        .add("file", device.file);
    return object.text();
}

}  // namespace

int scan(const BusOptions& options) {
    return runVerb("scan", [&options] {
        if (options.interface.empty() && options.machine.empty()) {
            throw std::runtime_error{
                "where? name a network with --interface IF, or a simulated one with --sim "
                "MACHINE.xml; takt slaves shows the devices of the machine that runs"};
        }
        const ToolBus bus{options};
        std::vector<std::string> lines;
        if (!options.json) {
            fmt::print(
                "{:>3}  {:<10}  {:<10}  {:<10}  {:>10}  {:>5}  {:<3}  {:<3}  {:<5}  {:<16}  {}\n",
                "pos", "vendor", "product", "revision", "serial", "alias", "dc", "coe", "ports",
                "type", "device file");
        }
        for (std::size_t i = 0; i < bus.size(); ++i) {
            const ToolDevice device = bus.device(i);
            const auto& found = *device.found;
            if (options.json) {
                lines.push_back(jsonOf(device));
                continue;
            }
            fmt::print(
                "{:>3}  0x{:08X}  0x{:08X}  0x{:08X}  {:>10}  {:>5}  {:<3}  {:<3}  {:<5}  {:<16}  "
                "{}\n",
                i, found.identity.vendor, found.identity.product, found.identity.revision,
                found.identity.serial, found.alias, found.clock ? "yes" : "no",
                found.coe ? "yes" : "no", portsOf(found.openPorts), device.type(),
                device.file.empty() ? "none: name one with --esi" : device.file);
        }
        if (options.json) fmt::print("{}\n", jsonArray(lines));
        return 0;
    });
}

}  // namespace takt::cli
