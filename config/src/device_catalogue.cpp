#include "device_catalogue.hpp"

#include <fmt/format.h>

#include <set>
#include <system_error>

#include "names.hpp"

namespace takt::config {

namespace {

std::string show(const wire::Identity& identity) {
    return fmt::format("vendor 0x{:08X}, product 0x{:08X}, revision 0x{:08X}", identity.vendor,
                       identity.product, identity.revision);
}

}  // namespace

Catalogue readCatalogue(ElementReader& network, const std::filesystem::path& folder) {
    Catalogue catalogue;
    for (const XmlElement element : network.children("Esi")) {
        const Place where{network.place().file, element.line()};
        ElementReader reader{element, "network, <Esi>", where.file, network.diagnostics()};
        const auto name = reader.text("file", Presence::Required);
        reader.finish();
        if (!name) {
            catalogue.complete = false;
            continue;
        }
        const std::filesystem::path path = (folder / *name).lexically_normal();
        std::error_code fault;
        if (!std::filesystem::is_regular_file(path, fault)) {
            reader.error("file", fmt::format("there is no device file {}", path.string()),
                         "a path relative to the machine file", "correct the path or add the file");
            catalogue.complete = false;
            continue;
        }
        const std::size_t before = network.diagnostics().errorCount();
        DeviceFile file;
        file.devices = readEsiDevices(path, network.diagnostics());
        file.shared.resize(file.devices.size());
        if (network.diagnostics().errorCount() != before) catalogue.complete = false;
        catalogue.files.push_back(std::move(file));
    }
    return catalogue;
}

std::shared_ptr<const wire::DeviceDescription> selectDevice(const std::string& type,
                                                            const WantedIdentity& wanted,
                                                            const ElementReader& reader,
                                                            Catalogue& catalogue) {
    DeviceFile* chosenFile = nullptr;
    std::size_t chosen = 0;
    std::set<std::string> types;
    std::string identities;
    for (DeviceFile& file : catalogue.files) {
        for (std::size_t i = 0; i < file.devices.size(); ++i) {
            const wire::DeviceDescription& device = file.devices[i].description;
            types.insert(device.type);
            if (device.type != type) continue;
            identities += (identities.empty() ? "" : "; ") + show(device.identity);
            const bool better = chosenFile == nullptr ||
                                device.identity.revision >
                                    chosenFile->devices[chosen].description.identity.revision;
            if (!wanted.matches(device.identity) || !better) continue;
            chosenFile = &file;
            chosen = i;
        }
    }
    if (chosenFile != nullptr) {
        auto& shared = chosenFile->shared[chosen];
        if (!shared) {
            reader.diagnostics().append(chosenFile->devices[chosen].diagnostics);
            shared =
                std::make_shared<wire::DeviceDescription>(chosenFile->devices[chosen].description);
        }
        return shared;
    }
    if (!identities.empty()) {
        const char* const at = wanted.revision ? "revision" : wanted.product ? "product" : "vendor";
        reader.error(at, fmt::format("no device '{}' with this identity is in the ESI files", type),
                     identities, "correct the numbers, or add the ESI file of that device");
    } else if (catalogue.complete) {
        const std::vector<std::string> known{types.begin(), types.end()};
        const std::string nearest = nearestName(type, known);
        reader.error(
            "device",
            fmt::format("no device '{}' is in the ESI files{}", type,
                        nearest.empty() ? "" : fmt::format(", did you mean '{}'?", nearest)),
            known.empty() ? "none, no <Esi> file is named" : joined(known));
    }
    return nullptr;
}

std::shared_ptr<const wire::DeviceDescription> findDevice(const wire::Identity& identity,
                                                          Catalogue& catalogue) {
    for (DeviceFile& file : catalogue.files) {
        for (std::size_t i = 0; i < file.devices.size(); ++i) {
            const wire::DeviceDescription& device = file.devices[i].description;
            const bool same = device.identity.vendor == identity.vendor &&
                              device.identity.product == identity.product &&
                              device.identity.revision == identity.revision;
            if (!same || file.devices[i].diagnostics.hasErrors()) continue;
            if (!file.shared[i]) file.shared[i] = std::make_shared<wire::DeviceDescription>(device);
            return file.shared[i];
        }
    }
    return nullptr;
}

}  // namespace takt::config
