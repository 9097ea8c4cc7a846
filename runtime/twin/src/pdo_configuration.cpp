#include "pdo_configuration.hpp"

#include <algorithm>
#include <takt/wire/mailbox.hpp>

namespace takt::twin {

namespace abortcode = wire::abortcode;
using wire::DataType;

namespace {

constexpr std::uint16_t OutputAssignment = 0x1C12;
constexpr std::uint16_t InputAssignment = 0x1C13;
constexpr std::size_t LargestProcessData = 1486;  // bytes that one datagram can carry

constexpr bool isReceiveMapping(std::uint16_t index) {
    return index >= 0x1600 && index <= 0x17FF;
}
constexpr bool isTransmitMapping(std::uint16_t index) {
    return index >= 0x1A00 && index <= 0x1BFF;
}
constexpr bool isAssignment(std::uint16_t index) {
    return index == OutputAssignment || index == InputAssignment;
}

constexpr std::uint16_t mappedIndex(std::uint32_t mapping) {
    return static_cast<std::uint16_t>(mapping >> 16);
}
constexpr std::uint8_t mappedSubindex(std::uint32_t mapping) {
    return static_cast<std::uint8_t>(mapping >> 8);
}
constexpr std::uint8_t mappedBits(std::uint32_t mapping) {
    return static_cast<std::uint8_t>(mapping);
}

DictionaryEntry configurationEntry(std::uint16_t index, std::size_t subindex, DataType type) {
    DictionaryEntry entry;
    entry.index = index;
    entry.subindex = static_cast<std::uint8_t>(subindex);
    entry.type = type;
    entry.writable = true;
    entry.onlyInPreOp = true;
    return entry;
}

}  // namespace

PdoConfiguration::PdoConfiguration(const wire::DeviceDescription& device, const DriveTraits& traits,
                                   ObjectDictionary& dictionary)
    : traits_{traits}, dictionary_{dictionary} {
    const bool mappingWritable = device.mailbox && device.mailbox->pdoConfig;
    for (const auto* pdos : {&device.rxPdos, &device.txPdos}) {
        for (const wire::PdoDescription& pdo : *pdos) {
            addPdo(pdo, pdos == &device.rxPdos);
            if (pdo.fixed || !mappingWritable) fixed_.push_back(pdo.index);
        }
    }
    addAssignment(OutputAssignment, device.rxPdos);
    addAssignment(InputAssignment, device.txPdos);
    if (!device.mailbox || !device.mailbox->pdoAssign) {
        fixed_.push_back(OutputAssignment);
        fixed_.push_back(InputAssignment);
    }
    for (Direction& list : lists_) list.entries.reserve(LargestProcessData);
}

void PdoConfiguration::addPdo(const wire::PdoDescription& pdo, bool toDevice) {
    const std::size_t slots = std::max<std::size_t>(traits_.maxPdoEntries, pdo.entries.size());
    dictionary_.ensure(configurationEntry(pdo.index, 0, DataType::Unsigned8), 0);
    store(pdo.index, 0, static_cast<std::uint32_t>(pdo.entries.size()));
    for (std::size_t i = 1; i <= slots && i <= 0xFE; ++i) {
        dictionary_.ensure(configurationEntry(pdo.index, i, DataType::Unsigned32), 0);
        std::uint32_t mapping = 0;
        if (i <= pdo.entries.size()) {
            const wire::PdoEntryDescription& entry = pdo.entries[i - 1];
            mapping = (std::uint32_t{entry.index} << 16) | (std::uint32_t{entry.subindex} << 8) |
                      entry.bits;
            dictionary_.allowMapping(entry.index, entry.subindex, toDevice);
        }
        store(pdo.index, static_cast<std::uint8_t>(i), mapping);
    }
}

void PdoConfiguration::addAssignment(std::uint16_t index,
                                     const std::vector<wire::PdoDescription>& pdos) {
    std::vector<std::uint16_t> assigned;
    for (const wire::PdoDescription& pdo : pdos) {
        if (pdo.syncManager) assigned.push_back(pdo.index);
    }
    const std::size_t slots = std::max<std::size_t>(traits_.maxAssignedPdos, assigned.size());
    dictionary_.ensure(configurationEntry(index, 0, DataType::Unsigned8), 0);
    store(index, 0, static_cast<std::uint32_t>(assigned.size()));
    for (std::size_t i = 1; i <= slots; ++i) {
        dictionary_.ensure(configurationEntry(index, i, DataType::Unsigned16), 0);
        store(index, static_cast<std::uint8_t>(i), i <= assigned.size() ? assigned[i - 1] : 0U);
    }
}

bool PdoConfiguration::governs(std::uint16_t index) noexcept {
    return isAssignment(index) || isReceiveMapping(index) || isTransmitMapping(index);
}

std::uint32_t PdoConfiguration::number(std::uint16_t index, std::uint8_t subindex) const noexcept {
    const DictionaryEntry* entry = dictionary_.find(index, subindex);
    if (entry == nullptr) return 0;
    return static_cast<std::uint32_t>(dictionary_.getUnsigned(ObjectDictionary::refOf(*entry)));
}

void PdoConfiguration::store(std::uint16_t index, std::uint8_t subindex,
                             std::uint32_t value) noexcept {
    const DictionaryEntry* entry = dictionary_.find(index, subindex);
    if (entry == nullptr) return;
    dictionary_.set(ObjectDictionary::refOf(*entry), value);
}

std::uint32_t PdoConfiguration::write(std::uint16_t index, std::uint8_t subindex,
                                      std::uint32_t value, bool inPreOp) noexcept {
    if (std::find(fixed_.begin(), fixed_.end(), index) != fixed_.end()) return abortcode::ReadOnly;
    if (!inPreOp) return abortcode::WrongDeviceState;
    // Entries may change only while the object is switched off by sub-index 0 = 0.
    if (subindex != 0 && number(index, 0) != 0) return abortcode::SubindexLocked;
    const std::uint32_t refusal = isAssignment(index) ? checkAssignment(index, subindex, value)
                                                      : checkMapping(index, subindex, value);
    if (refusal == 0) store(index, subindex, value);
    return refusal;
}

std::uint32_t PdoConfiguration::checkAssignment(std::uint16_t index, std::uint8_t subindex,
                                                std::uint32_t value) const noexcept {
    const auto known = [&](std::uint32_t pdo) {
        const auto candidate = static_cast<std::uint16_t>(pdo);
        const bool rightKind =
            index == OutputAssignment ? isReceiveMapping(candidate) : isTransmitMapping(candidate);
        return pdo <= 0xFFFF && rightKind && dictionary_.find(candidate, 0) != nullptr;
    };
    if (subindex != 0) return known(value) ? 0 : abortcode::OutOfRange;
    if (value > 0xFF ||
        (value != 0 && dictionary_.find(index, static_cast<std::uint8_t>(value)) == nullptr)) {
        return abortcode::OutOfRange;
    }
    for (std::uint32_t i = 1; i <= value; ++i) {
        if (!known(number(index, static_cast<std::uint8_t>(i)))) return abortcode::OutOfRange;
    }
    return 0;
}

std::uint32_t PdoConfiguration::checkMapping(std::uint16_t index, std::uint8_t subindex,
                                             std::uint32_t value) const noexcept {
    if (subindex != 0) {
        if (mappedIndex(value) == 0) return 0;  // a gap
        const DictionaryEntry* entry = dictionary_.find(mappedIndex(value), mappedSubindex(value));
        if (entry == nullptr) return abortcode::NoObject;
        const bool mappable = isReceiveMapping(index) ? entry->toDevice : entry->fromDevice;
        return mappable && entry->bits == mappedBits(value) ? 0 : abortcode::NotMappable;
    }
    if (value > traits_.maxPdoEntries) return abortcode::PdoTooLong;
    std::uint32_t bits = 0;
    for (std::uint32_t i = 1; i <= value; ++i) {
        bits += mappedBits(number(index, static_cast<std::uint8_t>(i)));
    }
    return bits <= traits_.maxPdoBytes * 8U ? 0 : abortcode::PdoTooLong;
}

bool PdoConfiguration::append(Direction& list, std::uint32_t mapping) noexcept {
    const std::uint8_t bits = mappedBits(mapping);
    if (mappedIndex(mapping) != 0) {
        const DictionaryEntry* entry =
            dictionary_.find(mappedIndex(mapping), mappedSubindex(mapping));
        if (entry == nullptr || bits == 0 || bits > 32) return false;
        if (list.entries.size() == list.entries.capacity()) return false;
        const ObjectRef object = ObjectDictionary::refOf(*entry);
        const bool whole = list.bits % 8 == 0 && bits == object.size * 8;
        list.entries.push_back({{static_cast<std::uint32_t>(list.bits), bits},
                                object,
                                whole ? std::uint32_t{object.size} : 0U});
    }
    list.bits += bits;
    return list.bits <= LargestProcessData * 8;
}

bool PdoConfiguration::resolve(PdoDirection direction) noexcept {
    Direction& list = of(direction);
    list.entries.clear();
    list.bits = 0;
    const std::uint16_t assignment =
        direction == PdoDirection::ToDevice ? OutputAssignment : InputAssignment;
    const std::uint32_t pdos = number(assignment, 0);
    for (std::uint32_t i = 1; i <= pdos; ++i) {
        const auto pdo =
            static_cast<std::uint16_t>(number(assignment, static_cast<std::uint8_t>(i)));
        if (dictionary_.find(pdo, 0) == nullptr) return false;
        const std::uint32_t entries = number(pdo, 0);
        for (std::uint32_t k = 1; k <= entries; ++k) {
            if (!append(list, number(pdo, static_cast<std::uint8_t>(k)))) return false;
        }
    }
    return true;
}

std::size_t PdoConfiguration::size(PdoDirection direction) const noexcept {
    return (of(direction).bits + 7) / 8;
}

void PdoConfiguration::takeOutputs(std::span<const std::uint8_t> data) noexcept {
    const auto values = dictionary_.values();
    for (const Mapped& mapped : of(PdoDirection::ToDevice).entries) {
        if (mapped.wholeBytes == 0) {
            dictionary_.set(mapped.object, core::readUnsigned(data, mapped.slot));
            continue;
        }
        const std::size_t at = mapped.slot.bitOffset / 8;
        std::copy_n(&data[at], mapped.wholeBytes, &values[mapped.object.offset]);
    }
}

void PdoConfiguration::putInputs(std::span<std::uint8_t> data) const noexcept {
    const auto values = dictionary_.values();
    for (const Mapped& mapped : of(PdoDirection::FromDevice).entries) {
        if (mapped.wholeBytes == 0) {
            core::write(data, mapped.slot,
                        static_cast<std::uint32_t>(dictionary_.getUnsigned(mapped.object)));
            continue;
        }
        const std::size_t at = mapped.slot.bitOffset / 8;
        std::copy_n(&values[mapped.object.offset], mapped.wholeBytes, &data[at]);
    }
}

}  // namespace takt::twin
