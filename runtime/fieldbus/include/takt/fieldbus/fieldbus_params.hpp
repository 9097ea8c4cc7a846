#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <takt/core/time.hpp>
#include <takt/fieldbus/listed_params.hpp>
#include <vector>

namespace takt::wire {
struct DeviceDescription;
}

namespace takt::fieldbus {

/// One mapped object in a PDO. Index 0 is a gap of `bits`.
struct PdoEntryParams {
    std::uint16_t index{0};
    std::uint8_t subindex{0};
    std::uint8_t bits{0};
};

/// One PDO as it shall be used, entries in order.
struct PdoParams {
    std::uint16_t index{0};
    std::vector<PdoEntryParams> entries;
    bool writeMapping{
        false};  ///< entries differ from the device's default: write 16xxh/1Axxh in PREOP
};

/// An object written in PREOP at every start.
struct StartupObject {
    std::uint16_t index{0};
    std::uint8_t subindex{0};
    std::vector<std::uint8_t> data;  ///< little-endian, 1 to 8 bytes
    bool required{true};             ///< an abort keeps the device in PREOP
    std::string origin;              ///< "machine.xml:31" or what asked for it; for messages
};

enum class RevisionRule : std::uint8_t { Equal, EqualOrGreater, Ignore };

/// Distributed-clock settings of one device.
struct DcParams {
    bool enabled{false};
    std::uint16_t assignActivate{0x0300};
    core::Duration sync0Cycle{0};
    core::Duration sync0Shift{0};  ///< added to the common shift of the network
};

struct SlaveParams {
    std::string name;
    std::uint16_t position{0};  ///< 0-based, in frame order
    std::shared_ptr<const wire::DeviceDescription> device;
    RevisionRule revisionRule{RevisionRule::Equal};
    std::vector<PdoParams> outputs;  ///< RxPDOs in assignment order
    std::vector<PdoParams> inputs;   ///< TxPDOs in assignment order
    bool writeAssignment{false};     ///< differs from the default: write 1C12h/1C13h in PREOP
    std::vector<StartupObject> startup;
    DcParams dc;
    core::Duration watchdog{std::chrono::milliseconds{100}};  ///< process-data watchdog
    std::string origin;                                       ///< "machine.xml:12", for messages
    /// Bits before the process data in the first byte of the device's image; 0 to 7.
    std::uint8_t outputShift{0};
    std::uint8_t inputShift{0};
    /// Present on a listed network: registers are written as listed, not as worked out from the
    /// device. Start-up objects are written in PREOP behind the listed ones.
    std::optional<ListedSlave> listed;
};

/// One EtherCAT segment and its cycle.
struct NetworkParams {
    core::Duration cycle{std::chrono::milliseconds{1}};
    std::vector<SlaveParams> slaves;  ///< in frame order
    std::uint32_t lostLimit{3};       ///< n_lost: consecutive bad cycles tolerated
    core::Duration sendJitter{std::chrono::microseconds{50}};
    std::uint32_t dcDriftFrames{10000};  ///< most static drift frames before SAFEOP
    core::Duration dcLimit{std::chrono::microseconds{1}};  ///< 0x092C of every device before OP
    std::string interface;                ///< of the real network, empty = not told
    std::optional<ListedNetwork> listed;  ///< then every slave is listed too
};

}  // namespace takt::fieldbus
