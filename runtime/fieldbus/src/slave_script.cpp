#include "slave_script.hpp"

#include <algorithm>
#include <array>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/device_description.hpp>
#include <takt/wire/registers.hpp>

#include "command_runner.hpp"
#include "listed_script.hpp"

namespace takt::fieldbus::ethercat {

namespace {

namespace reg = wire::reg;
using wire::AlState;
using wire::SyncManagerUse;

constexpr std::uint16_t WatchdogDivider = 2498;  ///< (2498 + 2) · 40 ns = 100 µs
constexpr core::Duration WatchdogUnit = std::chrono::microseconds{100};
constexpr std::uint8_t WatchdogTrigger = 0x40;
constexpr std::uint8_t FmmuRead = 1;
constexpr std::uint8_t FmmuWrite = 2;
constexpr std::uint8_t MailboxFullBit = 3;
constexpr std::uint16_t StatusField = 5;

const wire::DeviceDescription& deviceOf(const SlaveParams& slave) {
    static const wire::DeviceDescription none{};
    return slave.device ? *slave.device : none;
}

std::optional<std::uint8_t> managerFor(const wire::DeviceDescription& device, SyncManagerUse use) {
    const auto& managers = device.syncManagers;
    const auto found = std::find_if(managers.begin(), managers.end(),
                                    [use](const auto& manager) { return manager.use == use; });
    if (found == managers.end()) return std::nullopt;
    return static_cast<std::uint8_t>(found - managers.begin());
}

/// FMMU number for a use: where the description has it, else the customary one.
std::uint8_t fmmuFor(const wire::DeviceDescription& device, wire::FmmuUse use,
                     std::uint8_t customary) {
    const auto& fmmus = device.fmmus;
    const auto found = std::find(fmmus.begin(), fmmus.end(), use);
    return found == fmmus.end() ? customary : static_cast<std::uint8_t>(found - fmmus.begin());
}

RegisterStep write8(std::uint16_t address, std::uint8_t value) {
    return {address, {value}, true};
}

RegisterStep write16(std::uint16_t address, std::uint16_t value) {
    RegisterStep step{address, std::vector<std::uint8_t>(2), true};
    wire::store16(step.data, 0, value);
    return step;
}

RegisterStep syncManagerStep(std::uint8_t number, std::uint16_t start, std::uint16_t length,
                             std::uint8_t control, bool enable) {
    RegisterStep step{static_cast<std::uint16_t>(reg::SyncManager + number * reg::SyncManagerSize),
                      std::vector<std::uint8_t>(reg::SyncManagerSize), true};
    wire::store16(step.data, 0, start);
    wire::store16(step.data, 2, length);
    step.data[4] = control;
    step.data[6] = enable ? 1 : 0;
    return step;
}

struct FmmuMap {
    std::uint32_t logical{0};
    std::uint16_t length{0};
    std::uint8_t startBit{0};
    std::uint8_t stopBit{7};
    std::uint16_t physical{0};
    std::uint8_t physicalBit{0};
    std::uint8_t type{0};
};

RegisterStep fmmuStep(std::uint8_t number, const FmmuMap& map) {
    RegisterStep step{static_cast<std::uint16_t>(reg::Fmmu + number * reg::FmmuSize),
                      std::vector<std::uint8_t>(reg::FmmuSize), true};
    wire::store32(step.data, 0, map.logical);
    wire::store16(step.data, 4, map.length);
    step.data[6] = map.startBit;
    step.data[7] = map.stopBit;
    wire::store16(step.data, 8, map.physical);
    step.data[10] = map.physicalBit;
    step.data[11] = map.type;
    step.data[12] = 1;
    return step;
}

ObjectStep objectStep(std::uint16_t index, std::uint8_t subindex, std::uint32_t number,
                      std::uint8_t size, bool required, std::string origin) {
    std::vector<std::uint8_t> data(4);
    wire::store32(data, 0, number);
    data.resize(size);
    return {{index, subindex}, std::move(data), required, std::move(origin)};
}

void append(Script& script, Script&& more) {
    std::move(more.begin(), more.end(), std::back_inserter(script));
}

// --- objects
// -------------------------------------------------------------------------------------------

}  // namespace

Script startupSteps(const SlaveParams& slave) {
    Script script;
    for (const StartupObject& object : slave.startup) {
        script.emplace_back(ObjectStep{
            {object.index, object.subindex}, object.data, object.required, object.origin});
    }
    return script;
}

namespace {

bool isUsed(const SlaveParams& slave, std::uint16_t pdo) {
    const auto same = [pdo](const PdoParams& params) { return params.index == pdo; };
    return std::any_of(slave.outputs.begin(), slave.outputs.end(), same) ||
           std::any_of(slave.inputs.begin(), slave.inputs.end(), same);
}

/// Some drives refuse a mapping while any other one still holds entries, so unused ones are emptied
/// too.
Script emptyMappings(const SlaveParams& slave) {
    Script script;
    for (const auto* list : {&slave.outputs, &slave.inputs}) {
        for (const PdoParams& pdo : *list) {
            if (pdo.writeMapping) {
                script.emplace_back(objectStep(pdo.index, 0, 0, 1, true, "PDO mapping"));
            }
        }
    }
    const wire::DeviceDescription& device = deviceOf(slave);
    for (const auto* list : {&device.rxPdos, &device.txPdos}) {
        for (const wire::PdoDescription& pdo : *list) {
            if (!pdo.fixed && !isUsed(slave, pdo.index)) {
                script.emplace_back(objectStep(pdo.index, 0, 0, 1, false, "unused PDO"));
            }
        }
    }
    return script;
}

Script writeMappings(const SlaveParams& slave) {
    Script script;
    for (const auto* list : {&slave.outputs, &slave.inputs}) {
        for (const PdoParams& pdo : *list) {
            if (!pdo.writeMapping) continue;
            std::uint8_t subindex = 0;
            for (const PdoEntryParams& entry : pdo.entries) {
                const std::uint32_t word = (std::uint32_t{entry.index} << 16) |
                                           (std::uint32_t{entry.subindex} << 8) | entry.bits;
                script.emplace_back(
                    objectStep(pdo.index, ++subindex, word, 4, true, "PDO mapping"));
            }
            script.emplace_back(objectStep(pdo.index, 0, subindex, 1, true, "PDO mapping"));
        }
    }
    return script;
}

Script writeAssignment(std::uint16_t object, const std::vector<PdoParams>& pdos) {
    Script script;
    std::uint8_t subindex = 0;
    for (const PdoParams& pdo : pdos) {
        script.emplace_back(objectStep(object, ++subindex, pdo.index, 2, true, "PDO assignment"));
    }
    script.emplace_back(objectStep(object, 0, subindex, 1, true, "PDO assignment"));
    return script;
}

bool hasWritable(const wire::DeviceDescription& device, std::uint16_t index,
                 std::uint8_t subindex) {
    const wire::ObjectDescription* object = device.findObject(index);
    if (object == nullptr) return false;
    return std::any_of(object->entries.begin(), object->entries.end(), [=](const auto& entry) {
        return entry.subindex == subindex && entry.writable;
    });
}

/// 1C32h and 1C33h, sub-index 1: 2 = synchronous with SYNC0. Optional: a device may take it from
/// 0x0981.
Script syncModeSteps(const SlaveParams& slave) {
    constexpr std::uint32_t dcSync0 = 2;
    Script script;
    if (!slave.dc.enabled) return script;
    for (const std::uint16_t index : {std::uint16_t{0x1C32}, std::uint16_t{0x1C33}}) {
        if (hasWritable(deviceOf(slave), index, 1)) {
            script.emplace_back(objectStep(index, 1, dcSync0, 2, false, "DC synchronisation"));
        }
    }
    return script;
}

// --- registers
// -----------------------------------------------------------------------------------------

Script processDataSteps(const SlaveParams& slave, const SlavePlace& place,
                        const ProcessGroup& group) {
    Script script;
    const wire::DeviceDescription& device = deviceOf(slave);
    if (const auto out = managerFor(device, SyncManagerUse::Outputs)) {
        const auto& manager = device.syncManagers[*out];
        std::uint8_t control = manager.control;
        if (slave.watchdog.count() > 0) control |= WatchdogTrigger;
        script.emplace_back(syncManagerStep(*out, manager.start, place.outputBytes, control,
                                            place.outputBytes != 0));
        if (place.outputBytes != 0) {
            script.emplace_back(fmmuStep(fmmuFor(device, wire::FmmuUse::Outputs, 0),
                                         {group.logical + place.outputOffset, place.outputBytes, 0,
                                          7, manager.start, 0, FmmuWrite}));
        }
    }
    if (const auto in = managerFor(device, SyncManagerUse::Inputs)) {
        const auto& manager = device.syncManagers[*in];
        script.emplace_back(syncManagerStep(*in, manager.start, place.inputBytes, manager.control,
                                            place.inputBytes != 0));
        if (place.inputBytes != 0) {
            script.emplace_back(fmmuStep(fmmuFor(device, wire::FmmuUse::Inputs, 1),
                                         {group.inputLogical() + place.inputOffset,
                                          place.inputBytes, 0, 7, manager.start, 0, FmmuRead}));
        }
    }
    const std::optional<MailboxPlace> mailbox = mailboxPlace(slave);
    if (mailbox && place.mailboxBit != NoMailboxBit) {
        const auto bit = static_cast<std::uint8_t>(place.mailboxBit % 8);
        const auto status = static_cast<std::uint16_t>(
            reg::SyncManager + mailbox->inManager * reg::SyncManagerSize + StatusField);
        script.emplace_back(fmmuStep(fmmuFor(device, wire::FmmuUse::MailboxState, 2),
                                     {MailboxStateBase + place.mailboxBit / 8U, 1, bit, bit, status,
                                      MailboxFullBit, FmmuRead}));
    }
    return script;
}

Script watchdogSteps(const SlaveParams& slave) {
    Script script;
    const auto units = static_cast<std::uint16_t>(
        std::clamp<std::int64_t>(slave.watchdog / WatchdogUnit, 0, 0xFFFF));
    script.emplace_back(write16(reg::WatchdogDivider, WatchdogDivider));
    script.emplace_back(write16(reg::WatchdogTimeProcessData, units));
    return script;
}

/// Register 0x09A4 from the wanted SYNC1 period: SYNC1 fires C1 after a SYNC0 that finds its timer
/// at rest.
std::uint32_t sync1Register(const wire::DeviceDescription& device, const DcParams& dc,
                            core::Duration sync0, core::Duration cycle) {
    constexpr std::uint16_t sync1On = 0x0400;
    if ((dc.assignActivate & sync1On) == 0) return 0;
    core::Duration period = sync0;
    for (const wire::DcMode& mode : device.dcModes) {
        if (mode.assignActivate != dc.assignActivate) continue;
        if (mode.cycleSync1.count() > 0) {
            period = mode.cycleSync1;
        } else if (mode.cycleSync1Factor < 0) {
            period = cycle;
        } else if (mode.cycleSync1Factor > 0) {
            period = sync0 * mode.cycleSync1Factor;
        }
    }
    return period > sync0 ? static_cast<std::uint32_t>((period - sync0).count()) : 0;
}

Script armSteps(const NetworkParams& network, const SlaveParams& slave) {
    Script script;
    if (!slave.dc.enabled) return script;
    const core::Duration cycle = sync0Cycle(network, slave);
    script.emplace_back(write8(reg::DcActivation, 0));
    script.emplace_back(
        write8(reg::DcCyclicControl, static_cast<std::uint8_t>(slave.dc.assignActivate)));
    RegisterStep cycles{reg::DcSync0Cycle, std::vector<std::uint8_t>(8), true};
    wire::store32(cycles.data, 0, static_cast<std::uint32_t>(cycle.count()));
    wire::store32(cycles.data, 4, sync1Register(deviceOf(slave), slave.dc, cycle, network.cycle));
    script.emplace_back(std::move(cycles));
    script.emplace_back(RegisterStep{reg::DcStartTime, std::vector<std::uint8_t>(8), true});
    script.emplace_back(
        write8(reg::DcActivation, static_cast<std::uint8_t>(slave.dc.assignActivate >> 8)));
    return script;
}

Script unmapSteps(const SlaveParams& slave) {
    Script script;
    if (slave.dc.enabled) script.emplace_back(write8(reg::DcActivation, 0));
    const wire::DeviceDescription& device = deviceOf(slave);
    for (std::uint8_t i = 0; i < std::min<std::uint8_t>(device.fmmuCount, 3); ++i) {
        script.emplace_back(
            write8(static_cast<std::uint16_t>(reg::Fmmu + i * reg::FmmuSize + 12), 0));
    }
    for (const auto use : {SyncManagerUse::Outputs, SyncManagerUse::Inputs}) {
        if (const auto number = managerFor(device, use)) {
            script.emplace_back(write8(
                static_cast<std::uint16_t>(reg::SyncManager + *number * reg::SyncManagerSize + 6),
                0));
        }
    }
    // Going down must come to its end whatever a device thinks of these.
    for (Step& step : script) std::get<RegisterStep>(step).required = false;
    return script;
}

Script preOpScript(const SlaveParams& slave, const SlavePlace& place, const ProcessGroup& group) {
    Script script = makeMailboxScript(slave);
    // The device's own processor may need its EEPROM from here on.
    script.emplace_back(RegisterStep{reg::EepromConfiguration, {1}, false});
    script.emplace_back(StateStep{AlState::PreOp, deviceOf(slave).timeouts.preOp});
    append(script, startupSteps(slave));
    append(script, makePdoScript(slave));
    append(script, syncModeSteps(slave));
    append(script, processDataSteps(slave, place, group));
    append(script, watchdogSteps(slave));
    return script;
}

}  // namespace

std::optional<MailboxPlace> mailboxPlace(const SlaveParams& slave) {
    const wire::DeviceDescription& device = deviceOf(slave);
    const auto out = managerFor(device, SyncManagerUse::MailboxOut);
    const auto in = managerFor(device, SyncManagerUse::MailboxIn);
    if (!device.mailbox || !out || !in) return std::nullopt;
    const auto& outBox = device.syncManagers[*out];
    const auto& inBox = device.syncManagers[*in];
    return MailboxPlace{
        *out, *in, outBox.start, outBox.defaultSize, inBox.start, inBox.defaultSize};
}

Script makeMailboxScript(const SlaveParams& slave) {
    Script script;
    const std::optional<MailboxPlace> place = mailboxPlace(slave);
    if (!place) return script;
    const auto& managers = deviceOf(slave).syncManagers;
    script.emplace_back(syncManagerStep(place->outManager, place->outStart, place->outSize,
                                        managers[place->outManager].control, true));
    script.emplace_back(syncManagerStep(place->inManager, place->inStart, place->inSize,
                                        managers[place->inManager].control, true));
    return script;
}

core::Duration sync0Cycle(const NetworkParams& network, const SlaveParams& slave) {
    return slave.dc.sync0Cycle.count() > 0 ? slave.dc.sync0Cycle : network.cycle;
}

Script makePdoScript(const SlaveParams& slave) {
    const auto rewrites = [](const PdoParams& pdo) { return pdo.writeMapping; };
    const bool mapping = std::any_of(slave.outputs.begin(), slave.outputs.end(), rewrites) ||
                         std::any_of(slave.inputs.begin(), slave.inputs.end(), rewrites);
    Script script;
    if (!mapping && !slave.writeAssignment) return script;
    const wire::DeviceDescription& device = deviceOf(slave);
    const bool assignment = slave.writeAssignment || (device.mailbox && device.mailbox->pdoAssign);
    if (assignment) {
        script.emplace_back(objectStep(0x1C12, 0, 0, 1, true, "PDO assignment"));
        script.emplace_back(objectStep(0x1C13, 0, 0, 1, true, "PDO assignment"));
    }
    if (mapping) {
        append(script, emptyMappings(slave));
        append(script, writeMappings(slave));
    }
    if (assignment) {
        append(script, writeAssignment(0x1C12, slave.outputs));
        append(script, writeAssignment(0x1C13, slave.inputs));
    }
    return script;
}

void setSyncStart(Script& armSync, const SlaveParams& slave, core::DcTime start) {
    std::array<std::uint8_t, 8> own{};
    wire::store64(
        own, 0,
        static_cast<std::uint64_t>((start + slave.dc.sync0Shift).time_since_epoch().count()));
    const auto enter = [&own](std::vector<std::uint8_t>& data) {
        std::copy_n(own.begin(), std::min(own.size(), data.size()), data.begin());
    };
    for (Step& step : armSync) {
        if (auto* write = std::get_if<RegisterStep>(&step)) {
            if (write->address == reg::DcStartTime) enter(write->data);
        } else if (auto* listed = std::get_if<CommandStep>(&step)) {
            if (listed->command.ado == reg::DcStartTime && writes(listed->command)) {
                enter(listed->command.data);
            }
        }
    }
}

SlaveScripts makeScripts(const NetworkParams& network, std::size_t slave,
                         const LogicalLayout& layout) {
    const SlaveParams& params = network.slaves[slave];
    const SlavePlace& place = layout.slaves[slave];
    const wire::StateTimeouts& timeouts = deviceOf(params).timeouts;
    if (params.listed) return makeListedScripts(params);
    SlaveScripts scripts;
    scripts.toPreOp = preOpScript(params, place, layout.groups[place.group]);
    scripts.armSync = armSteps(network, params);
    scripts.toSafeOp = {StateStep{AlState::SafeOp, timeouts.safeOpOp}};
    scripts.toOp = {StateStep{AlState::Op, timeouts.safeOpOp}};
    scripts.recover = scripts.toOp;
    scripts.backToSafeOp = {StateStep{AlState::SafeOp, timeouts.backToSafeOp}};
    scripts.backToPreOp = {StateStep{AlState::PreOp, timeouts.backToInit}};
    append(scripts.backToPreOp, unmapSteps(params));
    scripts.backToInit = {StateStep{AlState::Init, timeouts.backToInit},
                          RegisterStep{reg::EepromConfiguration, {0}, false}};
    return scripts;
}

}  // namespace takt::fieldbus::ethercat
