#include <fmt/format.h>

#include <takt/config/esi_reader.hpp>
#include <utility>

#include "esi_devices.hpp"
#include "esi_dictionary.hpp"
#include "esi_values.hpp"
#include "xml_document.hpp"

namespace takt::config {

namespace {

using wire::DeviceDescription;

constexpr std::int64_t Most8 = 0xFF;
constexpr std::int64_t Most16 = 0xFFFF;
constexpr std::int64_t Most32 = 0xFFFFFFFF;
constexpr std::int64_t LongestNs = 3'600'000'000'000;

wire::SyncManagerUse useOf(std::string_view text) noexcept {
    if (text == "MBoxOut") return wire::SyncManagerUse::MailboxOut;
    if (text == "MBoxIn") return wire::SyncManagerUse::MailboxIn;
    if (text == "Outputs") return wire::SyncManagerUse::Outputs;
    if (text == "Inputs") return wire::SyncManagerUse::Inputs;
    return wire::SyncManagerUse::Unused;
}

wire::FmmuUse fmmuUseOf(std::string_view text) noexcept {
    if (text == "Outputs") return wire::FmmuUse::Outputs;
    if (text == "Inputs") return wire::FmmuUse::Inputs;
    if (text == "MBoxState") return wire::FmmuUse::MailboxState;
    return wire::FmmuUse::Unused;
}

void readIdentity(XmlElement device, DeviceDescription& description, const EsiValues& values) {
    const XmlElement type = device.child("Type");
    description.type = type.text();
    description.name = englishName(device);
    if (description.name.empty()) description.name = description.type;
    if (!type.present() || !type.attribute("ProductCode")) {
        values.error(device.line(),
                     fmt::format("device '{}': the product code is missing", description.name),
                     "<Type ProductCode=\"#x…\" RevisionNo=\"#x…\">");
    }
    auto& identity = description.identity;
    identity.product =
        static_cast<std::uint32_t>(values.attribute(type, "ProductCode", 0, Most32, 0));
    identity.revision =
        static_cast<std::uint32_t>(values.attribute(type, "RevisionNo", 0, Most32, 0));
    identity.serial = static_cast<std::uint32_t>(values.attribute(type, "SerialNo", 0, Most32, 0));
    description.lrwSupported = !values.flag(type, "UseLrdLwr", false);
    if (const auto physics = device.attribute("Physics"))
        description.physics = std::string{physics->value};
}

void readInfo(XmlElement device, DeviceDescription& description, const EsiValues& values) {
    const XmlElement info = device.child("Info");
    const XmlElement states = info.child("StateMachine").child("Timeout");
    auto& timeouts = description.timeouts;
    timeouts.preOp = values.milliseconds(states, "PreopTimeout", timeouts.preOp);
    timeouts.safeOpOp = values.milliseconds(states, "SafeopOpTimeout", timeouts.safeOpOp);
    timeouts.backToInit = values.milliseconds(states, "BackToInitTimeout", timeouts.backToInit);
    timeouts.backToSafeOp =
        values.milliseconds(states, "BackToSafeopTimeout", timeouts.backToSafeOp);
    const XmlElement controller = info.child("EtherCATController");
    constexpr std::int64_t KiB = 1024;
    const std::int64_t ram =
        values.child(controller, "DpramSize", 0, 60 * KiB, description.ramKib * KiB);
    description.ramKib = static_cast<std::uint16_t>(ram / KiB);
    description.syncManagerCount = static_cast<std::uint8_t>(
        values.child(controller, "SmCount", 0, 16, description.syncManagerCount));
    description.fmmuCount = static_cast<std::uint8_t>(
        values.child(controller, "FmmuCount", 0, 16, description.fmmuCount));
}

void readSyncManagers(XmlElement device, DeviceDescription& description, const EsiValues& values) {
    for (const XmlElement element : device.children("Fmmu")) {
        description.fmmus.push_back(fmmuUseOf(element.text()));
    }
    for (const XmlElement element : device.children("Sm")) {
        wire::SyncManagerDescription manager;
        const auto word = [&](std::string_view name) {
            return static_cast<std::uint16_t>(values.attribute(element, name, 0, Most16, 0));
        };
        manager.use = useOf(element.text());
        manager.start = word("StartAddress");
        manager.defaultSize = word("DefaultSize");
        manager.minSize = word("MinSize");
        manager.maxSize = word("MaxSize");
        manager.control =
            static_cast<std::uint8_t>(values.attribute(element, "ControlByte", 0, Most8, 0));
        manager.enabled = (values.attribute(element, "Enable", 0, Most8, 1) & 1) != 0;
        description.syncManagers.push_back(manager);
    }
    constexpr std::size_t MostSyncManagers = 16;
    if (description.syncManagers.size() > MostSyncManagers ||
        description.fmmus.size() > MostSyncManagers) {
        values.error(device.line(),
                     fmt::format("device '{}': too many <Sm> or <Fmmu>", description.name),
                     "at most 16 of each");
    }
}

wire::PdoEntryDescription readPdoEntry(XmlElement element, const EsiValues& values) {
    wire::PdoEntryDescription entry;
    entry.index = static_cast<std::uint16_t>(values.child(element, "Index", 0, Most16, 0));
    entry.subindex = static_cast<std::uint8_t>(values.child(element, "SubIndex", 0, Most8, 0));
    entry.bits = static_cast<std::uint8_t>(values.child(element, "BitLen", 0, Most8, 0));
    entry.name = englishName(element);
    entry.type = element.child("DataType").text();
    return entry;
}

}  // namespace

std::vector<wire::PdoDescription> readPdoElements(XmlElement device, std::string_view name,
                                                  const EsiValues& values) {
    std::vector<wire::PdoDescription> pdos;
    for (const XmlElement element : device.children(name)) {
        wire::PdoDescription pdo;
        pdo.index = static_cast<std::uint16_t>(values.child(element, "Index", 0, Most16, 0));
        pdo.name = englishName(element);
        pdo.fixed = values.flag(element, "Fixed", false);
        pdo.mandatory = values.flag(element, "Mandatory", false);
        const std::int64_t manager = values.attribute(element, "Sm", 0, Most8, -1);
        if (manager >= 0 && manager < 16) pdo.syncManager = static_cast<std::uint8_t>(manager);
        for (const XmlElement entry : element.children("Entry")) {
            pdo.entries.push_back(readPdoEntry(entry, values));
        }
        pdos.push_back(std::move(pdo));
    }
    return pdos;
}

namespace {

void readMailbox(XmlElement device, DeviceDescription& description, const EsiValues& values) {
    const XmlElement element = device.child("Mailbox");
    if (!element.present()) return;
    wire::MailboxDescription mailbox;
    const XmlElement coe = element.child("CoE");
    mailbox.coe = coe.present();
    mailbox.sdoInfo = values.flag(coe, "SdoInfo", false);
    mailbox.pdoAssign = values.flag(coe, "PdoAssign", false);
    mailbox.pdoConfig = values.flag(coe, "PdoConfig", false);
    mailbox.completeAccess = values.flag(coe, "CompleteAccess", false);
    const XmlElement times = device.child("Info").child("Mailbox").child("Timeout");
    mailbox.requestTimeout = values.milliseconds(times, "RequestTimeout", mailbox.requestTimeout);
    mailbox.responseTimeout =
        values.milliseconds(times, "ResponseTimeout", mailbox.responseTimeout);
    description.mailbox = mailbox;
}

/// A factor may be written as a negative number or as 16 bits in hexadecimal.
std::int32_t factorOf(XmlElement mode, std::string_view name, std::int32_t fallback,
                      const EsiValues& values) {
    const std::int64_t factor =
        values.attribute(mode.child(name), "Factor", -32768, Most16, fallback);
    return static_cast<std::int32_t>(factor > 32767 ? factor - 65536 : factor);
}

void readDcModes(XmlElement device, DeviceDescription& description, const EsiValues& values) {
    for (const XmlElement element : device.child("Dc").children("OpMode")) {
        wire::DcMode mode;
        const auto time = [&](std::string_view name) {
            return core::Duration{values.child(element, name, -LongestNs, LongestNs, 0)};
        };
        mode.name = element.child("Name").text();
        mode.assignActivate =
            static_cast<std::uint16_t>(values.child(element, "AssignActivate", 0, Most16, 0));
        mode.cycleSync0 = time("CycleTimeSync0");
        mode.shiftSync0 = time("ShiftTimeSync0");
        mode.cycleSync1 = time("CycleTimeSync1");
        mode.cycleSync0Factor = factorOf(element, "CycleTimeSync0", mode.cycleSync0Factor, values);
        mode.cycleSync1Factor = factorOf(element, "CycleTimeSync1", mode.cycleSync1Factor, values);
        description.dcModes.push_back(std::move(mode));
    }
}

EsiDevice readDevice(XmlElement element, const std::string& file, std::uint32_t vendor,
                     const std::string& vendorName) {
    EsiDevice device;
    const EsiValues values{file, device.diagnostics};
    DeviceDescription& description = device.description;
    description.source = file;
    description.vendorName = vendorName;
    description.identity.vendor = vendor;
    readIdentity(element, description, values);
    readInfo(element, description, values);
    readSyncManagers(element, description, values);
    description.rxPdos = readPdoElements(element, "RxPdo", values);
    description.txPdos = readPdoElements(element, "TxPdo", values);
    readMailbox(element, description, values);
    readDcModes(element, description, values);
    description.objects = readDictionary(element, values);
    if (const XmlElement slots = element.child("Slots"); slots.present()) {
        values.note(slots.line(),
                    fmt::format("device '{}': its modules are not read", description.name));
    }
    return device;
}

void readInfoElement(XmlElement info, const std::string& file, std::vector<EsiDevice>& devices,
                     Diagnostics& diagnostics) {
    const EsiValues values{file, diagnostics};
    const XmlElement vendor = info.child("Vendor");
    const auto id = vendor.child("Id").present()
                        ? static_cast<std::uint32_t>(values.child(vendor, "Id", 0, Most32, 0))
                        : std::uint32_t{0};
    if (!vendor.child("Id").present()) {
        diagnostics.error({file, info.line()}, "the vendor's id is missing",
                          "<Vendor><Id>…</Id></Vendor>");
    }
    const XmlElement list = info.child("Descriptions").child("Devices");
    for (const XmlElement element : list.children("Device")) {
        devices.push_back(readDevice(element, file, id, englishName(vendor)));
    }
}

}  // namespace

std::vector<EsiDevice> readEsiDevices(const std::filesystem::path& file, Diagnostics& diagnostics) {
    std::vector<EsiDevice> devices;
    const auto document = loadXml(file, MaxDeviceFile, diagnostics);
    if (!document) return devices;
    const XmlElement root = document->root();
    const std::size_t before = diagnostics.errorCount();
    if (root.name() == "EtherCATInfo") {
        readInfoElement(root, document->file(), devices, diagnostics);
    } else if (root.name() == "EtherCATInfoList") {
        for (const XmlElement info : root.children("EtherCATInfo")) {
            readInfoElement(info, document->file(), devices, diagnostics);
        }
    } else {
        diagnostics.error({document->file(), root.line()},
                          fmt::format("<{}> is not the root of a device description", root.name()),
                          "<EtherCATInfo>, <EtherCATInfoList>");
    }
    if (devices.empty() && diagnostics.errorCount() == before) {
        diagnostics.error({document->file(), root.line()}, "the file describes no device",
                          "at least one <Device> in <Descriptions>/<Devices>");
    }
    return devices;
}

std::vector<wire::DeviceDescription> readEsi(const std::filesystem::path& file,
                                             Diagnostics& diagnostics) {
    std::vector<wire::DeviceDescription> descriptions;
    for (EsiDevice& device : readEsiDevices(file, diagnostics)) {
        diagnostics.append(device.diagnostics);
        if (!device.diagnostics.hasErrors()) descriptions.push_back(std::move(device.description));
    }
    diagnostics.sort();
    return descriptions;
}

}  // namespace takt::config
