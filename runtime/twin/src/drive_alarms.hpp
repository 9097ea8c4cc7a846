#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace takt::twin {

enum class AlarmKind : std::uint8_t {
    Warning,  ///< statusword bit 7, the drive goes on
    Motion,   ///< a fault
    Bus,      ///< a fault of the communication
};

/// One alarm of a drive.
struct DriveAlarm {
    std::uint16_t number{0};     ///< on the drive's own display: Er.8611 → 8611h, E.600 → 600h
    std::uint16_t errorCode{0};  ///< 603Fh; 0 = not shown there
    AlarmKind kind{AlarmKind::Motion};
    bool resettable{true};  ///< by the fault reset; otherwise the drive must be restarted
};

/// rt. Every alarm of a drive, in the order of its manual; none for the generic drive.
[[nodiscard]] std::span<const DriveAlarm> alarmsOf(std::string_view profile) noexcept;
/// rt. Null when the drive has no such alarm.
[[nodiscard]] const DriveAlarm* findAlarm(std::string_view profile, std::uint16_t number) noexcept;

}  // namespace takt::twin
