#pragma once

#include <cstdint>

/// Names of the CiA 402 (IEC 61800-7-201) drive profile that master side and simulated drive share.
namespace takt::core::cia402 {

// Objects. The index is the value; the sub-index is 0 unless said.
inline constexpr std::uint16_t ErrorCode = 0x603F;
inline constexpr std::uint16_t ControlWord = 0x6040;
inline constexpr std::uint16_t StatusWord = 0x6041;
inline constexpr std::uint16_t QuickStopOption = 0x605A;
inline constexpr std::uint16_t ModesOfOperation = 0x6060;
inline constexpr std::uint16_t ModesOfOperationDisplay = 0x6061;
inline constexpr std::uint16_t PositionActual = 0x6064;
inline constexpr std::uint16_t FollowingErrorWindow = 0x6065;
inline constexpr std::uint16_t FollowingErrorTimeout = 0x6066;
inline constexpr std::uint16_t VelocityActual = 0x606C;
inline constexpr std::uint16_t TargetTorque = 0x6071;
inline constexpr std::uint16_t TorqueActual = 0x6077;
inline constexpr std::uint16_t TargetPosition = 0x607A;
inline constexpr std::uint16_t HomeOffset = 0x607C;
inline constexpr std::uint16_t SoftwarePositionLimit = 0x607D;
inline constexpr std::uint16_t ProfileDeceleration = 0x6084;
inline constexpr std::uint16_t QuickStopDeceleration = 0x6085;
inline constexpr std::uint16_t HomingMethod = 0x6098;
inline constexpr std::uint16_t HomingSpeeds =
    0x6099;  ///< :01 search for switch, :02 search for zero
inline constexpr std::uint16_t HomingAcceleration = 0x609A;
inline constexpr std::uint16_t TouchProbeFunction = 0x60B8;
inline constexpr std::uint16_t FollowingErrorActual = 0x60F4;
inline constexpr std::uint16_t DigitalInputs = 0x60FD;
inline constexpr std::uint16_t DigitalOutputs = 0x60FE;
inline constexpr std::uint16_t TargetVelocity = 0x60FF;
inline constexpr std::uint16_t SupportedDriveModes = 0x6502;

enum class DriveState : std::uint8_t {
    NotReadyToSwitchOn,
    SwitchOnDisabled,
    ReadyToSwitchOn,
    SwitchedOn,
    OperationEnabled,
    QuickStopActive,
    FaultReactionActive,
    Fault,
};

[[nodiscard]] const char* name(DriveState state) noexcept;

/// rt. The state a statusword shows (bits 0 to 3, 5 and 6).
[[nodiscard]] constexpr DriveState stateOf(std::uint16_t statusword) noexcept {
    switch (statusword & 0x004FU) {
        case 0x0000:
            return DriveState::NotReadyToSwitchOn;
        case 0x0040:
            return DriveState::SwitchOnDisabled;
        case 0x000F:
            return DriveState::FaultReactionActive;
        case 0x0008:
            return DriveState::Fault;
        default:
            break;
    }
    switch (statusword & 0x006FU) {
        case 0x0021:
            return DriveState::ReadyToSwitchOn;
        case 0x0023:
            return DriveState::SwitchedOn;
        case 0x0027:
            return DriveState::OperationEnabled;
        case 0x0007:
            return DriveState::QuickStopActive;
        default:
            return DriveState::NotReadyToSwitchOn;
    }
}

/// Modes of operation (6060h, 6061h).
enum class Mode : std::int8_t {
    None = 0,
    ProfilePosition = 1,
    ProfileVelocity = 3,
    ProfileTorque = 4,
    Homing = 6,
    CyclicSynchronousPosition = 8,
    CyclicSynchronousVelocity = 9,
    CyclicSynchronousTorque = 10,
};

// Controlword values and bits.
inline constexpr std::uint16_t DisableVoltage = 0x0000;
inline constexpr std::uint16_t QuickStop = 0x0002;
inline constexpr std::uint16_t Shutdown = 0x0006;
inline constexpr std::uint16_t SwitchOn = 0x0007;
inline constexpr std::uint16_t EnableOperation = 0x000F;
inline constexpr std::uint16_t FaultReset = 0x0080;
inline constexpr std::uint16_t HomingStart = 0x0010;  ///< bit 4 in homing mode
inline constexpr std::uint16_t Halt = 0x0100;

// Statusword bits beyond the state.
inline constexpr std::uint16_t VoltageEnabled = 0x0010;
inline constexpr std::uint16_t Warning = 0x0080;
inline constexpr std::uint16_t Remote = 0x0200;
inline constexpr std::uint16_t TargetReached = 0x0400;
inline constexpr std::uint16_t InternalLimit = 0x0800;
inline constexpr std::uint16_t HomingAttained = 0x1000;       ///< in homing mode
inline constexpr std::uint16_t DriveFollowsCommand = 0x1000;  ///< in the cyclic synchronous modes
inline constexpr std::uint16_t HomingError = 0x2000;          ///< in homing mode
inline constexpr std::uint16_t FollowingErrorBit = 0x2000;    ///< in position modes

}  // namespace takt::core::cia402
