#include "tool_bus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <stdexcept>
#include <takt/config/esi_reader.hpp>
#include <takt/config/load_machine.hpp>
#include <takt/daemon/bus_end.hpp>
#include <takt/daemon/run_options.hpp>
#include <utility>

#include "installed_files.hpp"

namespace takt::cli {

namespace {

/// The tools have one frame under way, and what answers late must not keep its reply out.
constexpr std::size_t FramesAtOnce = 4;

struct KnownDevice {
    wire::DeviceDescription description;
    std::string file;
};

config::MachineConfig load(const std::filesystem::path& machine) {
    auto result = config::loadMachine(machine, {}, config::ProgramLibraries::NotNeeded);
    if (result.machine) return std::move(*result.machine);
    for (const config::Diagnostic& item : result.diagnostics.items()) {
        if (item.severity == config::Severity::Error)
            throw std::runtime_error{config::format(item)};
    }
    throw std::runtime_error{fmt::format("{} cannot be read", machine.string())};
}

void learn(const std::filesystem::path& file, std::vector<KnownDevice>& known) {
    config::Diagnostics diagnostics;
    for (auto& device : config::readEsi(file, diagnostics)) {
        known.push_back({std::move(device), file.filename().string()});
    }
}

std::vector<KnownDevice> catalogue(const BusOptions& options) {
    std::vector<KnownDevice> known;
    for (const auto& file : options.esi) {
        if (!std::filesystem::is_regular_file(file)) {
            throw std::runtime_error{fmt::format("there is no device file {}", file.string())};
        }
        learn(file, known);
    }
    try {
        for (const auto& file : deviceFiles(findInstalledFiles(options.executableFolder)))
            learn(file, known);
    } catch (const std::runtime_error&) {
        // Without the installed files devices still tell who they are.
        return known;
    }
    return known;
}

bool same(const wire::Identity& a, const wire::Identity& b) noexcept {
    return a.vendor == b.vendor && a.product == b.product && a.revision == b.revision;
}

}  // namespace

std::string ToolDevice::type() const {
    if (description != nullptr) return description->type;
    if (!found->order.empty()) return found->order;
    return found->name.empty() ? "?" : found->name;
}

struct ToolBus::Parts {
    std::optional<config::MachineConfig> machine;
    std::unique_ptr<Segment> segment;
    std::vector<KnownDevice> known;
};

ToolBus::ToolBus(const BusOptions& options) : parts_{std::make_unique<Parts>()} {
    Parts& parts = *parts_;
    if (!options.machine.empty()) {
        parts.machine = load(options.machine);
        std::vector<std::string> names;
        for (const auto& slave : parts.machine->network.slaves) names.push_back(slave.name);
        parts.segment =
            std::make_unique<WireSegment>(daemon::simulatedEnd(*parts.machine), std::move(names));
    } else if (!options.interface.empty()) {
        parts.segment = std::make_unique<WireSegment>(
            daemon::interfaceEnd(options.interface, FramesAtOnce), std::vector<std::string>{});
    } else {
        parts.segment = segmentOfMachine(options.socket, "takt " + options.verb);
        for (const auto& file : parts.segment->deviceFiles()) {
            if (std::filesystem::is_regular_file(file)) learn(file, parts.known);
        }
    }
    for (KnownDevice& device : catalogue(options)) parts.known.push_back(std::move(device));
}

ToolBus::~ToolBus() = default;

Segment& ToolBus::segment() noexcept {
    return *parts_->segment;
}

const Segment& ToolBus::segment() const noexcept {
    return *parts_->segment;
}

std::size_t ToolBus::size() const noexcept {
    return parts_->segment->devices().size();
}

ToolDevice ToolBus::device(std::size_t position) const {
    const Parts& parts = *parts_;
    ToolDevice device;
    device.found = &parts.segment->devices()[position];
    device.name = parts.segment->nameOf(position);
    if (parts.machine && position < parts.machine->network.slaves.size()) {
        const auto& slave = parts.machine->network.slaves[position];
        device.description = slave.device.get();
        device.file = std::filesystem::path{slave.device->source}.filename().string();
        return device;
    }
    const auto known =
        std::find_if(parts.known.begin(), parts.known.end(), [&device](const KnownDevice& entry) {
            return same(entry.description.identity, device.found->identity);
        });
    if (known != parts.known.end()) {
        device.description = &known->description;
        device.file = known->file;
    }
    return device;
}

std::size_t ToolBus::find(const std::string& text) const {
    std::size_t position = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, position);
    if (error == std::errc{} && rest == end && position < size()) return position;
    std::string names;
    for (std::size_t i = 0; i < size(); ++i) {
        const std::string name = device(i).name;
        if (!name.empty() && name == text) return i;
        names +=
            fmt::format("{}{}{}", names.empty() ? "" : ", ", i, name.empty() ? "" : " or " + name);
    }
    throw std::runtime_error{fmt::format("there is no device '{}'; there are: {}", text, names)};
}

int runVerb(const char* name, const std::function<int()>& verb) {
    try {
        return verb();
    } catch (const std::exception& error) {
        fmt::print(stderr, "takt {}: {}\n", name, error.what());
        return static_cast<int>(daemon::ExitCode::CouldNotRun);
    }
}

}  // namespace takt::cli
