#pragma once

#include <array>
#include <cstdint>

namespace takt::fieldbus::ethercat {

/// A CoE emergency message (ETG.1000.6 5.6.4).
struct EmergencyRecord {
    std::uint16_t errorCode{0};  ///< as 603Fh; 0 = error reset
    std::uint8_t errorRegister{0};
    std::array<std::uint8_t, 5> deviceData{};
};

}  // namespace takt::fieldbus::ethercat
