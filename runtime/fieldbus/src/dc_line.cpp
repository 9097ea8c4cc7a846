#include "dc_line.hpp"

#include <bit>
#include <cstddef>

namespace takt::fieldbus::ethercat {

namespace {

/// The order in which a frame visits the ports of a device.
constexpr std::array<std::uint8_t, 4> VisitOrder{0, 3, 1, 2};
constexpr std::size_t None = ~std::size_t{0};

struct Node {
    std::size_t parent{None};
    std::uint8_t parentPort{0};
    std::uint8_t entry{0};
    std::uint8_t children{0};  ///< already found
};

bool isOpen(const PortTimes& device, std::uint8_t port) noexcept {
    return (device.openPorts & (1U << port)) != 0;
}

/// Receive times wrap at 32 bits; only differences mean anything.
std::int32_t difference(std::uint32_t later, std::uint32_t earlier) noexcept {
    return static_cast<std::int32_t>(later - earlier);
}

/// The open ports after the entry port, in visiting order.
std::vector<std::uint8_t> portsBehind(const PortTimes& device, std::uint8_t entry) {
    std::size_t at = 0;
    while (VisitOrder[at] != entry) ++at;
    std::vector<std::uint8_t> ports;
    for (std::size_t i = 1; i < VisitOrder.size(); ++i) {
        const std::uint8_t port = VisitOrder[(at + i) % VisitOrder.size()];
        if (isOpen(device, port)) ports.push_back(port);
    }
    return ports;
}

/// The port at which the frame came in first; port 0 in normal wiring.
std::uint8_t entryPort(const PortTimes& device) noexcept {
    std::uint8_t entry = 0xFF;
    for (const std::uint8_t port : VisitOrder) {
        if (!isOpen(device, port)) continue;
        if (entry == 0xFF || (device.dc && difference(device.at[port], device.at[entry]) < 0)) {
            entry = port;
        }
    }
    return entry == 0xFF ? 0 : entry;
}

std::vector<Node> buildTree(std::span<const PortTimes> devices) {
    std::vector<Node> nodes(devices.size());
    for (std::size_t i = 0; i < devices.size(); ++i) {
        nodes[i].entry = entryPort(devices[i]);
        for (std::size_t up = i; up-- > 0;) {
            const std::vector<std::uint8_t> ports = portsBehind(devices[up], nodes[up].entry);
            if (nodes[up].children >= ports.size()) continue;
            nodes[i].parent = up;
            nodes[i].parentPort = ports[nodes[up].children++];
            break;
        }
    }
    return nodes;
}

/// Time between a frame's first arrival at a device and its last return to it.
std::int32_t loopInside(const PortTimes& device, std::uint8_t entry) {
    const std::vector<std::uint8_t> ports = portsBehind(device, entry);
    return ports.empty() ? 0 : difference(device.at[ports.back()], device.at[entry]);
}

}  // namespace

std::vector<std::uint32_t> propagationDelays(std::span<const PortTimes> devices) {
    const std::vector<Node> nodes = buildTree(devices);
    std::vector<std::uint32_t> delays(devices.size(), 0);
    for (std::size_t i = 0; i < devices.size(); ++i) {
        if (!devices[i].dc) continue;
        // The nearest DC device on the way to the master, and its port towards this one.
        std::size_t up = nodes[i].parent;
        std::uint8_t port = nodes[i].parentPort;
        while (up != None && !devices[up].dc) {
            port = nodes[up].parentPort;
            up = nodes[up].parent;
        }
        if (up == None) continue;
        const PortTimes& parent = devices[up];
        std::uint8_t before = nodes[up].entry;
        for (const std::uint8_t candidate : portsBehind(parent, nodes[up].entry)) {
            if (candidate == port) break;
            before = candidate;
        }
        const std::int32_t outside = difference(parent.at[port], parent.at[before]);
        const std::int32_t inside = loopInside(devices[i], nodes[i].entry);
        const std::int32_t earlier = difference(parent.at[before], parent.at[nodes[up].entry]);
        const std::int32_t hop = (outside - inside) / 2;
        delays[i] = delays[up] + static_cast<std::uint32_t>(earlier + hop);
    }
    return delays;
}

core::DcTime gridAtOrAfter(core::DcTime earliest, core::Duration grid) noexcept {
    const core::Duration rest = earliest.time_since_epoch() % grid;
    return rest.count() == 0 ? earliest : earliest + (grid - rest);
}

core::Duration phaseError(core::DcTime time, core::Duration phase, core::Duration cycle) noexcept {
    core::Duration rest = (time.time_since_epoch() + phase) % cycle;
    if (rest.count() < 0) rest += cycle;
    return rest >= cycle - cycle / 2 ? rest - cycle : rest;
}

}  // namespace takt::fieldbus::ethercat
