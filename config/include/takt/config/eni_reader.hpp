#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <takt/config/diagnostics.hpp>
#include <takt/core/time.hpp>
#include <takt/fieldbus/fieldbus_params.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

namespace takt::config {

/// A variable of the process image.
struct EniVariable {
    std::string name;
    std::string type;
    std::uint32_t bits{0};
    std::uint32_t firstBit{0};  ///< of the image
    int line{0};
};

/// One slave as the file has it.
struct EniSlave {
    std::string name;  ///< as it is written, "Drive 1 (CD300E)"
    Place place;       ///< of its identity
    /// What the file tells of the device: identity, SyncManagers, mailbox, PDOs; its dictionary
    /// holds the objects that the file names, and those that CiA 402 prescribes for a drive. The
    /// type is the text in the last brackets of the name, as configuration tools write it.
    wire::DeviceDescription device;
    std::vector<fieldbus::PdoParams> outputs;  ///< assigned ones, in order
    std::vector<fieldbus::PdoParams> inputs;
    fieldbus::DcParams dc;
    core::Duration watchdog{std::chrono::milliseconds{100}};  ///< as delivered unless it is written
    fieldbus::ListedSlave listed;
};

/// An EtherCAT network information file (ENI, ETG.2100).
struct EniNetwork {
    std::string file;
    core::Duration cycle{0};
    fieldbus::ListedNetwork listed;
    std::vector<EniSlave> slaves;  ///< in frame order
    std::vector<EniVariable> outputs;
    std::vector<EniVariable> inputs;
};

/// Reads an ENI file and checks it against itself: what the init commands write into devices must
/// be what the rest of the file says of identity, process data, working counters and clocks. What
/// would have to be done and cannot be is an error, with its line.
/// \return empty when there is at least one error
[[nodiscard]] std::optional<EniNetwork> readEni(const std::filesystem::path& file,
                                                Diagnostics& diagnostics);

}  // namespace takt::config
