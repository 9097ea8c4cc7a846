#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <takt/core/time.hpp>
#include <vector>

/// What an ESI file (or an ENI, or a scan's SII) says about one device. The master configures from
/// it and the twin is built from it. Plain data; filled outside the cycle and never changed
/// afterwards.
namespace takt::wire {

struct Identity {
    std::uint32_t vendor{0};
    std::uint32_t product{0};
    std::uint32_t revision{0};
    std::uint32_t serial{0};
};

enum class SyncManagerUse : std::uint8_t {
    Unused = 0,
    MailboxOut = 1,
    MailboxIn = 2,
    Outputs = 3,
    Inputs = 4
};

struct SyncManagerDescription {
    SyncManagerUse use{SyncManagerUse::Unused};
    std::uint16_t start{0};
    std::uint16_t defaultSize{0};
    std::uint16_t minSize{0};
    std::uint16_t maxSize{0};  ///< 0 = not told
    std::uint8_t control{0};
    bool enabled{true};
};

enum class FmmuUse : std::uint8_t { Unused = 0, Outputs = 1, Inputs = 2, MailboxState = 3 };

struct PdoEntryDescription {
    std::uint16_t index{0};  ///< 0 = a gap
    std::uint8_t subindex{0};
    std::uint8_t bits{0};
    std::string name;
    std::string type;
};

struct PdoDescription {
    std::uint16_t index{0};
    std::string name;
    std::optional<std::uint8_t> syncManager;  ///< empty: not assigned by default
    bool fixed{false};
    bool mandatory{false};
    std::vector<PdoEntryDescription> entries;
};

/// CoE data type numbers (ETG.1000.6 table 64) of the simple types.
enum class DataType : std::uint16_t {
    Boolean = 0x01,
    Integer8 = 0x02,
    Integer16 = 0x03,
    Integer32 = 0x04,
    Unsigned8 = 0x05,
    Unsigned16 = 0x06,
    Unsigned32 = 0x07,
    Real32 = 0x08,
    VisibleString = 0x09,
    OctetString = 0x0A,
    Real64 = 0x11,
    Integer64 = 0x15,
    Unsigned64 = 0x1B,
};

enum class PdoMappable : std::uint8_t { No = 0, Receive = 1, Transmit = 2, Both = 3 };

struct ObjectEntryDescription {
    std::uint8_t subindex{0};
    std::string name;
    DataType type{DataType::Unsigned32};
    std::uint16_t bits{0};
    bool readable{true};
    bool writable{false};
    bool writableOnlyInPreOp{false};
    PdoMappable mappable{PdoMappable::No};
    std::vector<std::uint8_t> defaultValue;  ///< little-endian, bits/8 rounded up; empty = zeros
    std::optional<std::int64_t> minimum;
    std::optional<std::int64_t> maximum;
};

struct ObjectDescription {
    std::uint16_t index{0};
    std::string name;
    std::vector<ObjectEntryDescription> entries;  ///< ascending sub-indices
};

/// One DC operation mode of the ESI (ETG.2000 Dc/OpMode).
struct DcMode {
    std::string name;
    std::uint16_t assignActivate{0};  ///< low byte to 0x0980, high byte to 0x0981
    core::Duration cycleSync0{0};     ///< 0: by factor
    std::int32_t cycleSync0Factor{1};
    core::Duration shiftSync0{0};
    core::Duration cycleSync1{0};
    std::int32_t cycleSync1Factor{0};
};

struct MailboxDescription {
    bool coe{false};
    bool sdoInfo{false};
    bool pdoAssign{false};  ///< 1C12h/1C13h may be written
    bool pdoConfig{false};  ///< 16xxh/1Axxh may be written
    bool completeAccess{false};
    core::Duration requestTimeout{std::chrono::milliseconds{100}};
    core::Duration responseTimeout{std::chrono::milliseconds{2000}};
};

struct StateTimeouts {
    core::Duration preOp{std::chrono::milliseconds{3000}};
    core::Duration safeOpOp{std::chrono::milliseconds{10000}};
    core::Duration backToInit{std::chrono::milliseconds{5000}};
    core::Duration backToSafeOp{std::chrono::milliseconds{200}};
};

struct DeviceDescription {
    std::string source;  ///< file the description came from
    std::string type;    ///< ESI Type text, e.g. "CD300E"
    std::string name;    ///< readable name
    std::string vendorName;
    Identity identity;
    std::string physics;  ///< one letter per port, e.g. "YY"
    std::uint8_t fmmuCount{3};
    std::uint8_t syncManagerCount{4};
    std::uint16_t ramKib{8};
    bool lrwSupported{true};
    std::vector<FmmuUse> fmmus;
    std::vector<SyncManagerDescription> syncManagers;
    std::optional<MailboxDescription> mailbox;
    std::vector<PdoDescription> rxPdos;  ///< master to device
    std::vector<PdoDescription> txPdos;  ///< device to master
    std::vector<DcMode> dcModes;
    StateTimeouts timeouts;
    std::vector<ObjectDescription> objects;  ///< ascending indices

    [[nodiscard]] const ObjectDescription* findObject(std::uint16_t index) const noexcept;
    [[nodiscard]] const PdoDescription* findPdo(std::uint16_t index) const noexcept;
};

}  // namespace takt::wire
