#include "devices.hpp"

namespace takt::twin::test {

namespace {

using wire::DataType;
using wire::PdoMappable;

void addObject(wire::DeviceDescription& device, std::uint16_t index, DataType type,
               std::uint16_t bits, bool writable, PdoMappable mappable, std::int64_t value = 0) {
    wire::ObjectEntryDescription entry;
    entry.type = type;
    entry.bits = bits;
    entry.writable = writable;
    entry.mappable = mappable;
    for (int i = 0; i < bits / 8; ++i) {
        entry.defaultValue.push_back(
            static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
    }
    device.objects.push_back({index, "", {entry}});
}

/// 6099h:04, :05 and :07 of the CD300E.
void addVendorHoming(wire::ObjectDescription& speeds) {
    const auto add = [&](std::uint8_t subindex, DataType type, std::uint16_t bits,
                         std::uint8_t value) {
        wire::ObjectEntryDescription entry;
        entry.subindex = subindex;
        entry.type = type;
        entry.bits = bits;
        entry.writable = true;
        entry.defaultValue.assign(bits / 8U, 0);
        entry.defaultValue[0] = value;
        speeds.entries.push_back(entry);
    };
    add(4, DataType::Unsigned16, 16, 20);
    add(5, DataType::Unsigned8, 8, 0);
    add(7, DataType::Unsigned16, 16, 200);
}

void addObjects(wire::DeviceDescription& device, const std::string& type) {
    const bool ra = type == "ra";
    wire::ObjectEntryDescription name;
    name.type = DataType::VisibleString;
    const std::string text = "A drive with a name longer than four bytes";
    name.defaultValue.assign(text.begin(), text.end());
    name.bits = static_cast<std::uint16_t>(8 * text.size());
    device.objects.push_back({0x1008, "Device name", {name}});
    addObject(device, 0x603F, DataType::Unsigned16, 16, false, PdoMappable::Transmit);
    addObject(device, 0x6040, DataType::Unsigned16, 16, true, PdoMappable::Receive);
    addObject(device, 0x6041, DataType::Unsigned16, 16, false, PdoMappable::Transmit);
    if (!ra) {
        addObject(device, 0x605A, DataType::Integer16, 16, true, PdoMappable::No,
                  type == "generic" ? 2 : 0);
    }
    addObject(device, 0x6060, DataType::Integer8, 8, true, PdoMappable::Receive, ra ? 0 : 1);
    addObject(device, 0x6061, DataType::Integer8, 8, false, PdoMappable::Transmit);
    addObject(device, 0x6064, DataType::Integer32, 32, false, PdoMappable::Transmit);
    addObject(device, 0x6065, DataType::Unsigned32, 32, true, PdoMappable::No,
              ra ? 3840000 : 50000);
    addObject(device, 0x6066, DataType::Unsigned16, 16, true, PdoMappable::No, 10);
    addObject(device, 0x606C, DataType::Integer32, 32, false, PdoMappable::Transmit);
    addObject(device, 0x607A, DataType::Integer32, 32, true, PdoMappable::Receive);
    addObject(device, 0x607C, DataType::Integer32, 32, true, PdoMappable::No);
    addObject(device, 0x6084, DataType::Unsigned32, 32, true, PdoMappable::No, 1000000);
    addObject(device, 0x6085, DataType::Unsigned32, 32, true, PdoMappable::No, 1000000);
    addObject(device, 0x6098, DataType::Integer8, 8, true, PdoMappable::No);
    wire::ObjectDescription speeds{0x6099, "Homing speeds", {}};
    for (std::uint8_t sub = 0; sub <= 2; ++sub) {
        wire::ObjectEntryDescription entry;
        entry.subindex = sub;
        entry.type = sub == 0 ? DataType::Unsigned8 : DataType::Unsigned32;
        entry.bits = sub == 0 ? 8 : 32;
        entry.writable = sub != 0;
        speeds.entries.push_back(entry);
    }
    if (type == "cd300e") addVendorHoming(speeds);
    device.objects.push_back(speeds);
    addObject(device, 0x609A, DataType::Unsigned32, 32, true, PdoMappable::No, 1000000);
    addObject(device, 0x60F4, DataType::Integer32, 32, false, PdoMappable::Transmit);
    addObject(device, 0x60FD, DataType::Unsigned32, 32, false, PdoMappable::Transmit);
    device.objects.back().entries[0].minimum = 0;
    addObject(device, 0x6502, DataType::Unsigned32, 32, false, PdoMappable::No, 0x3A0);
}

wire::SyncManagerDescription manager(wire::SyncManagerUse use, std::uint16_t start,
                                     std::uint16_t size, std::uint8_t control) {
    wire::SyncManagerDescription sm;
    sm.use = use;
    sm.start = start;
    sm.defaultSize = size;
    sm.control = control;
    return sm;
}

}  // namespace

std::shared_ptr<wire::DeviceDescription> servoDescription(const std::string& type) {
    auto device = std::make_shared<wire::DeviceDescription>();
    device->type = type;
    device->name = "Test servo";
    device->identity = {0x0000AFFE, 0x00000042, 0x00010002, 0x12345678};
    device->physics = "YY";
    device->fmmus = {wire::FmmuUse::Outputs, wire::FmmuUse::Inputs, wire::FmmuUse::MailboxState};
    device->syncManagers = {manager(wire::SyncManagerUse::MailboxOut, 0x1000, 128, 0x26),
                            manager(wire::SyncManagerUse::MailboxIn, 0x1080, 128, 0x22),
                            manager(wire::SyncManagerUse::Outputs, 0x1100, 7, 0x64),
                            manager(wire::SyncManagerUse::Inputs, 0x1400, 13, 0x20)};
    device->mailbox = wire::MailboxDescription{};
    device->mailbox->coe = true;
    device->mailbox->pdoAssign = true;
    device->mailbox->pdoConfig = true;
    wire::PdoDescription rx;
    rx.index = 0x1600;
    rx.name = "Outputs";
    rx.syncManager = 2;
    rx.entries = {{0x6040, 0, 16, "Controlword", "UINT"},
                  {0x6060, 0, 8, "Mode", "SINT"},
                  {0x607A, 0, 32, "Target position", "DINT"}};
    wire::PdoDescription tx;
    tx.index = 0x1A00;
    tx.name = "Inputs";
    tx.syncManager = 3;
    tx.entries = {{0x603F, 0, 16, "Error code", "UINT"},
                  {0x6041, 0, 16, "Statusword", "UINT"},
                  {0x6061, 0, 8, "Mode display", "SINT"},
                  {0x6064, 0, 32, "Position", "DINT"},
                  {0x60F4, 0, 32, "Following error", "DINT"}};
    device->rxPdos = {rx};
    device->txPdos = {tx};
    wire::DcMode dc;
    dc.name = "DC";
    dc.assignActivate = 0x0300;
    device->dcModes = {dc};
    addObjects(*device, type);
    return device;
}

TwinParams lineOf(std::size_t count, const std::string& profile) {
    const double ppm[] = {50.0, -50.0, 31.0, -17.0, 44.0, -45.0};
    TwinParams params;
    params.seed = 4711;
    for (std::size_t i = 0; i < count; ++i) {
        TwinDeviceParams device;
        device.slave = "D" + std::to_string(i);
        device.profile = profile;
        device.clockPpm = ppm[i % 6];
        device.clockStart = core::Duration{static_cast<std::int64_t>(1'234'567'891 * (i + 1))};
        device.cableDelay = core::Duration{static_cast<std::int64_t>(40 + 35 * i)};
        params.devices.push_back(device);
    }
    return params;
}

std::vector<std::shared_ptr<const wire::DeviceDescription>> descriptionsFor(
    const TwinParams& params) {
    std::vector<std::shared_ptr<const wire::DeviceDescription>> result;
    for (const TwinDeviceParams& device : params.devices) {
        result.push_back(servoDescription(device.profile));
    }
    return result;
}

}  // namespace takt::twin::test
