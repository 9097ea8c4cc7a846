#include "esi_types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "numbers.hpp"

namespace takt::config {

namespace {

using wire::DataType;

constexpr int MaxBits = 65535;

struct NamedType {
    std::string_view name;
    SimpleType type;
};

// ETG.1000.6 table 64 by the names of IEC 61131-3 that ESI files use.
constexpr std::array BuiltIn{
    NamedType{"BOOL", {DataType::Boolean, 1}},
    NamedType{"BIT", {DataType::Boolean, 1}},
    NamedType{"SINT", {DataType::Integer8, 8}},
    NamedType{"INT", {DataType::Integer16, 16}},
    NamedType{"DINT", {DataType::Integer32, 32}},
    NamedType{"LINT", {DataType::Integer64, 64}},
    NamedType{"USINT", {DataType::Unsigned8, 8}},
    NamedType{"UINT", {DataType::Unsigned16, 16}},
    NamedType{"UDINT", {DataType::Unsigned32, 32}},
    NamedType{"ULINT", {DataType::Unsigned64, 64}},
    NamedType{"BYTE", {DataType::Unsigned8, 8}},
    NamedType{"WORD", {DataType::Unsigned16, 16}},
    NamedType{"DWORD", {DataType::Unsigned32, 32}},
    NamedType{"BITARR8", {DataType::Unsigned8, 8}},
    NamedType{"BITARR16", {DataType::Unsigned16, 16}},
    NamedType{"BITARR32", {DataType::Unsigned32, 32}},
    NamedType{"REAL", {DataType::Real32, 32}},
    NamedType{"LREAL", {DataType::Real64, 64}},
};

std::string lowerCase(std::string_view text) {
    std::string lower{text};
    for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return lower;
}

std::uint16_t asBits(std::int64_t bits) noexcept {
    return static_cast<std::uint16_t>(std::clamp<std::int64_t>(bits, 0, MaxBits));
}

/// "STRING(12)" → 12
std::optional<std::int64_t> bracketed(std::string_view name, std::string_view front) noexcept {
    if (!name.starts_with(front) || !name.ends_with(")")) return std::nullopt;
    return parseInteger(name.substr(front.size(), name.size() - front.size() - 1));
}

/// "ARRAY [0..7] OF BYTE" → 8 · 8 bits
std::optional<SimpleType> byteArray(std::string_view name) noexcept {
    const std::size_t open = name.find('[');
    const std::size_t dots = name.find("..");
    const std::size_t close = name.find(']');
    if (!name.starts_with("ARRAY") || open > dots || dots > close ||
        close == std::string_view::npos) {
        return std::nullopt;
    }
    const auto first = parseInteger(trim(name.substr(open + 1, dots - open - 1)));
    const auto last = parseInteger(trim(name.substr(dots + 2, close - dots - 2)));
    const std::size_t of = name.find("OF ", close);
    if (!first || !last || *first < 0 || *last < *first || *last > MaxBits ||
        of == std::string_view::npos) {
        return std::nullopt;
    }
    const auto element = builtInType(trim(name.substr(of + 3)));
    if (!element) return std::nullopt;
    return SimpleType{DataType::OctetString, asBits((*last - *first + 1) * element->bits)};
}

}  // namespace

std::optional<SimpleType> builtInType(std::string_view name) {
    for (const NamedType& known : BuiltIn) {
        if (known.name == name) return known.type;
    }
    if (name.size() == 4 && name.starts_with("BIT") && name[3] >= '1' && name[3] <= '8') {
        const auto bits = static_cast<std::uint16_t>(name[3] - '0');
        return SimpleType{bits == 1 ? DataType::Boolean : DataType::Unsigned8, bits};
    }
    if (const auto length = bracketed(name, "STRING(")) {
        return SimpleType{DataType::VisibleString,
                          asBits(std::min<std::int64_t>(*length, MaxBits) * 8)};
    }
    if (const auto length = bracketed(name, "OCTET_STRING(")) {
        return SimpleType{DataType::OctetString,
                          asBits(std::min<std::int64_t>(*length, MaxBits) * 8)};
    }
    return byteArray(name);
}

EntryFlags readFlags(XmlElement element) {
    EntryFlags flags;
    const XmlElement source = element.child("Flags");
    const XmlElement access = source.child("Access");
    flags.access = lowerCase(access.text());
    const auto restriction = access.attribute("WriteRestrictions");
    flags.onlyInPreOp = restriction && lowerCase(restriction->value) == "preop";
    if (const XmlElement mapping = source.child("PdoMapping"); mapping.present()) {
        const std::string text = lowerCase(mapping.text());
        const bool receive = text.find('r') != std::string::npos;
        const bool transmit = text.find('t') != std::string::npos;
        flags.mappable = static_cast<wire::PdoMappable>((receive ? 1 : 0) | (transmit ? 2 : 0));
    }
    return flags;
}

TypeTable::TypeTable(XmlElement dictionary, const EsiValues& values) : values_{values} {
    for (const XmlElement type : dictionary.child("DataTypes").children("DataType")) {
        declared_.emplace(type.child("Name").text(), type);
    }
}

XmlElement TypeTable::find(const std::string& name) const {
    const auto found = declared_.find(name);
    return found != declared_.end() ? found->second : XmlElement{};
}

SimpleType TypeTable::simpleTypeOf(const std::string& name, std::uint16_t bits) const {
    constexpr int MaxDepth = 8;
    std::string current = name;
    for (int depth = 0; depth < MaxDepth; ++depth) {
        if (const auto known = builtInType(current)) return *known;
        const XmlElement declared = find(current);
        if (!declared.present()) break;
        if (bits == 0) bits = asBits(values_.child(declared, "BitSize", 0, MaxBits, 0));
        const std::string base = declared.child("BaseType").text();
        if (base.empty()) break;
        current = base;
    }
    // Rarer types (24 to 56 bits, times, GUIDs) are carried as bytes.
    return {DataType::OctetString, bits};
}

void TypeTable::appendArray(XmlElement type, const EntryFlags& flags,
                            std::vector<TypeMember>& members) const {
    constexpr std::int64_t LastSubindex = 255;
    const XmlElement info = type.child("ArrayInfo");
    const std::int64_t first = values_.child(info, "LBound", 0, LastSubindex, 1);
    const std::int64_t count = values_.child(info, "Elements", 0, LastSubindex + 1, 0);
    const std::int64_t bits = values_.child(type, "BitSize", 0, MaxBits, 0);
    const SimpleType element = simpleTypeOf(type.child("BaseType").text(),
                                            count > 0 ? asBits(bits / count) : std::uint16_t{0});
    for (std::int64_t i = 0; i < count && first + i <= LastSubindex; ++i) {
        members.push_back({static_cast<std::uint8_t>(first + i),
                           fmt::format("SubIndex {:03}", first + i), element, flags});
    }
}

std::vector<TypeMember> TypeTable::membersOf(const std::string& name) const {
    constexpr std::size_t MaxMembers = 256;
    std::vector<TypeMember> members;
    const XmlElement type = find(name);
    if (type.child("ArrayInfo").present()) {
        members.push_back({0, "SubIndex 000", {DataType::Unsigned8, 8}, {"ro", false, {}}});
        appendArray(type, readFlags(type), members);
        return members;
    }
    for (const XmlElement item : type.children("SubItem")) {
        if (members.size() >= MaxMembers) break;
        const std::string itemType = item.child("Type").text();
        const XmlElement array = find(itemType);
        if (array.child("ArrayInfo").present()) {
            appendArray(array, readFlags(item), members);
            continue;
        }
        const std::int64_t next = members.empty() ? 0 : members.back().subindex + 1;
        const std::int64_t subindex =
            values_.child(item, "SubIdx", 0, 255, std::min<std::int64_t>(next, 255));
        const auto bits = asBits(values_.child(item, "BitSize", 0, MaxBits, 0));
        members.push_back({static_cast<std::uint8_t>(subindex), englishName(item),
                           simpleTypeOf(itemType, bits), readFlags(item)});
    }
    std::stable_sort(members.begin(), members.end(), [](const TypeMember& a, const TypeMember& b) {
        return a.subindex < b.subindex;
    });
    const auto doubled = [](const TypeMember& a, const TypeMember& b) {
        return a.subindex == b.subindex;
    };
    members.erase(std::unique(members.begin(), members.end(), doubled), members.end());
    return members;
}

}  // namespace takt::config
