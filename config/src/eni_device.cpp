#include "eni_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <takt/core/cia402.hpp>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

#include "eni_commands.hpp"
#include "esi_devices.hpp"
#include "esi_types.hpp"

namespace takt::config {

namespace {

namespace reg = wire::reg;
namespace cia402 = core::cia402;
using wire::DeviceDescription;
using wire::SyncManagerUse;

constexpr std::int64_t Most32 = 0xFFFFFFFF;
constexpr std::size_t MostSyncManagers = 16;
constexpr std::size_t MostFmmus = 16;
constexpr std::uint16_t CyclicSync0 = 0x0300;  // bits of AssignActivate

/// "Drive 1 (CD300E)" -> "CD300E"; without brackets the whole name.
std::string typeOf(const std::string& name) {
    const std::size_t open = name.rfind('(');
    if (open == std::string::npos || name.back() != ')' || open + 2 >= name.size()) return name;
    return name.substr(open + 1, name.size() - open - 2);
}

void readIdentity(XmlElement info, EniSlave& slave, const EsiValues& values) {
    wire::Identity& identity = slave.device.identity;
    for (const char* const needed : {"VendorId", "ProductCode"}) {
        if (info.child(needed).present()) continue;
        values.error(info.line(), fmt::format("slave '{}' has no <{}>", slave.name, needed),
                     "the identity of the device");
    }
    const auto number = [&](std::string_view name) {
        return static_cast<std::uint32_t>(values.child(info, name, 0, Most32, 0));
    };
    identity.vendor = number("VendorId");
    identity.product = number("ProductCode");
    identity.revision = number("RevisionNo");
    identity.serial = number("SerialNo");
    slave.device.physics = info.child("Physics").text();
    slave.device.type = typeOf(slave.name);
    slave.device.name = slave.name;
    slave.device.source = values.file();
}

struct Box {
    std::uint16_t start{0};
    std::uint16_t length{0};
};

std::optional<Box> readBox(XmlElement mailbox, std::string_view name, const EsiValues& values) {
    const XmlElement element = mailbox.child(name);
    constexpr std::int64_t longest = 1486;
    const std::int64_t start = values.child(element, "Start", 0, 0xFFFF, 0);
    const std::int64_t length = values.child(element, "Length", 0, longest, 0);
    if (start < reg::ProcessRam || length == 0) {
        values.error(element.present() ? element.line() : mailbox.line(),
                     fmt::format("<Mailbox>/<{}> has no place in the device", name),
                     "<Start> from 4096 and <Length> from 1 to 1486");
        return std::nullopt;
    }
    return Box{static_cast<std::uint16_t>(start), static_cast<std::uint16_t>(length)};
}

/// \return the boxes to and from the device
std::array<std::optional<Box>, 2> readMailbox(XmlElement mailbox, EniSlave& slave,
                                              const EsiValues& values) {
    if (!mailbox.present()) return {};
    const XmlElement coe = mailbox.child("CoE");
    wire::MailboxDescription description;
    description.coe = coe.present();
    for (const XmlElement protocol : mailbox.children("Protocol")) {
        description.coe = description.coe || protocol.text() == "CoE";
    }
    description.responseTimeout =
        std::max(description.responseTimeout, longestCoeTimeout(coe.child("InitCmds"), values));
    for (const fieldbus::ListedObject& object : slave.listed.objects) {
        const bool mapping = (object.index >= 0x1600 && object.index <= 0x17FF) ||
                             (object.index >= 0x1A00 && object.index <= 0x1BFF);
        description.pdoConfig = description.pdoConfig || mapping;
        description.pdoAssign =
            description.pdoAssign || object.index == 0x1C12 || object.index == 0x1C13;
        description.completeAccess = description.completeAccess || object.completeAccess;
    }
    for (const char* const other : {"SoE", "AoE", "EoE", "FoE"}) {
        const XmlElement commands = mailbox.child(other).child("InitCmds");
        if (commands.child("InitCmd").present()) {
            values.error(commands.line(), fmt::format("{} init commands cannot be executed", other),
                         "CoE init commands");
        }
    }
    slave.device.mailbox = description;
    const XmlElement bit = mailbox.child("Recv").child("StatusBitAddr");
    if (bit.present()) {
        const auto number = values.number(bit.text(), bit.line(), "<StatusBitAddr>", 0, 0x7FFF);
        if (number) slave.listed.mailboxStateBit = static_cast<std::uint16_t>(*number);
    }
    return {readBox(mailbox, "Send", values), readBox(mailbox, "Recv", values)};
}

SyncManagerUse useByText(std::string_view text) noexcept {
    if (text == "Outputs") return SyncManagerUse::Outputs;
    if (text == "Inputs") return SyncManagerUse::Inputs;
    if (text == "MBoxOut") return SyncManagerUse::MailboxOut;
    if (text == "MBoxIn") return SyncManagerUse::MailboxIn;
    return SyncManagerUse::Unused;
}

/// The last setting of each SyncManager that switches it on.
void takeSyncManagers(EniSlave& slave, const std::array<std::optional<Box>, 2>& boxes) {
    constexpr std::uint8_t fromMaster = 0x04;
    auto& managers = slave.device.syncManagers;
    for (const fieldbus::ListedCommand& command : slave.listed.commands) {
        for (std::size_t n = 0; n < MostSyncManagers; ++n) {
            const auto at = static_cast<std::uint16_t>(reg::SyncManager + n * reg::SyncManagerSize);
            const auto data = writtenAt(command, at, reg::SyncManagerSize);
            if (!data || ((*data)[6] & 1U) == 0) continue;
            if (managers.size() <= n) managers.resize(n + 1);
            wire::SyncManagerDescription& manager = managers[n];
            manager.start = wire::load16(*data, 0);
            manager.defaultSize = wire::load16(*data, 2);
            manager.control = (*data)[4];
            if (manager.use != SyncManagerUse::Unused) continue;
            if (boxes[0] && manager.start == boxes[0]->start) {
                manager.use = SyncManagerUse::MailboxOut;
            } else if (boxes[1] && manager.start == boxes[1]->start) {
                manager.use = SyncManagerUse::MailboxIn;
            } else {
                manager.use = (manager.control & fromMaster) != 0 ? SyncManagerUse::Outputs
                                                                  : SyncManagerUse::Inputs;
            }
        }
    }
    slave.device.syncManagerCount =
        std::max(slave.device.syncManagerCount, static_cast<std::uint8_t>(managers.size()));
}

void takeFmmus(EniSlave& slave) {
    constexpr std::uint8_t readType = 1;
    auto& fmmus = slave.device.fmmus;
    for (const fieldbus::ListedCommand& command : slave.listed.commands) {
        for (std::size_t n = 0; n < MostFmmus; ++n) {
            const auto at = static_cast<std::uint16_t>(reg::Fmmu + n * reg::FmmuSize);
            const auto data = writtenAt(command, at, reg::FmmuSize);
            if (!data || ((*data)[12] & 1U) == 0) continue;
            if (fmmus.size() <= n) fmmus.resize(n + 1, wire::FmmuUse::Unused);
            const bool status = isSyncManagerStatus(wire::load16(*data, 8));
            fmmus[n] = status                          ? wire::FmmuUse::MailboxState
                       : ((*data)[11] & readType) != 0 ? wire::FmmuUse::Inputs
                                                       : wire::FmmuUse::Outputs;
        }
    }
    slave.device.fmmuCount =
        std::max(slave.device.fmmuCount, static_cast<std::uint8_t>(fmmus.size()));
}

/// The PDOs that a <SmN> lists, else those whose definition names the SyncManager.
void assignPdos(XmlElement processData, DeviceDescription& device, const EsiValues& values) {
    for (std::size_t n = 0; n < MostSyncManagers; ++n) {
        const XmlElement element = processData.child(fmt::format("Sm{}", n));
        if (!element.present()) continue;
        if (device.syncManagers.size() <= n) device.syncManagers.resize(n + 1);
        const SyncManagerUse use = useByText(element.child("Type").text());
        if (use != SyncManagerUse::Unused) device.syncManagers[n].use = use;
        for (const XmlElement listed : element.children("Pdo")) {
            const auto index = values.number(listed.text(), listed.line(), "<Pdo>", 0, 0xFFFF);
            bool found = false;
            for (auto* const pdos : {&device.rxPdos, &device.txPdos}) {
                for (wire::PdoDescription& pdo : *pdos) {
                    if (!index || pdo.index != *index) continue;
                    pdo.syncManager = static_cast<std::uint8_t>(n);
                    found = true;
                }
            }
            if (index && !found) {
                values.error(listed.line(), fmt::format("the PDO {:#06x} is not defined", *index),
                             "the <RxPdo> and <TxPdo> of the slave");
            }
        }
    }
}

std::vector<fieldbus::PdoParams> assigned(const std::vector<wire::PdoDescription>& pdos) {
    std::vector<fieldbus::PdoParams> result;
    for (const wire::PdoDescription& pdo : pdos) {
        if (!pdo.syncManager) continue;
        fieldbus::PdoParams params{pdo.index, {}, false};
        for (const wire::PdoEntryDescription& entry : pdo.entries) {
            params.entries.push_back({entry.index, entry.subindex, entry.bits});
        }
        result.push_back(std::move(params));
    }
    return result;
}

// --- dictionary
// -----------------------------------------------------------------------------------

wire::DataType typeOfBits(std::size_t bits) noexcept {
    if (bits == 1) return wire::DataType::Boolean;
    if (bits <= 8) return wire::DataType::Unsigned8;
    if (bits <= 16) return wire::DataType::Unsigned16;
    if (bits <= 32) return wire::DataType::Unsigned32;
    return wire::DataType::Unsigned64;
}

/// Objects by index and sub-index, while they are collected.
using Entries = std::map<std::uint16_t, std::map<std::uint8_t, wire::ObjectEntryDescription>>;

void addMapped(Entries& entries, const std::vector<wire::PdoDescription>& pdos,
               wire::PdoMappable direction) {
    for (const wire::PdoDescription& pdo : pdos) {
        for (const wire::PdoEntryDescription& mapped : pdo.entries) {
            if (mapped.index == 0) continue;
            auto& entry = entries[mapped.index][mapped.subindex];
            const auto type = builtInType(mapped.type);
            entry.subindex = mapped.subindex;
            entry.name = mapped.name;
            entry.bits = mapped.bits;
            entry.type = type && type->bits == mapped.bits ? type->type : typeOfBits(mapped.bits);
            entry.writable = entry.writable || direction == wire::PdoMappable::Receive;
            entry.mappable = entry.mappable == wire::PdoMappable::No || entry.mappable == direction
                                 ? direction
                                 : wire::PdoMappable::Both;
        }
    }
}

void addWritable(Entries& entries, std::uint16_t index, std::uint8_t subindex, wire::DataType type,
                 std::uint16_t bits) {
    auto& object = entries[index];
    const auto [place, fresh] = object.try_emplace(subindex);
    wire::ObjectEntryDescription& entry = place->second;
    entry.writable = true;
    if (!fresh) return;
    entry.subindex = subindex;
    entry.type = type;
    entry.bits = bits;
}

/// What every CiA 402 drive with homing has (IEC 61800-7-201), as far as an axis writes it.
void addDriveObjects(Entries& entries) {
    using wire::DataType;
    addWritable(entries, cia402::HomingMethod, 0, DataType::Integer8, 8);
    addWritable(entries, cia402::HomingSpeeds, 1, DataType::Unsigned32, 32);
    addWritable(entries, cia402::HomingSpeeds, 2, DataType::Unsigned32, 32);
    addWritable(entries, cia402::HomingAcceleration, 0, DataType::Unsigned32, 32);
    addWritable(entries, cia402::QuickStopDeceleration, 0, DataType::Unsigned32, 32);
}

/// Objects that the master and the device's own start-up give anyway.
bool belongsToStartUp(std::uint16_t index) noexcept {
    return (index >= 0x1600 && index <= 0x17FF) || (index >= 0x1A00 && index <= 0x1BFF) ||
           (index >= 0x1C00 && index <= 0x1C33);
}

void makeDictionary(EniSlave& slave) {
    DeviceDescription& device = slave.device;
    Entries entries;
    addMapped(entries, device.rxPdos, wire::PdoMappable::Receive);
    addMapped(entries, device.txPdos, wire::PdoMappable::Transmit);
    for (const fieldbus::ListedObject& object : slave.listed.objects) {
        if (object.completeAccess || belongsToStartUp(object.index) || object.data.size() > 8) {
            continue;
        }
        const auto bits = static_cast<std::uint16_t>(8 * object.data.size());
        addWritable(entries, object.index, object.subindex, typeOfBits(bits), bits);
    }
    const auto controlword = entries.find(cia402::ControlWord);
    if (controlword != entries.end() && controlword->second.contains(0)) addDriveObjects(entries);
    for (auto& [index, object] : entries) {
        wire::ObjectDescription description;
        description.index = index;
        for (auto& [subindex, entry] : object) {
            description.name = description.name.empty() ? entry.name : description.name;
            description.entries.push_back(entry);
        }
        device.objects.push_back(std::move(description));
    }
}

// --- clocks
// ---------------------------------------------------------------------------------------

void readDc(XmlElement element, EniSlave& slave, const EsiValues& values) {
    const XmlElement dc = element.child("DC");
    std::uint16_t activate = 0;
    std::optional<std::pair<std::uint32_t, int>> cycle;  // with its line
    for (const fieldbus::ListedCommand& command : slave.listed.commands) {
        if (!command.transitions.has(fieldbus::Transition::PreOpToSafeOp)) continue;
        const int line = lineOf(command.origin);
        if (const auto data = writtenAt(command, reg::DcCyclicControl, 2)) {
            activate = wire::load16(*data, 0);
        } else if (const auto high = writtenAt(command, reg::DcActivation, 1)) {
            activate = static_cast<std::uint16_t>((activate & 0xFFU) | (*high)[0] << 8U);
        }
        if (const auto data = writtenAt(command, reg::DcSync0Cycle, 4)) {
            cycle = {wire::load32(*data, 0), line};
        }
    }
    slave.dc.assignActivate = activate;
    slave.dc.enabled = (activate & CyclicSync0) == CyclicSync0;
    if (!dc.present() && !slave.dc.enabled) return;
    constexpr std::int64_t second = 1'000'000'000;
    const std::int64_t told = values.child(dc, "CycleTime0", 0, second, 0);
    slave.dc.sync0Cycle = core::Duration{told};
    slave.dc.sync0Shift = core::Duration{values.child(dc, "ShiftTime", -second, second, 0)};
    if (slave.dc.enabled && (!cycle || cycle->first != told || told == 0)) {
        values.error(cycle          ? cycle->second
                     : dc.present() ? dc.line()
                                    : element.line(),
                     fmt::format("slave '{}': SYNC0 is switched on with a cycle of {} ns, but "
                                 "<DC>/<CycleTime0> is {} ns",
                                 slave.name, cycle ? cycle->first : 0, told),
                     "the same cycle in the init command at 0x09A0 and in <DC>");
    }
    wire::DcMode mode;
    mode.name = "DC";
    mode.assignActivate = activate;
    mode.cycleSync0 = slave.dc.sync0Cycle;
    slave.device.dcModes.push_back(mode);
}

// --- watchdog
// -------------------------------------------------------------------------------------

void readWatchdog(EniSlave& slave, const EsiValues& values) {
    constexpr std::int64_t tick = 40;  // ns
    std::int64_t divider = 2498;
    std::int64_t units = 1000;
    int line = slave.place.line;
    for (const fieldbus::ListedCommand& command : slave.listed.commands) {
        if (const auto data = writtenAt(command, reg::WatchdogDivider, 2)) {
            divider = wire::load16(*data, 0);
        }
        if (const auto data = writtenAt(command, reg::WatchdogTimeProcessData, 2)) {
            units = wire::load16(*data, 0);
            line = lineOf(command.origin);
        }
    }
    slave.watchdog = core::Duration{units * (divider + 2) * tick};
    if (units != 0) return;
    if (slave.listed.outputs.bits != 0) {
        values.error(line,
                     fmt::format("slave '{}': the process-data watchdog is off: outputs would stay "
                                 "on when the controller dies",
                                 slave.name),
                     "a time at register 0x0420");
    }
    slave.watchdog = std::chrono::milliseconds{100};  // of no meaning without outputs
}

}  // namespace

void readEniDevice(XmlElement element, EniSlave& slave, const EsiValues& values) {
    DeviceDescription& device = slave.device;
    readIdentity(element.child("Info"), slave, values);
    const auto boxes = readMailbox(element.child("Mailbox"), slave, values);
    takeSyncManagers(slave, boxes);
    takeFmmus(slave);
    const XmlElement processData = element.child("ProcessData");
    device.rxPdos = readPdoElements(processData, "RxPdo", values);
    device.txPdos = readPdoElements(processData, "TxPdo", values);
    assignPdos(processData, device, values);
    slave.outputs = assigned(device.rxPdos);
    slave.inputs = assigned(device.txPdos);
    makeDictionary(slave);
    readDc(element, slave, values);
    readWatchdog(slave, values);
}

}  // namespace takt::config
