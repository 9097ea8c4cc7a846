#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "conversation.hpp"

namespace takt::fieldbus::ethercat {

/// The texts by which a device names itself in its EEPROM.
struct SiiNames {
    std::string order;
    std::string name;
};

/// Reads the slave information interface (ETG.1000.6 clause 5.4) of one device, outside the cycle.
/// The EEPROM must belong to the master.
class SiiReader {
public:
    SiiReader(Conversation& talk, std::uint16_t station) : talk_{talk}, station_{station} {}

    /// Two words. \return empty: the device does not answer or its EEPROM cannot be read
    [[nodiscard]] std::optional<std::uint32_t> words(std::uint32_t address);
    /// Walks over the categories (ETG.2010); texts that are not there stay empty.
    [[nodiscard]] SiiNames names();

private:
    [[nodiscard]] std::string strings(std::uint32_t address, std::uint32_t words);
    [[nodiscard]] std::optional<std::uint16_t> settled();

    Conversation& talk_;
    std::uint16_t station_;
    std::uint32_t data_{0};
};

}  // namespace takt::fieldbus::ethercat
