#pragma once

#include <cstddef>
#include <cstdint>

/// Field positions and numbers of the mailbox and of CoE (ETG.1000.6 clauses 5.6 and 7).
namespace takt::wire::mbx {

inline constexpr std::size_t HeaderSize =
    6;  ///< length 2, address 2, channel/priority 1, type/counter 1
inline constexpr std::size_t CoeHeaderSize = 2;  ///< number 9 bits, service in bits 12 to 15
inline constexpr std::size_t SdoHeaderSize = 4;  ///< command, index, sub-index
inline constexpr std::size_t MinSdoSize = 8;

enum class Type : std::uint8_t { Error = 0, AoE = 1, EoE = 2, CoE = 3, FoE = 4, SoE = 5, VoE = 15 };

enum class CoeService : std::uint8_t {
    Emergency = 1,
    SdoRequest = 2,
    SdoResponse = 3,
    SdoInformation = 8,
};

// SDO command bytes, without size and toggle bits.
inline constexpr std::uint8_t DownloadRequest = 0x20;
inline constexpr std::uint8_t DownloadResponse = 0x60;
inline constexpr std::uint8_t UploadRequest = 0x40;
inline constexpr std::uint8_t UploadResponse = 0x40;
inline constexpr std::uint8_t DownloadSegmentRequest = 0x00;
inline constexpr std::uint8_t DownloadSegmentResponse = 0x20;
inline constexpr std::uint8_t UploadSegmentRequest = 0x60;
inline constexpr std::uint8_t UploadSegmentResponse = 0x00;
inline constexpr std::uint8_t ToggleBit = 0x10;    ///< of segments
inline constexpr std::uint8_t LastSegment = 0x01;  ///< no more segments follow
inline constexpr std::uint8_t Abort = 0x80;
inline constexpr std::uint8_t CommandMask = 0xE0;
inline constexpr std::uint8_t SizeIndicated = 0x01;
inline constexpr std::uint8_t Expedited = 0x02;
inline constexpr std::uint8_t CompleteAccess = 0x10;

// Mailbox error reply (type 0), second word.
inline constexpr std::uint16_t ErrorSyntax = 0x0001;
inline constexpr std::uint16_t ErrorUnsupportedProtocol = 0x0002;
inline constexpr std::uint16_t ErrorInvalidHeader = 0x0005;
inline constexpr std::uint16_t ErrorTooShort = 0x0006;
inline constexpr std::uint16_t ErrorInvalidSize = 0x0008;

}  // namespace takt::wire::mbx

/// SDO abort codes (CiA 301) used by name.
namespace takt::wire::abortcode {
inline constexpr std::uint32_t Timeout = 0x05040000;
inline constexpr std::uint32_t UnknownCommand = 0x05040001;
inline constexpr std::uint32_t UnsupportedAccess = 0x06010000;
inline constexpr std::uint32_t WriteOnly = 0x06010001;
inline constexpr std::uint32_t ReadOnly = 0x06010002;
inline constexpr std::uint32_t SubindexLocked = 0x06010003;
inline constexpr std::uint32_t NoCompleteAccess = 0x06010004;
inline constexpr std::uint32_t TooLongForMailbox = 0x06010005;
inline constexpr std::uint32_t NoObject = 0x06020000;
inline constexpr std::uint32_t NotMappable = 0x06040041;
inline constexpr std::uint32_t PdoTooLong = 0x06040042;
inline constexpr std::uint32_t LengthMismatch = 0x06070010;
inline constexpr std::uint32_t LengthTooHigh = 0x06070012;
inline constexpr std::uint32_t LengthTooLow = 0x06070013;
inline constexpr std::uint32_t NoSubindex = 0x06090011;
inline constexpr std::uint32_t OutOfRange = 0x06090030;
inline constexpr std::uint32_t ValueTooHigh = 0x06090031;
inline constexpr std::uint32_t ValueTooLow = 0x06090032;
inline constexpr std::uint32_t General = 0x08000000;
inline constexpr std::uint32_t WrongDeviceState = 0x08000022;
}  // namespace takt::wire::abortcode
