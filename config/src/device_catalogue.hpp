#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <takt/wire/device_description.hpp>
#include <vector>

#include "element_reader.hpp"
#include "esi_devices.hpp"

namespace takt::config {

struct DeviceFile {
    std::vector<EsiDevice> devices;
    std::vector<std::shared_ptr<const wire::DeviceDescription>> shared;  ///< made on first use
};

/// All devices of the ESI files that the network names.
struct Catalogue {
    std::vector<DeviceFile> files;
    bool complete{true};  ///< every file could be read
};

struct WantedIdentity {
    std::optional<std::int64_t> vendor;
    std::optional<std::int64_t> product;
    std::optional<std::int64_t> revision;

    [[nodiscard]] bool matches(const wire::Identity& identity) const noexcept {
        return (!vendor || *vendor == identity.vendor) &&
               (!product || *product == identity.product) &&
               (!revision || *revision == identity.revision);
    }
};

/// Reads the <Esi> files of <Network>.
[[nodiscard]] Catalogue readCatalogue(ElementReader& network, const std::filesystem::path& folder);

/// The device wanted; of several the one with the highest revision. \return nullptr, after a
/// message at the attribute `device` or at a number of the identity, when there is none
[[nodiscard]] std::shared_ptr<const wire::DeviceDescription> selectDevice(
    const std::string& type, const WantedIdentity& wanted, const ElementReader& reader,
    Catalogue& catalogue);

/// The device with exactly this vendor, product and revision; nullptr: there is none.
[[nodiscard]] std::shared_ptr<const wire::DeviceDescription> findDevice(
    const wire::Identity& identity, Catalogue& catalogue);

}  // namespace takt::config
