#pragma once

#include <cstdint>

/// ESC registers by their names in ETG.1000.4 and the controllers' data sheets. Sizes in bytes
/// behind.
namespace takt::wire::reg {

inline constexpr std::uint16_t Type = 0x0000;                      // 1
inline constexpr std::uint16_t Revision = 0x0001;                  // 1
inline constexpr std::uint16_t Build = 0x0002;                     // 2
inline constexpr std::uint16_t FmmuCount = 0x0004;                 // 1
inline constexpr std::uint16_t SyncManagerCount = 0x0005;          // 1
inline constexpr std::uint16_t RamSize = 0x0006;                   // 1, KiB
inline constexpr std::uint16_t PortDescriptor = 0x0007;            // 1
inline constexpr std::uint16_t Features = 0x0008;                  // 2
inline constexpr std::uint16_t StationAddress = 0x0010;            // 2
inline constexpr std::uint16_t StationAlias = 0x0012;              // 2
inline constexpr std::uint16_t DlControl = 0x0100;                 // 4
inline constexpr std::uint16_t PhysicalOffset = 0x0108;            // 2
inline constexpr std::uint16_t DlStatus = 0x0110;                  // 2
inline constexpr std::uint16_t AlControl = 0x0120;                 // 2
inline constexpr std::uint16_t AlStatus = 0x0130;                  // 2
inline constexpr std::uint16_t AlStatusCode = 0x0134;              // 2
inline constexpr std::uint16_t PdiControl = 0x0140;                // 1
inline constexpr std::uint16_t EscConfiguration = 0x0141;          // 1
inline constexpr std::uint16_t EcatEventMask = 0x0200;             // 2
inline constexpr std::uint16_t AlEventMask = 0x0204;               // 4
inline constexpr std::uint16_t EcatEventRequest = 0x0210;          // 2
inline constexpr std::uint16_t AlEventRequest = 0x0220;            // 4
inline constexpr std::uint16_t RxErrorCounter = 0x0300;            // 8
inline constexpr std::uint16_t ForwardedRxError = 0x0308;          // 4
inline constexpr std::uint16_t ProcessingUnitError = 0x030C;       // 1
inline constexpr std::uint16_t LostLinkCounter = 0x0310;           // 4
inline constexpr std::uint16_t WatchdogDivider = 0x0400;           // 2
inline constexpr std::uint16_t WatchdogTimePdi = 0x0410;           // 2
inline constexpr std::uint16_t WatchdogTimeProcessData = 0x0420;   // 2
inline constexpr std::uint16_t WatchdogStatus = 0x0440;            // 2
inline constexpr std::uint16_t WatchdogCounter = 0x0442;           // 2
inline constexpr std::uint16_t EepromConfiguration = 0x0500;       // 1
inline constexpr std::uint16_t EepromPdiAccess = 0x0501;           // 1
inline constexpr std::uint16_t EepromControl = 0x0502;             // 2
inline constexpr std::uint16_t EepromAddress = 0x0504;             // 4
inline constexpr std::uint16_t EepromData = 0x0508;                // 8
inline constexpr std::uint16_t Fmmu = 0x0600;                      // 16 each
inline constexpr std::uint16_t SyncManager = 0x0800;               // 8 each
inline constexpr std::uint16_t DcReceiveTimePort0 = 0x0900;        // 4, then ports 1 to 3
inline constexpr std::uint16_t DcSystemTime = 0x0910;              // 8
inline constexpr std::uint16_t DcReceiveTimeUnit = 0x0918;         // 8
inline constexpr std::uint16_t DcSystemTimeOffset = 0x0920;        // 8
inline constexpr std::uint16_t DcSystemTimeDelay = 0x0928;         // 4
inline constexpr std::uint16_t DcSystemTimeDifference = 0x092C;    // 4
inline constexpr std::uint16_t DcSpeedCounterStart = 0x0930;       // 2
inline constexpr std::uint16_t DcSpeedCounterDifference = 0x0932;  // 2
inline constexpr std::uint16_t DcFilterDepth = 0x0934;             // 2: difference, speed counter
inline constexpr std::uint16_t DcCyclicControl = 0x0980;           // 1
inline constexpr std::uint16_t DcActivation = 0x0981;              // 1
inline constexpr std::uint16_t DcPulseLength = 0x0982;             // 2
inline constexpr std::uint16_t DcActivationStatus = 0x0984;        // 1
inline constexpr std::uint16_t DcStartTime = 0x0990;               // 8
inline constexpr std::uint16_t DcNextSync1 = 0x0998;               // 8
inline constexpr std::uint16_t DcSync0Cycle = 0x09A0;              // 4
inline constexpr std::uint16_t DcSync1Cycle = 0x09A4;              // 4
inline constexpr std::uint16_t ProcessRam = 0x1000;

inline constexpr std::uint16_t FmmuSize = 16;
inline constexpr std::uint16_t SyncManagerSize = 8;

// Bits of Features.
inline constexpr std::uint16_t FeatureDc = 0x0004;
inline constexpr std::uint16_t FeatureDc64 = 0x0008;
inline constexpr std::uint16_t FeatureNoLrw = 0x0200;

}  // namespace takt::wire::reg
