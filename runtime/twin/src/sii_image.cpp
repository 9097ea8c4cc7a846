#include "sii_image.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace takt::twin {

namespace {

enum class Category : std::uint16_t {
    Strings = 10,
    General = 30,
    Fmmu = 40,
    SyncManager = 41,
    TxPdo = 50,
    RxPdo = 51,
    Dc = 60,
    End = 0xFFFF,
};

constexpr std::size_t CategoriesAt = 128;  // byte address of word 64
constexpr std::size_t MaxStringLength = 255;
constexpr std::size_t SmallestChip = 2048;  // bytes, 16 Kbit

using Bytes = std::vector<std::uint8_t>;

void put16(Bytes& bytes, std::uint32_t value) {
    bytes.push_back(static_cast<std::uint8_t>(value));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}
void put32(Bytes& bytes, std::uint32_t value) {
    put16(bytes, value & 0xFFFF);
    put16(bytes, value >> 16);
}
void set16(Bytes& bytes, std::size_t word, std::uint32_t value) {
    bytes[2 * word] = static_cast<std::uint8_t>(value);
    bytes[2 * word + 1] = static_cast<std::uint8_t>(value >> 8);
}
void set32(Bytes& bytes, std::size_t word, std::uint32_t value) {
    set16(bytes, word, value & 0xFFFF);
    set16(bytes, word + 1, value >> 16);
}

/// The string table; other categories refer to it by 1-based numbers, 0 = no string.
class StringTable {
public:
    std::uint8_t add(const std::string& text) {
        if (text.empty()) return 0;
        const auto found = std::find(strings_.begin(), strings_.end(), text);
        if (found != strings_.end()) {
            return static_cast<std::uint8_t>(found - strings_.begin() + 1);
        }
        if (strings_.size() == 0xFF) return 0;
        strings_.push_back(text.substr(0, MaxStringLength));
        return static_cast<std::uint8_t>(strings_.size());
    }
    [[nodiscard]] Bytes bytes() const {
        Bytes result{static_cast<std::uint8_t>(strings_.size())};
        for (const std::string& text : strings_) {
            result.push_back(static_cast<std::uint8_t>(text.size()));
            result.insert(result.end(), text.begin(), text.end());
        }
        return result;
    }

private:
    std::vector<std::string> strings_;
};

void appendCategory(Bytes& image, Category type, Bytes content) {
    if (content.size() % 2 != 0) content.push_back(0);
    put16(image, static_cast<std::uint16_t>(type));
    put16(image, static_cast<std::uint32_t>(content.size() / 2));
    image.insert(image.end(), content.begin(), content.end());
}

Bytes generalCategory(const wire::DeviceDescription& device, StringTable& strings) {
    Bytes bytes(32, 0);
    bytes[2] = strings.add(device.type);
    bytes[3] = strings.add(device.name);
    if (device.mailbox && device.mailbox->coe) {
        const wire::MailboxDescription& mailbox = *device.mailbox;
        bytes[5] = static_cast<std::uint8_t>(
            0x01 | (mailbox.sdoInfo ? 0x02 : 0) | (mailbox.pdoAssign ? 0x04 : 0) |
            (mailbox.pdoConfig ? 0x08 : 0) | (mailbox.completeAccess ? 0x20 : 0));
    }
    if (!device.lrwSupported) bytes[11] |= 0x02;
    std::uint32_t ports = 0;
    for (std::size_t i = 0; i < device.physics.size() && i < 4; ++i) {
        const char letter = device.physics[i];
        const std::uint32_t kind = letter == 'Y' ? 1 : letter == 'K' ? 3 : letter == 'H' ? 4 : 0;
        ports |= kind << (4 * i);
    }
    bytes[16] = static_cast<std::uint8_t>(ports);
    bytes[17] = static_cast<std::uint8_t>(ports >> 8);
    return bytes;
}

Bytes fmmuCategory(const wire::DeviceDescription& device) {
    Bytes bytes;
    for (const wire::FmmuUse use : device.fmmus) bytes.push_back(static_cast<std::uint8_t>(use));
    return bytes;
}

Bytes syncManagerCategory(const wire::DeviceDescription& device) {
    Bytes bytes;
    for (const wire::SyncManagerDescription& sm : device.syncManagers) {
        put16(bytes, sm.start);
        put16(bytes, sm.defaultSize);
        bytes.push_back(sm.control);
        bytes.push_back(0);
        bytes.push_back(sm.enabled ? 1 : 0);
        bytes.push_back(static_cast<std::uint8_t>(sm.use));
    }
    return bytes;
}

Bytes pdoCategory(const std::vector<wire::PdoDescription>& pdos, StringTable& strings) {
    Bytes bytes;
    for (const wire::PdoDescription& pdo : pdos) {
        put16(bytes, pdo.index);
        bytes.push_back(static_cast<std::uint8_t>(pdo.entries.size()));
        bytes.push_back(pdo.syncManager.value_or(0xFF));
        bytes.push_back(0);
        bytes.push_back(strings.add(pdo.name));
        put16(bytes, (pdo.mandatory ? 0x01U : 0U) | (pdo.syncManager ? 0x02U : 0U) |
                         (pdo.fixed ? 0x10U : 0U));
        for (const wire::PdoEntryDescription& entry : pdo.entries) {
            put16(bytes, entry.index);
            bytes.push_back(entry.subindex);
            bytes.push_back(strings.add(entry.name));
            bytes.push_back(coeTypeOf(entry.type));
            bytes.push_back(entry.bits);
            put16(bytes, 0);
        }
    }
    return bytes;
}

Bytes dcCategory(const wire::DeviceDescription& device, StringTable& strings) {
    Bytes bytes;
    for (const wire::DcMode& mode : device.dcModes) {
        put32(bytes, static_cast<std::uint32_t>(mode.cycleSync0.count()));
        put32(bytes, static_cast<std::uint32_t>(mode.shiftSync0.count()));
        put32(bytes, 0);
        put16(bytes, static_cast<std::uint16_t>(mode.cycleSync1Factor));
        put16(bytes, mode.assignActivate);
        put16(bytes, static_cast<std::uint16_t>(mode.cycleSync0Factor));
        bytes.push_back(strings.add(mode.name));
        bytes.push_back(0);
        put32(bytes, 0);
    }
    return bytes;
}

/// Words 0 to 63: configuration area, identity, mailbox.
Bytes fixedArea(const wire::DeviceDescription& device) {
    Bytes bytes(CategoriesAt, 0);
    bytes[0] = 0x80;                                       // PDI: on-chip
    bytes[1] = device.dcModes.empty() ? 0 : 0x04;          // DC SYNC unit on
    set16(bytes, 2, device.dcModes.empty() ? 0U : 1000U);  // SYNC pulse 10 µs
    set16(bytes, 7, siiChecksum(bytes));
    set32(bytes, 8, device.identity.vendor);
    set32(bytes, 10, device.identity.product);
    set32(bytes, 12, device.identity.revision);
    set32(bytes, 14, device.identity.serial);
    for (const wire::SyncManagerDescription& sm : device.syncManagers) {
        const bool out = sm.use == wire::SyncManagerUse::MailboxOut;
        if (!out && sm.use != wire::SyncManagerUse::MailboxIn) continue;
        set16(bytes, out ? 24 : 26, sm.start);
        set16(bytes, out ? 25 : 27, sm.defaultSize);
    }
    set16(bytes, 28, device.mailbox && device.mailbox->coe ? 0x0004U : 0U);
    set16(bytes, 63, 1);
    return bytes;
}

}  // namespace

