#include "sii_reader.hpp"

#include <algorithm>
#include <array>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

namespace takt::fieldbus::ethercat {

namespace {

namespace reg = wire::reg;

constexpr std::uint16_t EepromBytes = 14;  ///< control, address and data registers together
constexpr std::uint16_t EepromRead = 0x0100;
constexpr std::uint16_t EepromBusy = 0x8000;
constexpr std::uint16_t EepromErrors = 0x6000;
constexpr int MostLooks = 100;
constexpr core::Duration LookGap = std::chrono::microseconds{250};

constexpr std::uint32_t FirstCategory = 0x40;
constexpr std::uint32_t MostCategories = 64;
constexpr std::uint32_t MostStringWords = 2048;
constexpr std::uint16_t CategoryStrings = 10;
constexpr std::uint16_t CategoryGeneral = 30;
constexpr std::uint16_t CategoryEnd = 0xFFFF;

/// Number 1 is the first; unprintable bytes of a foreign EEPROM do not reach a terminal.
std::string textAt(const std::string& table, std::uint8_t number) {
    std::size_t at = 1;
    for (unsigned i = 1; at < table.size(); ++i) {
        const std::size_t length = static_cast<std::uint8_t>(table[at]);
        if (i != number) {
            at += 1 + length;
            continue;
        }
        std::string text = table.substr(at + 1, length);
        std::replace_if(
            text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
        return text;
    }
    return {};
}

}  // namespace

std::optional<std::uint16_t> SiiReader::settled() {
    constexpr std::size_t dataAt = 6;
    for (int i = 0; i < MostLooks; ++i) {
        const Reply reply = talk_.ask(readRequest(station_, reg::EepromControl, EepromBytes));
        if (!reply.served()) return std::nullopt;
        const std::uint16_t status = wire::load16(reply.data, 0);
        if ((status & EepromBusy) == 0) {
            data_ = wire::load32(reply.data, dataAt);
            return status;
        }
        talk_.pause(LookGap);
    }
    return std::nullopt;
}

std::optional<std::uint32_t> SiiReader::words(std::uint32_t address) {
    std::array<std::uint8_t, 6> command{};
    const auto before = settled();
    if (!before) return std::nullopt;
    if ((*before & EepromErrors) != 0) {
        talk_.ask(writeRequest(station_, reg::EepromControl, std::span{command}.first(2)));
    }
    wire::store16(command, 0, EepromRead);
    wire::store32(command, 2, address);
    if (!talk_.ask(writeRequest(station_, reg::EepromControl, command)).served())
        return std::nullopt;
    const auto after = settled();
    if (!after || (*after & EepromErrors) != 0) return std::nullopt;
    return data_;
}

std::string SiiReader::strings(std::uint32_t address, std::uint32_t count) {
    std::string bytes;
    for (std::uint32_t at = 0; at < std::min(count, MostStringWords); at += 2) {
        const auto pair = words(address + at);
        if (!pair) break;
        for (unsigned shift = 0; shift < 32; shift += 8) {
            bytes += static_cast<char>((*pair >> shift) & 0xFFU);
        }
    }
    return bytes;
}

SiiNames SiiReader::names() {
    std::string table;
    std::uint8_t order = 0;
    std::uint8_t name = 0;
    std::uint32_t at = FirstCategory;
    for (std::uint32_t i = 0; i < MostCategories && (table.empty() || name == 0); ++i) {
        const auto head = words(at);
        if (!head) break;
        const auto type = static_cast<std::uint16_t>(*head);
        const std::uint32_t size = *head >> 16;
        if (type == CategoryEnd) break;
        if (type == CategoryStrings) table = strings(at + 2, size);
        if (type == CategoryGeneral) {
            // Bytes: group, image, order, name.
            const auto general = words(at + 2);
            order = static_cast<std::uint8_t>(general.value_or(0) >> 16);
            name = static_cast<std::uint8_t>(general.value_or(0) >> 24);
        }
        at += 2 + size;
    }
    return {textAt(table, order), textAt(table, name)};
}

}  // namespace takt::fieldbus::ethercat
