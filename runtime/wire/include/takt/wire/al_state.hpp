#pragma once

#include <cstdint>

/// The EtherCAT application-layer state machine (ETG.1000.6 clause 6).
namespace takt::wire {

enum class AlState : std::uint8_t { None = 0, Init = 1, PreOp = 2, Boot = 3, SafeOp = 4, Op = 8 };

inline constexpr std::uint16_t AlErrorBit =
    0x0010;  ///< acknowledge in AL control, indication in AL status
inline constexpr std::uint16_t AlStateMask = 0x000F;

/// "INIT", "PREOP", …
[[nodiscard]] const char* name(AlState state) noexcept;

/// AL status codes (0x0134) used by name; any other number is still explained by `explainAlStatus`.
namespace alcode {
inline constexpr std::uint16_t NoError = 0x0000;
inline constexpr std::uint16_t InvalidStateChange = 0x0011;
inline constexpr std::uint16_t UnknownState = 0x0012;
inline constexpr std::uint16_t BootNotSupported = 0x0013;
inline constexpr std::uint16_t InvalidMailboxPreOp = 0x0016;
inline constexpr std::uint16_t InvalidSyncManager = 0x0017;
inline constexpr std::uint16_t NoValidOutputs = 0x0019;
inline constexpr std::uint16_t SynchronizationError = 0x001A;
inline constexpr std::uint16_t SyncManagerWatchdog = 0x001B;
inline constexpr std::uint16_t InvalidOutputConfiguration = 0x001D;
inline constexpr std::uint16_t InvalidInputConfiguration = 0x001E;
inline constexpr std::uint16_t InvalidWatchdog = 0x001F;
inline constexpr std::uint16_t InvalidInputMapping = 0x0024;
inline constexpr std::uint16_t InvalidOutputMapping = 0x0025;
inline constexpr std::uint16_t FatalSyncError = 0x002C;
inline constexpr std::uint16_t NoSyncError = 0x002D;
inline constexpr std::uint16_t InvalidDcSync = 0x0030;
inline constexpr std::uint16_t PllError = 0x0032;
inline constexpr std::uint16_t InvalidSync0Cycle = 0x0036;
}  // namespace alcode

/// What an AL status code means and what to look at, in one sentence.
[[nodiscard]] const char* explainAlStatus(std::uint16_t code) noexcept;

/// What an SDO abort code (CiA 301) means, in a few words.
[[nodiscard]] const char* explainAbort(std::uint32_t code) noexcept;

}  // namespace takt::wire