std::uint8_t coeTypeOf(const std::string& esiType) {
    constexpr std::array<std::pair<std::string_view, std::uint8_t>, 18> types{{
        {"BOOL", 0x01},
        {"SINT", 0x02},
        {"INT", 0x03},
        {"DINT", 0x04},
        {"USINT", 0x05},
        {"UINT", 0x06},
        {"UDINT", 0x07},
        {"REAL", 0x08},
        {"LREAL", 0x11},
        {"LINT", 0x15},
        {"ULINT", 0x1B},
        {"BYTE", 0x1E},
        {"WORD", 0x1F},
        {"DWORD", 0x20},
        {"BIT", 0x30},
        {"BITARR8", 0x2D},
        {"BITARR16", 0x2E},
        {"BITARR32", 0x2F},
    }};
    for (const auto& [name, number] : types) {
        if (esiType == name) return number;
    }
    return 0;
}

std::uint8_t siiChecksum(const std::vector<std::uint8_t>& image) {
    std::uint8_t crc = 0xFF;
    for (std::size_t i = 0; i < 14; ++i) {
        crc = static_cast<std::uint8_t>(crc ^ image[i]);
        for (int bit = 0; bit < 8; ++bit) {
            const bool carry = (crc & 0x80) != 0;
            crc = static_cast<std::uint8_t>((crc << 1) ^ (carry ? 0x07 : 0));
        }
    }
    return crc;
}

std::vector<std::uint8_t> buildSiiImage(const wire::DeviceDescription& device) {
    StringTable strings;
    const Bytes general = generalCategory(device, strings);
    const Bytes txPdos = pdoCategory(device.txPdos, strings);
    const Bytes rxPdos = pdoCategory(device.rxPdos, strings);
    const Bytes dc = dcCategory(device, strings);

    Bytes image = fixedArea(device);
    appendCategory(image, Category::Strings, strings.bytes());
    appendCategory(image, Category::General, general);
    if (!device.fmmus.empty()) appendCategory(image, Category::Fmmu, fmmuCategory(device));
    if (!device.syncManagers.empty()) {
        appendCategory(image, Category::SyncManager, syncManagerCategory(device));
    }
    if (!txPdos.empty()) appendCategory(image, Category::TxPdo, txPdos);
    if (!rxPdos.empty()) appendCategory(image, Category::RxPdo, rxPdos);
    if (!dc.empty()) appendCategory(image, Category::Dc, dc);
    put16(image, static_cast<std::uint16_t>(Category::End));

    std::size_t chip = SmallestChip;
    while (chip < image.size()) chip *= 2;
    image.resize(chip, 0xFF);  // an erased EEPROM reads all ones
    set16(image, 62, static_cast<std::uint32_t>(chip * 8 / 1024 - 1));
    return image;
}

}  // namespace takt::twin
