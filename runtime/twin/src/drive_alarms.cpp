// The alarms and warnings of each drive, as its manual lists them.

#include "drive_alarms.hpp"

#include <array>

namespace takt::twin {

namespace {

constexpr std::uint16_t VendorError = 0xFF00;  // 603Fh of an alarm to which no manual gives a code

constexpr std::array Cd300eAlarms{
    DriveAlarm{0x0001, 0, AlarmKind::Warning, true},       // Battery warning
    DriveAlarm{0x0002, 0, AlarmKind::Warning, true},       // Drive overload warning
    DriveAlarm{0x0003, 0, AlarmKind::Warning, true},       // Motor overload warning
    DriveAlarm{0x2250, 0x2250, AlarmKind::Motion, true},   // DC-bus overcurrent
    DriveAlarm{0x2320, 0x2320, AlarmKind::Motion, true},   // Motor phase overcurrent
    DriveAlarm{0x2350, 0x2350, AlarmKind::Motion, true},   // Drive overload
    DriveAlarm{0x3130, 0x3130, AlarmKind::Motion, true},   // Input phase loss
    DriveAlarm{0x3210, 0x3210, AlarmKind::Motion, true},   // Main circuit overvoltage
    DriveAlarm{0x3220, 0x3220, AlarmKind::Motion, true},   // Main circuit undervoltage
    DriveAlarm{0x4310, 0x4310, AlarmKind::Motion, true},   // Drive overtemperature
    DriveAlarm{0x4320, 0x4320, AlarmKind::Motion, true},   // Drive undertemperature
    DriveAlarm{0x5210, 0x5210, AlarmKind::Motion, true},   // Current sensing circuit fault
    DriveAlarm{0x6301, 0x6301, AlarmKind::Motion, true},   // Storage module fault
    DriveAlarm{0x7110, 0x7110, AlarmKind::Motion, true},   // Brake resistor protection
    DriveAlarm{0x7121, 0x7121, AlarmKind::Motion, true},   // Motor stalled
    DriveAlarm{0x7122, 0x7122, AlarmKind::Motion, true},   // Motor excitation error
    DriveAlarm{0x7305, 0x7305, AlarmKind::Motion, true},   // Pulse encoder abnormal
    DriveAlarm{0x7306, 0x7306, AlarmKind::Motion, true},   // Input pulse frequency abnormal
    DriveAlarm{0x7307, 0x7307, AlarmKind::Motion, true},   // Full-closed-loop Z signal abnormal
    DriveAlarm{0x7510, 0x7510, AlarmKind::Motion, true},   // Encoder communication lost
    DriveAlarm{0x7511, 0x7511, AlarmKind::Motion, true},   // Encoder communication interference
    DriveAlarm{0x8611, 0x8611, AlarmKind::Motion, true},   // Position following error
    DriveAlarm{0x8700, 0x8700, AlarmKind::Bus, true},      // Bus communication fault
    DriveAlarm{0xFF00, 0xFF00, AlarmKind::Motion, false},  // Drive configuration error
    DriveAlarm{0xFF01, 0xFF01, AlarmKind::Motion, true},   // Motor overload
    DriveAlarm{0xFF02, 0xFF02, AlarmKind::Motion, true},   // Encoder internal fault
    DriveAlarm{0xFF03, 0xFF03, AlarmKind::Motion, false},  // Encoder model recognition fault
    DriveAlarm{0xFF04, 0xFF04, AlarmKind::Motion, false},  // Encoder data read error
    DriveAlarm{0xFF05, 0xFF05, AlarmKind::Motion, false},  // Encoder data checksum error
    DriveAlarm{0xFF06, 0xFF06, AlarmKind::Motion, false},  // Encoder data version error
    DriveAlarm{0xFF08, 0xFF08, AlarmKind::Motion, false},  // Data import protection
    DriveAlarm{0xFF09, 0xFF09, AlarmKind::Motion, true},   // Configuration parameter error
    DriveAlarm{0xFF0A, 0xFF0A, AlarmKind::Motion, true},   // Output phase loss
    DriveAlarm{0xFF0B, 0xFF0B, AlarmKind::Motion, false},  // Motor setting error
    DriveAlarm{0xFF0C, 0xFF0C, AlarmKind::Motion, false},  // Full-closed-loop setting error
    DriveAlarm{0xFF0D, 0xFF0D, AlarmKind::Motion, true},   // Hybrid control deviation too large
    DriveAlarm{0xFF0E, 0xFF0E, AlarmKind::Motion, true},   // Full-closed-loop quadrature input lost
};

constexpr std::array RaAlarms{
    DriveAlarm{0x0020, VendorError, AlarmKind::Motion, false},  // Parameter checksum error
    DriveAlarm{0x0021, VendorError, AlarmKind::Motion, false},  // System parameter checksum error
    DriveAlarm{0x0024, VendorError, AlarmKind::Motion, false},  // Parameter value abnormal
    DriveAlarm{0x002A, VendorError, AlarmKind::Motion, false},  // System alarm (I2C)
    DriveAlarm{0x002B, VendorError, AlarmKind::Motion, false},  // System alarm
    DriveAlarm{0x002C, VendorError, AlarmKind::Motion, false},  // XML read error
    DriveAlarm{0x002D, VendorError, AlarmKind::Motion, false},  // System alarm
    DriveAlarm{0x0030, VendorError, AlarmKind::Motion, true},   // Combination error
    DriveAlarm{0x0032, VendorError, AlarmKind::Motion, true},   // Motor/drive mismatch
    DriveAlarm{0x003F, VendorError, AlarmKind::Motion, false},  // Product not supported
    DriveAlarm{0x0040, VendorError, AlarmKind::Motion, false},  // Parameter setting fault
    DriveAlarm{0x0042, VendorError, AlarmKind::Motion, false},  // Parameter combination fault
    DriveAlarm{0x0060, VendorError, AlarmKind::Motion, false},  // Main-circuit detection fault
    DriveAlarm{0x0070, VendorError, AlarmKind::Motion, false},  // Current detection fault 1
    DriveAlarm{0x0072, VendorError, AlarmKind::Motion, false},  // Current detection fault 2
    DriveAlarm{0x0100, VendorError, AlarmKind::Motion, false},  // Overcurrent
    DriveAlarm{0x0101, VendorError, AlarmKind::Motion, false},  // Motor overcurrent
    DriveAlarm{0x0120, VendorError, AlarmKind::Motion, true},   // Motor overload (instantaneous)
    DriveAlarm{0x0121, VendorError, AlarmKind::Motion, true},   // Drive overload (instantaneous)
    DriveAlarm{0x0130, VendorError, AlarmKind::Motion, true},   // Motor overload (continuous)
    DriveAlarm{0x0131, VendorError, AlarmKind::Motion, true},   // Drive overload (continuous)
    DriveAlarm{0x0136, VendorError, AlarmKind::Motion, true},   // Collision alarm
    DriveAlarm{0x0150, VendorError, AlarmKind::Motion, true},   // DB overload
    DriveAlarm{0x0160, VendorError, AlarmKind::Motion, false},  // Inrush resistor overload
    DriveAlarm{0x0170, VendorError, AlarmKind::Motion, true},   // Main power alarm
    DriveAlarm{0x0176, VendorError, AlarmKind::Motion, true},   // Heat sink overheating
    DriveAlarm{0x0190, VendorError, AlarmKind::Motion, true},   // Servo-ON command invalid
    DriveAlarm{0x0300, VendorError, AlarmKind::Motion, false},  // Regeneration abnormal
    DriveAlarm{0x0320, VendorError, AlarmKind::Motion, true},   // Regeneration overload
    DriveAlarm{0x0360, VendorError, AlarmKind::Motion, true},   // Overtravel alarm
    DriveAlarm{0x0400, VendorError, AlarmKind::Motion, true},   // Overvoltage
    DriveAlarm{0x0410, VendorError, AlarmKind::Motion, true},   // Undervoltage
    DriveAlarm{0x0500, VendorError, AlarmKind::Motion, false},  // Encoder communication fault
    DriveAlarm{0x0502, VendorError, AlarmKind::Motion,
               false},  // Encoder communication repeated errors
    DriveAlarm{0x0504, VendorError, AlarmKind::Motion,
               true},  // Encoder communication checksum error
    DriveAlarm{0x0505, VendorError, AlarmKind::Motion, true},  // Encoder frame error 1
    DriveAlarm{0x0506, VendorError, AlarmKind::Motion, true},  // Encoder frame error 2
    DriveAlarm{0x0507, VendorError, AlarmKind::Motion, true},  // Encoder frame error 3
    DriveAlarm{0x0530, VendorError, AlarmKind::Motion, true},  // Encoder memory checksum alarm
    DriveAlarm{0x0532, VendorError, AlarmKind::Motion, true},  // Encoder parameter abnormal
    DriveAlarm{0x0550, VendorError, AlarmKind::Motion, true},  // Encoder count error 1
    DriveAlarm{0x0552, VendorError, AlarmKind::Motion, true},  // Multi-turn encoder error
    DriveAlarm{0x0554, VendorError, AlarmKind::Motion, true},  // Encoder overspeed
    DriveAlarm{0x0555, VendorError, AlarmKind::Motion, true},  // Encoder count error 2
    DriveAlarm{0x0556, VendorError, AlarmKind::Motion, true},  // Encoder count overflow
    DriveAlarm{0x0558, VendorError, AlarmKind::Motion, true},  // Encoder multi-turn data error
    DriveAlarm{0x055A, VendorError, AlarmKind::Motion, true},  // Encoder battery alarm
    DriveAlarm{0x0600, 0x8611, AlarmKind::Motion, true},       // Position deviation too large
    DriveAlarm{0x0601, VendorError, AlarmKind::Motion,
               true},  // Position deviation too large at servo ON
    DriveAlarm{0x0602, VendorError, AlarmKind::Motion,
               true},  // Position deviation too large due to speed limit
    DriveAlarm{0x060A, VendorError, AlarmKind::Motion, true},  // Stall alarm
    DriveAlarm{0x0620, VendorError, AlarmKind::Motion, true},  // Runaway
    DriveAlarm{0x0632, VendorError, AlarmKind::Motion, true},  // Overspeed
    DriveAlarm{0x0636, VendorError, AlarmKind::Motion, true},  // Vibration alarm
    DriveAlarm{0x0638, VendorError, AlarmKind::Motion, true},  // Auto-tuning alarm
    DriveAlarm{0x0710, VendorError, AlarmKind::Motion, true},  // CAN bus-off
    DriveAlarm{0x0711, VendorError, AlarmKind::Motion, true},  // CAN too many errors
    DriveAlarm{0x0715, VendorError, AlarmKind::Motion, true},  // CAN synchronisation error
    DriveAlarm{0x0810, VendorError, AlarmKind::Bus, true},     // EtherCAT communication interrupted
    DriveAlarm{0x0813, VendorError, AlarmKind::Bus, true},     // EtherCAT synchronisation failed
    DriveAlarm{0x0814, VendorError, AlarmKind::Bus, true},     // EtherCAT RxPDO timeout
    DriveAlarm{0x0815, 0x8700, AlarmKind::Bus, true},          // EtherCAT sync command timeout
    DriveAlarm{0x0816, VendorError, AlarmKind::Bus, true},     // EtherCAT cycle setting error
    DriveAlarm{0x0820, VendorError, AlarmKind::Bus, true},     // EtherCAT synchronisation error 1
    DriveAlarm{0x0821, VendorError, AlarmKind::Bus, true},     // EtherCAT synchronisation error 2
    DriveAlarm{0x0822, VendorError, AlarmKind::Bus, true},     // EtherCAT synchronisation error 3
    DriveAlarm{0x0F01, VendorError, AlarmKind::Motion, false},  // System alarm 1
    DriveAlarm{0x0F02, VendorError, AlarmKind::Motion, false},  // System alarm 2
    DriveAlarm{0x0F03, VendorError, AlarmKind::Motion, false},  // System alarm 3
    DriveAlarm{0x0F04, VendorError, AlarmKind::Motion, false},  // System alarm 4
    DriveAlarm{0x0F10, VendorError, AlarmKind::Motion, false},  // Wrong firmware
    DriveAlarm{0x0900, VendorError, AlarmKind::Warning, true},  // Position deviation too large
    DriveAlarm{0x0901, VendorError, AlarmKind::Warning,
               true},  // Position deviation too large at servo ON
    DriveAlarm{0x0910, VendorError, AlarmKind::Warning, true},  // Motor overload
    DriveAlarm{0x0911, VendorError, AlarmKind::Warning, true},  // Drive overload
    DriveAlarm{0x091A, VendorError, AlarmKind::Warning, true},  // Vibration
    DriveAlarm{0x0920, VendorError, AlarmKind::Warning, true},  // Regeneration overload
    DriveAlarm{0x0921, VendorError, AlarmKind::Warning, true},  // DB overload
    DriveAlarm{0x0930, VendorError, AlarmKind::Warning, true},  // Absolute encoder battery
    DriveAlarm{0x0941, VendorError, AlarmKind::Warning, true},  // Power-cycle parameter changed
    DriveAlarm{0x0970, VendorError, AlarmKind::Warning, true},  // Undervoltage
    DriveAlarm{0x09A0, VendorError, AlarmKind::Warning, true},  // Overtravel
    DriveAlarm{0x09FF, VendorError, AlarmKind::Warning, true},  // Reset warning
};

}  // namespace

std::span<const DriveAlarm> alarmsOf(std::string_view profile) noexcept {
    if (profile == "cd300e") return Cd300eAlarms;
    if (profile == "ra") return RaAlarms;
    return {};
}

const DriveAlarm* findAlarm(std::string_view profile, std::uint16_t number) noexcept {
    for (const DriveAlarm& alarm : alarmsOf(profile)) {
        if (alarm.number == number) return &alarm;
    }
    return nullptr;
}

}  // namespace takt::twin
