#include "object_dictionary.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace takt::twin {

namespace {

bool precedes(const DictionaryEntry& entry, std::uint16_t index, std::uint8_t subindex) noexcept {
    return std::tie(entry.index, entry.subindex) < std::tie(index, subindex);
}

}  // namespace

std::uint8_t sizeOf(wire::DataType type) noexcept {
    using wire::DataType;
    switch (type) {
        case DataType::Boolean:
        case DataType::Integer8:
        case DataType::Unsigned8:
            return 1;
        case DataType::Integer16:
        case DataType::Unsigned16:
            return 2;
        case DataType::Integer32:
        case DataType::Unsigned32:
        case DataType::Real32:
            return 4;
        case DataType::Real64:
        case DataType::Integer64:
        case DataType::Unsigned64:
            return 8;
        case DataType::VisibleString:
        case DataType::OctetString:
            return 0;
    }
    return 0;
}

bool DictionaryEntry::isSigned() const noexcept {
    using wire::DataType;
    return type == DataType::Integer8 || type == DataType::Integer16 ||
           type == DataType::Integer32 || type == DataType::Integer64;
}

bool DictionaryEntry::isNumber() const noexcept {
    return sizeOf(type) != 0;
}

ObjectDictionary::ObjectDictionary(const wire::DeviceDescription& device) {
    for (const wire::ObjectDescription& object : device.objects) {
        for (const wire::ObjectEntryDescription& described : object.entries) {
            DictionaryEntry entry;
            entry.index = object.index;
            entry.subindex = described.subindex;
            entry.type = described.type;
            entry.bits = described.bits;
            entry.readable = described.readable;
            entry.writable = described.writable;
            entry.onlyInPreOp = described.writableOnlyInPreOp;
            const auto mappable = static_cast<unsigned>(described.mappable);
            entry.toDevice = (mappable & static_cast<unsigned>(wire::PdoMappable::Receive)) != 0;
            entry.fromDevice = (mappable & static_cast<unsigned>(wire::PdoMappable::Transmit)) != 0;
            entry.minimum = described.minimum;
            entry.maximum = described.maximum;
            const std::size_t size =
                std::max<std::size_t>({(described.bits + std::size_t{7}) / 8,
                                       described.defaultValue.size(), sizeOf(described.type)});
            const DictionaryEntry& added = add(entry, size);
            std::copy(described.defaultValue.begin(), described.defaultValue.end(),
                      bytes(added).begin());
        }
    }
}

DictionaryEntry& ObjectDictionary::add(DictionaryEntry entry, std::size_t size) {
    entry.offset = static_cast<std::uint32_t>(used_);
    entry.size = static_cast<std::uint32_t>(size);
    // A number is always loaded and stored as eight bytes, so eight more lie behind the last value.
    used_ += size;
    values_.resize(used_ + sizeof(std::uint64_t), 0);
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), entry,
                                     [](const DictionaryEntry& a, const DictionaryEntry& b) {
                                         return precedes(a, b.index, b.subindex);
                                     });
    return *entries_.insert(at, entry);
}

ObjectRef ObjectDictionary::ensure(const DictionaryEntry& wanted, std::int64_t value) {
    const DictionaryEntry* found = locate(wanted.index, wanted.subindex);
    if (found == nullptr) {
        DictionaryEntry entry = wanted;
        entry.bits = static_cast<std::uint16_t>(8 * sizeOf(wanted.type));
        const ObjectRef ref = refOf(add(entry, sizeOf(wanted.type)));
        set(ref, value);
        return ref;
    }
    return refOf(*found);
}

ObjectRef ObjectDictionary::internal(std::uint16_t index, std::uint8_t subindex,
                                     wire::DataType type, std::int64_t value) {
    DictionaryEntry entry;
    entry.index = index;
    entry.subindex = subindex;
    entry.type = type;
    entry.hidden = true;
    return ensure(entry, value);
}

const DictionaryEntry* ObjectDictionary::locate(std::uint16_t index,
                                                std::uint8_t subindex) const noexcept {
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), std::pair{index, subindex},
                                     [](const DictionaryEntry& entry, const auto& key) {
                                         return precedes(entry, key.first, key.second);
                                     });
    if (at == entries_.end() || at->index != index || at->subindex != subindex) return nullptr;
    return &*at;
}

DictionaryEntry* ObjectDictionary::locate(std::uint16_t index, std::uint8_t subindex) noexcept {
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), std::pair{index, subindex},
                                     [](const DictionaryEntry& entry, const auto& key) {
                                         return precedes(entry, key.first, key.second);
                                     });
    if (at == entries_.end() || at->index != index || at->subindex != subindex) return nullptr;
    return &*at;
}

const DictionaryEntry* ObjectDictionary::find(std::uint16_t index,
                                              std::uint8_t subindex) const noexcept {
    const DictionaryEntry* found = locate(index, subindex);
    return found != nullptr && !found->hidden ? found : nullptr;
}

bool ObjectDictionary::contains(std::uint16_t index) const noexcept {
    return std::any_of(entries_.begin(), entries_.end(), [index](const DictionaryEntry& entry) {
        return entry.index == index && !entry.hidden;
    });
}

void ObjectDictionary::allowMapping(std::uint16_t index, std::uint8_t subindex, bool toDevice) {
    DictionaryEntry* entry = locate(index, subindex);
    if (entry == nullptr) return;
    (toDevice ? entry->toDevice : entry->fromDevice) = true;
}

}  // namespace takt::twin
