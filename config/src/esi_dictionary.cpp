#include "esi_dictionary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "esi_types.hpp"

namespace takt::config {

namespace {

using wire::DataType;
using wire::ObjectDescription;
using wire::ObjectEntryDescription;

bool isSigned(DataType type) noexcept {
    return type == DataType::Integer8 || type == DataType::Integer16 ||
           type == DataType::Integer32 || type == DataType::Integer64;
}

bool isText(DataType type) noexcept {
    return type == DataType::VisibleString || type == DataType::OctetString;
}

std::size_t bytesOf(std::uint16_t bits) noexcept {
    return (bits + 7U) / 8U;
}

std::vector<std::uint8_t> littleEndian(std::int64_t value, std::size_t size) {
    std::vector<std::uint8_t> bytes(size, value < 0 ? std::uint8_t{0xFF} : std::uint8_t{0});
    for (std::size_t i = 0; i < size && i < 8; ++i) {
        bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8U * i));
    }
    return bytes;
}

std::int64_t fromLittleEndian(const std::vector<std::uint8_t>& bytes, bool isNegativePossible) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size() && i < 8; ++i) {
        value |= static_cast<std::uint64_t>(bytes[i]) << (8U * i);
    }
    const bool negative =
        isNegativePossible && !bytes.empty() && bytes.size() < 8 && (bytes.back() & 0x80U) != 0;
    if (negative) value |= ~std::uint64_t{0} << (8U * bytes.size());
    return static_cast<std::int64_t>(value);
}

/// A limit or default written as a number. Some files write a negative number of n bits as
/// hexadecimal.
std::optional<std::int64_t> plainNumber(XmlElement element, const ObjectEntryDescription& entry,
                                        const EsiValues& values) {
    constexpr auto Least = std::numeric_limits<std::int64_t>::min();
    constexpr auto Most = std::numeric_limits<std::int64_t>::max();
    auto value = values.number(element.text(), element.line(), fmt::format("<{}>", element.name()),
                               Least, Most);
    if (!value || !isSigned(entry.type) || entry.bits >= 64 || entry.bits == 0) return value;
    const std::int64_t sign = std::int64_t{1} << (entry.bits - 1U);
    if (*value >= sign && *value < 2 * sign) *value -= 2 * sign;
    return value;
}

std::optional<std::int64_t> readLimit(XmlElement info, std::string_view word,
                                      const ObjectEntryDescription& entry,
                                      const EsiValues& values) {
    if (isText(entry.type)) return std::nullopt;
    if (const XmlElement value = info.child(fmt::format("{}Value", word)); value.present()) {
        return plainNumber(value, entry, values);
    }
    const XmlElement data = info.child(fmt::format("{}Data", word));
    if (!data.present()) return std::nullopt;
    const auto bytes = hexBytes(data.text());
    if (!bytes) {
        values.error(data.line(), fmt::format("<{}>: this is not hexadecimal data", data.name()),
                     "pairs of hexadecimal digits");
        return std::nullopt;
    }
    return fromLittleEndian(*bytes, isSigned(entry.type));
}

void readDefault(XmlElement info, ObjectEntryDescription& entry, const EsiValues& values) {
    const std::size_t size = bytesOf(entry.bits);
    if (const XmlElement data = info.child("DefaultData"); data.present()) {
        auto bytes = hexBytes(data.text());
        if (!bytes) {
            values.error(data.line(), "<DefaultData>: this is not hexadecimal data",
                         "pairs of hexadecimal digits");
            return;
        }
        bytes->resize(size);
        entry.defaultValue = std::move(*bytes);
    } else if (const XmlElement text = info.child("DefaultString"); text.present()) {
        const std::string characters = text.text();
        entry.defaultValue.assign(characters.begin(), characters.end());
        entry.defaultValue.resize(size);
    } else if (const XmlElement value = info.child("DefaultValue"); value.present()) {
        if (const auto number = plainNumber(value, entry, values)) {
            entry.defaultValue = littleEndian(*number, size);
        }
    }
}

void readInfo(XmlElement info, ObjectEntryDescription& entry, const EsiValues& values) {
    if (!info.present()) return;
    readDefault(info, entry, values);
    entry.minimum = readLimit(info, "Min", entry, values);
    entry.maximum = readLimit(info, "Max", entry, values);
}

