#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "machine_parts.hpp"
#include "names.hpp"

namespace takt::config {

namespace {

/// The device as the list sets it up, with what the ESI file of the same device knows beyond that.
std::shared_ptr<const wire::DeviceDescription> merged(const EniSlave& slave,
                                                      const wire::DeviceDescription* known) {
    auto device = std::make_shared<wire::DeviceDescription>(slave.device);
    if (known == nullptr) return device;
    device->type = known->type;
    device->vendorName = known->vendorName;
    device->lrwSupported = known->lrwSupported;
    device->timeouts = known->timeouts;
    device->objects = known->objects;
    if (device->mailbox && known->mailbox) {
        device->mailbox->requestTimeout = known->mailbox->requestTimeout;
        device->mailbox->responseTimeout =
            std::max(device->mailbox->responseTimeout, known->mailbox->responseTimeout);
    }
    return device;
}

void checkWatchdog(const SlavePart& slave, const fieldbus::NetworkParams& network) {
    const core::Duration least = 2 * std::int64_t{network.lostLimit} * network.cycle;
    if (slave.params.outputs.empty() || slave.params.watchdog >= least) return;
    slave.reader.error({},
                       fmt::format("the process-data watchdog is set to {} us",
                                   slave.params.watchdog.count() / 1000),
                       fmt::format("at least {} us: twice {} lost cycles", least.count() / 1000,
                                   network.lostLimit),
                       "change it in the network file, or lower lostFrames");
}

SlavePart makePart(const EniSlave& listed, NetworkPart& network, fieldbus::RevisionRule rule) {
    SlavePart slave{
        {listed.place, fmt::format("slave '{}'", listed.name), network.reader.diagnostics()}};
    const auto known = findDevice(listed.device.identity, network.catalogue);
    fieldbus::SlaveParams& params = slave.params;
    params.name = listed.name;
    params.origin = format(listed.place);
    params.position = static_cast<std::uint16_t>(network.slaves.size());
    params.device = merged(listed, known.get());
    params.revisionRule = rule;
    params.outputs = listed.outputs;
    params.inputs = listed.inputs;
    params.dc = listed.dc;
    params.watchdog = listed.watchdog;
    params.outputShift = static_cast<std::uint8_t>(listed.listed.outputs.firstBit % 8);
    params.inputShift = static_cast<std::uint8_t>(listed.listed.inputs.firstBit % 8);
    params.listed = listed.listed;
    slave.twinDevice = known ? known : params.device;
    slave.profile = &profileOfType(params.device->type);
    return slave;
}

struct BindName {
    std::string_view name;
    core::PdoSlot axis::DriveBindings::*slot;
    std::uint8_t bits;
    bool output;
};

constexpr std::array BindNames{
    BindName{"controlword", &axis::DriveBindings::controlword, 16, true},
    BindName{"mode", &axis::DriveBindings::modeOfOperation, 8, true},
    BindName{"targetPosition", &axis::DriveBindings::targetPosition, 32, true},
    BindName{"statusword", &axis::DriveBindings::statusword, 16, false},
    BindName{"modeDisplay", &axis::DriveBindings::modeDisplay, 8, false},
    BindName{"actualPosition", &axis::DriveBindings::actualPosition, 32, false},
    BindName{"errorCode", &axis::DriveBindings::errorCode, 16, false},
    BindName{"digitalInputs", &axis::DriveBindings::digitalInputs, 32, false},
    BindName{"followingError", &axis::DriveBindings::followingError, 32, false},
    BindName{"torque", &axis::DriveBindings::actualTorque, 16, false}};

bool lies(const EniVariable& variable, const fieldbus::ListedRange& share) noexcept {
    return variable.firstBit >= share.firstBit &&
           variable.firstBit + variable.bits <= share.firstBit + share.bits;
}

/// The variables of the slave, in file order.
std::vector<std::string> namesOf(const std::vector<EniVariable>& variables,
                                 const fieldbus::ListedRange& share) {
    std::vector<std::string> names;
    for (const EniVariable& variable : variables) {
        if (lies(variable, share)) names.push_back(variable.name);
    }
    return names;
}

core::PdoSlot bindOne(const ElementReader& reader, const BindName& bind, const std::string& wanted,
                      const EniNetwork& eni, const SlavePart& slave) {
    const auto& variables = bind.output ? eni.outputs : eni.inputs;
    const auto& share = bind.output ? slave.params.listed->outputs : slave.params.listed->inputs;
    const std::vector<std::string> names = namesOf(variables, share);
    const auto found =
        std::find_if(variables.begin(), variables.end(),
                     [&wanted](const EniVariable& variable) { return variable.name == wanted; });
    if (found == variables.end()) {
        const std::string nearest = nearestName(wanted, names);
        reader.error(
            bind.name,
            fmt::format("the {} of the process image have no variable '{}'{}",
                        bind.output ? "outputs" : "inputs", wanted,
                        nearest.empty() ? "" : fmt::format(", did you mean '{}'?", nearest)),
            joined(names));
        return {};
    }
    if (!lies(*found, share)) {
        reader.error(bind.name,
                     fmt::format("the variable '{}' does not belong to the slave '{}'", wanted,
                                 slave.params.name),
                     joined(names));
        return {};
    }
    if (found->bits != bind.bits) {
        reader.error(bind.name, fmt::format("the variable '{}' has {} bits", wanted, found->bits),
                     fmt::format("{} bits", bind.bits));
        return {};
    }
    return {found->firstBit - share.firstBit / 8 * 8, bind.bits};
}

}  // namespace

void readListedSlaves(NetworkPart& network, const std::filesystem::path& file,
                      std::optional<core::Duration> cycle) {
    ElementReader& reader = network.reader;
    using Rule = fieldbus::RevisionRule;
    const auto rule =
        reader.choice<Rule>("checkRevision", {{"equal", Rule::Equal},
                                              {"equalOrGreater", Rule::EqualOrGreater},
                                              {"ignore", Rule::Ignore}});
    for (const XmlElement element : reader.children("Slave")) {
        reader.diagnostics().error({reader.place().file, element.line()},
                                   "the slaves come from the network file",
                                   "no <Slave> beside eni=\"…\"");
    }
    network.slavesKnown = false;
    std::error_code fault;
    if (!std::filesystem::is_regular_file(file, fault)) {
        reader.error("eni", fmt::format("there is no network file {}", file.string()),
                     "a path relative to the machine file", "correct the path or add the file");
        return;
    }
    network.eni = readEni(file, reader.diagnostics());
    if (!network.eni) return;
    network.slavesKnown = true;
    if (cycle && *cycle != network.eni->cycle) {
        reader.error("cycle",
                     fmt::format("the cycle is {} us in the network file",
                                 network.eni->cycle.count() / 1000),
                     "no cycle here, or the same one");
    }
    network.params.cycle = network.eni->cycle;
    network.params.listed = network.eni->listed;
    for (const EniSlave& listed : network.eni->slaves) {
        network.slaves.push_back(makePart(listed, network, rule.value_or(Rule::Equal)));
        checkWatchdog(network.slaves.back(), network.params);
    }
}

axis::DriveBindings readBind(ElementReader reader, const NetworkPart& network,
                             const SlavePart* slave) {
    axis::DriveBindings bindings;
    for (const BindName& bind : BindNames) {
        const auto wanted = reader.text(bind.name);
        if (!wanted || slave == nullptr) continue;
        if (!network.eni || !slave->params.listed) {
            reader.error(bind.name, "there are no variables to bind to",
                         "<Network eni=\"…\"> with a process image");
            return bindings;
        }
        bindings.*bind.slot = bindOne(reader, bind, *wanted, *network.eni, *slave);
    }
    reader.finish();
    return bindings;
}

}  // namespace takt::config
