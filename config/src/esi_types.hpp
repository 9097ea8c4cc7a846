#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <takt/wire/device_description.hpp>
#include <vector>

#include "esi_values.hpp"

namespace takt::config {

/// A type as far as SDO access needs it.
struct SimpleType {
    wire::DataType type{wire::DataType::OctetString};
    std::uint16_t bits{0};
};

/// The types that need no declaration: "UDINT", "BOOL", "BIT3", "STRING(12)", "ARRAY [0..7] OF
/// BYTE".
[[nodiscard]] std::optional<SimpleType> builtInType(std::string_view name);

/// Access rights as <Flags> tells them.
struct EntryFlags {
    std::string access;  ///< lower case: "ro", "rw", "wo"
    bool onlyInPreOp{false};
    std::optional<wire::PdoMappable> mappable;
};
[[nodiscard]] EntryFlags readFlags(XmlElement element);

/// One member of a declared structure.
struct TypeMember {
    std::uint8_t subindex{0};
    std::string name;
    SimpleType type;
    EntryFlags flags;
};

/// All <DataTypes> of a dictionary, resolved.
class TypeTable {
public:
    TypeTable(XmlElement dictionary, const EsiValues& values);

    /// Members of a record or array type in order; empty for a simple or unknown type.
    [[nodiscard]] std::vector<TypeMember> membersOf(const std::string& name) const;
    /// \param bits the size told beside the type's name; used where the type itself tells none
    [[nodiscard]] SimpleType simpleTypeOf(const std::string& name, std::uint16_t bits) const;

private:
    [[nodiscard]] XmlElement find(const std::string& name) const;
    void appendArray(XmlElement type, const EntryFlags& flags,
                     std::vector<TypeMember>& members) const;

    std::map<std::string, XmlElement> declared_;
    const EsiValues& values_;
};

}  // namespace takt::config