ObjectEntryDescription makeEntry(const TypeMember& member, const EntryFlags& objectFlags) {
    ObjectEntryDescription entry;
    entry.subindex = member.subindex;
    entry.name = member.name;
    entry.type = member.type.type;
    entry.bits = member.type.bits;
    // Flags of the member win over those of the object; without any an object can be read only.
    const EntryFlags& access = member.flags.access.empty() ? objectFlags : member.flags;
    entry.readable = access.access != "wo";
    entry.writable = access.access == "rw" || access.access == "wo";
    entry.writableOnlyInPreOp = access.onlyInPreOp;
    const auto& mappable = member.flags.mappable ? member.flags.mappable : objectFlags.mappable;
    entry.mappable = mappable.value_or(wire::PdoMappable::No);
    return entry;
}

/// <Info><SubItem> elements belong to the members by name or, failing that, by order.
void readMemberInfos(XmlElement info, ObjectDescription& object, const EsiValues& values) {
    const std::vector<XmlElement> items = info.children("SubItem");
    constexpr std::size_t MostItems = 256;  // there are no more sub-indices
    for (std::size_t i = 0; i < std::min(items.size(), MostItems); ++i) {
        const std::string name = englishName(items[i]);
        const auto named =
            std::find_if(object.entries.begin(), object.entries.end(),
                         [&](const ObjectEntryDescription& e) { return e.name == name; });
        const std::size_t at = named != object.entries.end()
                                   ? static_cast<std::size_t>(named - object.entries.begin())
                                   : i;
        if (at >= object.entries.size()) continue;
        readInfo(items[i].child("Info"), object.entries[at], values);
    }
}

ObjectDescription readObject(XmlElement element, const TypeTable& types, const EsiValues& values) {
    ObjectDescription object;
    object.index = static_cast<std::uint16_t>(values.child(element, "Index", 0, 0xFFFF, 0));
    object.name = englishName(element);
    const std::string type = element.child("Type").text();
    const EntryFlags flags = readFlags(element);
    const XmlElement info = element.child("Info");
    const std::vector<TypeMember> members = types.membersOf(type);
    if (members.empty()) {
        const auto bits = static_cast<std::uint16_t>(values.child(element, "BitSize", 0, 65535, 0));
        object.entries.push_back(
            makeEntry({0, object.name, types.simpleTypeOf(type, bits), {}}, flags));
        readInfo(info, object.entries.front(), values);
        return object;
    }
    for (const TypeMember& member : members) object.entries.push_back(makeEntry(member, flags));
    readMemberInfos(info, object, values);
    // Sub-index 0 of a record is the number of its entries, whether the file says so or not.
    ObjectEntryDescription& count = object.entries.front();
    if (count.subindex == 0 && count.defaultValue.empty() && !isText(count.type)) {
        count.defaultValue = littleEndian(object.entries.back().subindex, bytesOf(count.bits));
    }
    return object;
}

}  // namespace

std::vector<ObjectDescription> readDictionary(XmlElement device, const EsiValues& values) {
    constexpr std::size_t MostEntries = 100'000;
    std::size_t entries = 0;
    std::vector<ObjectDescription> objects;
    for (const XmlElement profile : device.children("Profile")) {
        if (const XmlElement file = profile.child("DictionaryFile"); file.present()) {
            values.note(file.line(),
                        "the object dictionary is in a file of its own, which is not read");
        }
        const XmlElement dictionary = profile.child("Dictionary");
        const TypeTable types{dictionary, values};
        for (const XmlElement element : dictionary.child("Objects").children("Object")) {
            objects.push_back(readObject(element, types, values));
            entries += objects.back().entries.size();
            if (entries <= MostEntries) continue;
            values.error(element.line(), "the object dictionary is too large",
                         "at most 100000 entries");
            return {};
        }
    }
    std::stable_sort(objects.begin(), objects.end(),
                     [](const auto& a, const auto& b) { return a.index < b.index; });
    const auto doubled = [](const auto& a, const auto& b) { return a.index == b.index; };
    objects.erase(std::unique(objects.begin(), objects.end(), doubled), objects.end());
    return objects;
}

}  // namespace takt::config
