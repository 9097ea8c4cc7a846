#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <takt/core/cia402.hpp>

#include "machine_parts.hpp"

namespace takt::config {

namespace {

using fieldbus::PdoEntryParams;
using fieldbus::PdoParams;

/// One direction of process data: what the device offers and what is to be used.
struct Side {
    const char* word;  ///< "outputs" or "inputs"
    const std::vector<wire::PdoDescription>& offered;
    std::vector<PdoParams>& used;
    std::uint16_t assignment;  ///< 1C12h or 1C13h
    wire::PdoMappable direction;
    wire::SyncManagerUse syncManager;
};

std::array<Side, 2> sidesOf(SlavePart& slave) {
    const wire::DeviceDescription& device = *slave.params.device;
    return {Side{"outputs", device.rxPdos, slave.params.outputs, 0x1C12, wire::PdoMappable::Receive,
                 wire::SyncManagerUse::Outputs},
            Side{"inputs", device.txPdos, slave.params.inputs, 0x1C13, wire::PdoMappable::Transmit,
                 wire::SyncManagerUse::Inputs}};
}

std::vector<PdoEntryParams> defaultEntries(const wire::PdoDescription& pdo) {
    std::vector<PdoEntryParams> entries;
    for (const wire::PdoEntryDescription& entry : pdo.entries) {
        entries.push_back({entry.index, entry.subindex, entry.bits});
    }
    return entries;
}

bool same(const PdoEntryParams& a, const PdoEntryParams& b) noexcept {
    return a.index == b.index && a.subindex == b.subindex && a.bits == b.bits;
}

const wire::PdoDescription* findPdo(const Side& side, std::int64_t index) noexcept {
    for (const wire::PdoDescription& pdo : side.offered) {
        if (pdo.index == index) return &pdo;
    }
    return nullptr;
}

std::string show(const PdoEntryParams& entry) {
    return fmt::format("0x{:04X}:{:02X}", entry.index, entry.subindex);
}

std::string listOf(const std::vector<wire::PdoDescription>& pdos) {
    std::string text;
    for (const wire::PdoDescription& pdo : pdos) {
        text += fmt::format("{}0x{:04X}", text.empty() ? "" : ", ", pdo.index);
    }
    return text;
}

const wire::ObjectEntryDescription* findEntry(const wire::DeviceDescription& device,
                                              const PdoEntryParams& wanted) noexcept {
    const wire::ObjectDescription* const object = device.findObject(wanted.index);
    if (object == nullptr) return nullptr;
    for (const wire::ObjectEntryDescription& entry : object->entries) {
        if (entry.subindex == wanted.subindex) return &entry;
    }
    return nullptr;
}

/// The bits of an object that a default PDO of the device maps; 0 = none does.
std::uint8_t bitsInDefaults(const Side& side, const PdoEntryParams& wanted) noexcept {
    for (const wire::PdoDescription& pdo : side.offered) {
        for (const wire::PdoEntryDescription& entry : pdo.entries) {
            if (entry.index == wanted.index && entry.subindex == wanted.subindex) return entry.bits;
        }
    }
    return 0;
}

/// Checks a mapped object against the dictionary and fills in its size. A device that maps an
/// object by default proves that it can, whatever its dictionary says.
void checkEntry(PdoEntryParams& entry, const Side& side, const wire::DeviceDescription& device,
                const ElementReader& reader) {
    const std::uint8_t byDefault = bitsInDefaults(side, entry);
    const wire::ObjectEntryDescription* const object = findEntry(device, entry);
    if (byDefault == 0 && object == nullptr && !device.objects.empty()) {
        reader.error("index", fmt::format("the device has no object {}", show(entry)),
                     "objects of its dictionary", "look it up in " + device.source);
        return;
    }
    const auto direction = static_cast<unsigned>(side.direction);
    if (byDefault == 0 && object != nullptr &&
        (static_cast<unsigned>(object->mappable) & direction) == 0) {
        reader.error(
            "index",
            fmt::format("the object {} cannot be mapped to the {}", show(entry), side.word),
            fmt::format("objects that the dictionary marks as mappable to {}",
                        side.direction == wire::PdoMappable::Receive ? "RxPDOs" : "TxPDOs"));
        return;
    }
    const auto size = byDefault != 0 ? byDefault
                      : object != nullptr && object->bits <= 0xFF
                          ? static_cast<std::uint8_t>(object->bits)
                          : std::uint8_t{0};
    if (entry.bits == 0) entry.bits = size;
    if (entry.bits == 0) {
        reader.error("bits", fmt::format("the size of {} is not known", show(entry)),
                     "1 to 255 bits");
    } else if (size != 0 && entry.bits != size) {
        reader.error(
            "bits", fmt::format("the object {} has {} bits, not {}", show(entry), size, entry.bits),
            fmt::format("{}", size));
    }
}

PdoEntryParams readEntry(XmlElement element, const SlavePart& slave, const Side& side) {
    ElementReader reader{element, slave.reader.label() + ", <Entry>", slave.reader.place().file,
                         slave.reader.diagnostics()};
    PdoEntryParams entry;
    const auto index = reader.integer("index", {0, 0xFFFF}, Presence::Required);
    entry.index = static_cast<std::uint16_t>(index.value_or(0));
    entry.subindex = static_cast<std::uint8_t>(reader.integer("sub", {0, 255}).value_or(0));
    entry.bits = static_cast<std::uint8_t>(reader.integer("bits", {1, 255}).value_or(0));
    reader.finish();
    if (!index) return entry;
    if (entry.index != 0) {
        checkEntry(entry, side, *slave.params.device, reader);
    } else if (entry.bits == 0) {
        reader.error("index", "a gap needs its size", "bits=\"1\" to bits=\"255\"");
    }
    return entry;
}

void readPdo(XmlElement element, SlavePart& slave, const std::array<Side, 2>& sides) {
    const wire::DeviceDescription& device = *slave.params.device;
    ElementReader reader{element, slave.reader.label() + ", <Pdo>", slave.reader.place().file,
                         slave.reader.diagnostics()};
    const auto index = reader.integer("index", {0, 0xFFFF}, Presence::Required);
    const std::vector<XmlElement> entries = reader.children("Entry");
    reader.finish();
    if (!index) return;
    const Side& side = findPdo(sides[0], *index) != nullptr ? sides[0] : sides[1];
    const wire::PdoDescription* const offered = findPdo(side, *index);
    if (offered == nullptr) {
        reader.error(
            "index", fmt::format("the device has no PDO 0x{:04X}", *index),
            fmt::format("outputs {}; inputs {}", listOf(device.rxPdos), listOf(device.txPdos)));
        return;
    }
    const bool doubled = std::any_of(side.used.begin(), side.used.end(),
                                     [&](const PdoParams& pdo) { return pdo.index == *index; });
    if (doubled)
        reader.error("index", fmt::format("the PDO 0x{:04X} is there twice", *index), "once");
    PdoParams pdo{offered->index, defaultEntries(*offered), false};
    if (!entries.empty()) {
        std::vector<PdoEntryParams> wanted;
        wanted.reserve(entries.size());
        for (const XmlElement entry : entries) wanted.push_back(readEntry(entry, slave, side));
        pdo.writeMapping =
            !std::equal(wanted.begin(), wanted.end(), pdo.entries.begin(), pdo.entries.end(), same);
        pdo.entries = std::move(wanted);
    }
    const bool configurable = device.mailbox && device.mailbox->pdoConfig && !offered->fixed;
    if (pdo.writeMapping && !configurable) {
        reader.error("index", fmt::format("the contents of the PDO 0x{:04X} are fixed", *index),
                     "the PDO without <Entry>, as the device has it");
    }
    side.used.push_back(std::move(pdo));
}

std::size_t bitsOf(const PdoParams& pdo) noexcept {
    std::size_t bits = 0;
    for (const PdoEntryParams& entry : pdo.entries) bits += entry.bits;
    return bits;
}

/// How many entries the array behind an object has; 0 = not told.
std::size_t capacityOf(const wire::DeviceDescription& device, std::uint16_t index) noexcept {
    const wire::ObjectDescription* const object = device.findObject(index);
    return object != nullptr && !object->entries.empty() ? object->entries.back().subindex : 0;
}

void checkSizes(const SlavePart& slave, const Side& side) {
    const ElementReader& reader = slave.reader;
    const wire::DeviceDescription& device = *slave.params.device;
    std::size_t total = 0;
    for (const PdoParams& pdo : side.used) {
        const std::size_t bytes = (bitsOf(pdo) + 7) / 8;
        const std::size_t capacity = capacityOf(device, pdo.index);
        total += bitsOf(pdo);
        if (capacity != 0 && pdo.entries.size() > capacity) {
            reader.error(
                {}, fmt::format("the PDO 0x{:04X} has {} entries", pdo.index, pdo.entries.size()),
                fmt::format("at most {}", capacity), "use a second PDO, or leave entries out");
        }
        if (slave.profile->maxPdoBytes != 0 && bytes > slave.profile->maxPdoBytes) {
            reader.error({}, fmt::format("the PDO 0x{:04X} has {} bytes", pdo.index, bytes),
                         fmt::format("at most {}", slave.profile->maxPdoBytes),
                         "leave entries out");
        }
    }
    for (const wire::SyncManagerDescription& manager : device.syncManagers) {
        if (manager.use != side.syncManager || manager.maxSize == 0) continue;
        if ((total + 7) / 8 <= manager.maxSize) continue;
        reader.error({}, fmt::format("the {} have {} bytes", side.word, (total + 7) / 8),
                     fmt::format("at most {}", manager.maxSize), "leave entries out");
    }
    const std::size_t places = capacityOf(device, side.assignment);
    if (places != 0 && side.used.size() > places) {
        reader.error({}, fmt::format("there are {} PDOs for the {}", side.used.size(), side.word),
                     fmt::format("at most {}", places));
    }
}

void checkDoubledEntries(const SlavePart& slave, const Side& side) {
    std::set<std::pair<std::uint16_t, std::uint8_t>> seen;
    for (const PdoParams& pdo : side.used) {
        for (const PdoEntryParams& entry : pdo.entries) {
            if (entry.index == 0 || seen.emplace(entry.index, entry.subindex).second) continue;
            slave.reader.error(
                {}, fmt::format("the object {} is mapped twice to the {}", show(entry), side.word),
                "once");
        }
    }
}

void completeSide(SlavePart& slave, Side& side) {
    std::vector<PdoParams> assigned;
    for (const wire::PdoDescription& pdo : side.offered) {
        if (pdo.syncManager) assigned.push_back({pdo.index, defaultEntries(pdo), false});
    }
    if (side.used.empty()) side.used = assigned;
    const bool asDelivered =
        std::equal(side.used.begin(), side.used.end(), assigned.begin(), assigned.end(),
                   [](const PdoParams& a, const PdoParams& b) { return a.index == b.index; });
    if (asDelivered) return;
    slave.params.writeAssignment = true;
    const auto& mailbox = slave.params.device->mailbox;
    if (!mailbox || !mailbox->pdoAssign) {
        slave.reader.error(
            {}, fmt::format("the device does not let its {} be assigned otherwise", side.word),
            listOf(side.offered));
    }
}

}  // namespace

void readPdos(SlavePart& slave) {
    std::array<Side, 2> sides = sidesOf(slave);
    for (const XmlElement element : slave.reader.children("Pdo")) readPdo(element, slave, sides);
    for (Side& side : sides) {
        completeSide(slave, side);
        checkSizes(slave, side);
        checkDoubledEntries(slave, side);
    }
}

void checkCyclicPositionEntries(const SlavePart& slave, const axis::DriveBindings& bound) {
    namespace cia402 = core::cia402;
    const auto require = [&slave](const std::vector<PdoParams>& pdos, core::PdoSlot variable,
                                  std::uint16_t index, std::uint8_t bits, const char* what) {
        if (variable.present()) return;
        for (const PdoParams& pdo : pdos) {
            for (const PdoEntryParams& entry : pdo.entries) {
                if (entry.index == index && entry.subindex == 0 && entry.bits == bits) return;
            }
        }
        slave.reader.error(
            {}, fmt::format("an axis needs {}", what),
            "the defaults of the drive, or <Pdo> with 0x6040, 0x6060 and 0x607A in the outputs "
            "and 0x6041, 0x6061 and 0x6064 in the inputs");
    };
    const auto& params = slave.params;
    require(params.outputs, bound.controlword, cia402::ControlWord, 16,
            "the controlword 0x6040 (16 bits) in the outputs");
    require(params.outputs, bound.modeOfOperation, cia402::ModesOfOperation, 8,
            "the mode of operation 0x6060 (8 bits) in the outputs");
    require(params.outputs, bound.targetPosition, cia402::TargetPosition, 32,
            "the target position 0x607A (32 bits) in the outputs");
    require(params.inputs, bound.statusword, cia402::StatusWord, 16,
            "the statusword 0x6041 (16 bits) in the inputs");
    require(params.inputs, bound.modeDisplay, cia402::ModesOfOperationDisplay, 8,
            "the mode display 0x6061 (8 bits) in the inputs");
    require(params.inputs, bound.actualPosition, cia402::PositionActual, 32,
            "the actual position 0x6064 (32 bits) in the inputs");
}

}  // namespace takt::config
