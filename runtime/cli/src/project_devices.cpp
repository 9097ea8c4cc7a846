#include "project_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <takt/config/eni_reader.hpp>
#include <takt/config/esi_reader.hpp>
#include <takt/core/cia402.hpp>

namespace takt::cli {

namespace {

namespace cia402 = core::cia402;

constexpr std::array<std::uint16_t, 3> NeededOutputs{cia402::ControlWord, cia402::TargetPosition,
                                                     cia402::ModesOfOperation};
constexpr std::array<std::uint16_t, 3> NeededInputs{cia402::StatusWord, cia402::PositionActual,
                                                    cia402::ModesOfOperationDisplay};
/// What an axis shows when the drive offers it.
constexpr std::array<std::uint16_t, 2> WelcomeInputs{cia402::ErrorCode, cia402::DigitalInputs};

std::vector<wire::DeviceDescription> read(const std::filesystem::path& file) {
    if (!std::filesystem::is_regular_file(file)) {
        throw std::runtime_error{fmt::format("there is no device file {}", file.string())};
    }
    config::Diagnostics diagnostics;
    auto devices = config::readEsi(file, diagnostics);
    for (const config::Diagnostic& item : diagnostics.items()) {
        if (item.severity == config::Severity::Error && devices.empty()) {
            throw std::runtime_error{config::format(item)};
        }
    }
    if (devices.empty()) {
        throw std::runtime_error{fmt::format("{}: describes no device", file.string())};
    }
    return devices;
}

/// The highest revision of each type, in file order.
std::vector<wire::DeviceDescription> newest(std::vector<wire::DeviceDescription> devices) {
    std::vector<wire::DeviceDescription> result;
    for (wire::DeviceDescription& device : devices) {
        const auto same = std::find_if(result.begin(), result.end(), [&device](const auto& other) {
            return other.type == device.type;
        });
        if (same == result.end()) {
            result.push_back(std::move(device));
        } else if (same->identity.revision < device.identity.revision) {
            *same = std::move(device);
        }
    }
    return result;
}

std::string typesOf(const std::vector<wire::DeviceDescription>& devices) {
    std::string text;
    for (const auto& device : devices) text += (text.empty() ? "" : ", ") + device.type;
    return text;
}

bool maps(std::span<const wire::PdoDescription* const> pdos, std::uint16_t index) {
    return std::any_of(pdos.begin(), pdos.end(), [index](const wire::PdoDescription* pdo) {
        return std::any_of(pdo->entries.begin(), pdo->entries.end(), [index](const auto& entry) {
            return entry.index == index && entry.subindex == 0;
        });
    });
}

bool mappable(const wire::DeviceDescription& device, std::uint16_t index,
              wire::PdoMappable direction) {
    const wire::ObjectDescription* const object = device.findObject(index);
    if (object == nullptr || object->entries.empty()) return false;
    return (static_cast<unsigned>(object->entries.front().mappable) &
            static_cast<unsigned>(direction)) != 0;
}

/// One direction of the process data of a drive, what an axis must have in it and what it can use.
struct Side {
    const std::vector<wire::PdoDescription>& offered;
    std::vector<std::uint16_t> needed;
    std::vector<std::uint16_t> wanted;  ///< the needed ones and more
};

bool defaultsCarry(const Side& side, const std::vector<std::uint16_t>& objects) {
    std::vector<const wire::PdoDescription*> assigned;
    for (const auto& pdo : side.offered) {
        if (pdo.syncManager) assigned.push_back(&pdo);
    }
    return std::all_of(objects.begin(), objects.end(),
                       [&assigned](std::uint16_t index) { return maps(assigned, index); });
}

std::string element(const wire::PdoDescription& pdo, const std::vector<std::uint16_t>& entries,
                    std::string_view indent) {
    if (entries.empty()) return fmt::format("{}<Pdo index=\"0x{:04X}\"/>\n", indent, pdo.index);
    std::string text = fmt::format("{}<Pdo index=\"0x{:04X}\">\n", indent, pdo.index);
    for (const std::uint16_t index : entries) {
        text += fmt::format("{}  <Entry index=\"0x{:04X}\"/>\n", indent, index);
    }
    return text + fmt::format("{}</Pdo>\n", indent);
}

std::string sideElement(const wire::DeviceDescription& device, const Side& side,
                        std::string_view indent) {
    if (defaultsCarry(side, side.wanted)) return {};
    const bool configurable = device.mailbox && device.mailbox->pdoConfig;
    const auto free = std::find_if(side.offered.begin(), side.offered.end(),
                                   [](const wire::PdoDescription& pdo) { return !pdo.fixed; });
    if (configurable && free != side.offered.end()) return element(*free, side.wanted, indent);
    if (defaultsCarry(side, side.needed)) return {};
    for (const wire::PdoDescription& pdo : side.offered) {
        const std::array<const wire::PdoDescription*, 1> alone{&pdo};
        const bool enough =
            std::all_of(side.needed.begin(), side.needed.end(),
                        [&alone](std::uint16_t index) { return maps(alone, index); });
        if (enough) return element(pdo, {}, indent);
    }
    throw std::runtime_error{
        fmt::format("{}: device {} has no PDO that carries 6040h, 607Ah and 6060h or 6041h, "
                    "6064h and 6061h, and its PDOs cannot be written",
                    device.source, device.type)};
}

std::vector<ProjectDevice> readAll(const std::vector<std::filesystem::path>& files) {
    std::vector<ProjectDevice> known;
    for (const std::filesystem::path& file : files) {
        for (auto& device : read(file)) known.push_back({std::move(device), file, {}});
    }
    return known;
}

const ProjectDevice* find(const std::vector<ProjectDevice>& known, const wire::Identity& wanted) {
    const auto same = std::find_if(known.begin(), known.end(), [&](const ProjectDevice& entry) {
        const wire::Identity& has = entry.device.identity;
        return has.vendor == wanted.vendor && has.product == wanted.product &&
               has.revision == wanted.revision;
    });
    return same == known.end() ? nullptr : &*same;
}

}  // namespace

std::vector<ProjectDevice> chooseDevices(const std::vector<std::filesystem::path>& files,
                                         const std::vector<std::string>& types) {
    std::vector<ProjectDevice> known;
    for (const std::filesystem::path& file : files) {
        const auto devices = newest(read(file));
        if (types.empty() && devices.size() > 1) {
            throw std::runtime_error{
                fmt::format("{} describes {} devices; name one with --device: {}", file.string(),
                            devices.size(), typesOf(devices))};
        }
        for (const auto& device : devices) known.push_back({device, file, {}});
    }
    if (types.empty()) return known;

    std::vector<ProjectDevice> chosen;
    for (const std::string& type : types) {
        const auto found =
            std::find_if(known.begin(), known.end(),
                         [&type](const ProjectDevice& entry) { return entry.device.type == type; });
        if (found == known.end()) {
            std::vector<wire::DeviceDescription> devices;
            devices.reserve(known.size());
            for (const ProjectDevice& entry : known) devices.push_back(entry.device);
            throw std::runtime_error{fmt::format(
                "no device '{}' is in the device files; there are: {}", type, typesOf(devices))};
        }
        chosen.push_back(*found);
    }
    return chosen;
}

std::vector<ProjectDevice> findDevices(const std::vector<std::filesystem::path>& files,
                                       const std::vector<wire::Identity>& found) {
    const std::vector<ProjectDevice> known = readAll(files);
    std::vector<ProjectDevice> result;
    for (std::size_t position = 0; position < found.size(); ++position) {
        const wire::Identity& wanted = found[position];
        const ProjectDevice* const same = find(known, wanted);
        if (same == nullptr) {
            throw std::runtime_error{
                fmt::format("device {} on the network has vendor 0x{:08X}, product 0x{:08X}, "
                            "revision 0x{:08X}, which is in no device file; add it with --esi",
                            position, wanted.vendor, wanted.product, wanted.revision)};
        }
        result.push_back(*same);
    }
    return result;
}

std::vector<ProjectDevice> devicesOfNetwork(const std::filesystem::path& eni,
                                            const std::vector<std::filesystem::path>& files) {
    if (!std::filesystem::is_regular_file(eni)) {
        throw std::runtime_error{fmt::format("there is no network file {}", eni.string())};
    }
    config::Diagnostics diagnostics;
    const auto network = config::readEni(eni, diagnostics);
    for (const config::Diagnostic& item : diagnostics.items()) {
        if (!network && item.severity == config::Severity::Error) {
            throw std::runtime_error{config::format(item)};
        }
    }
    const std::vector<ProjectDevice> known = readAll(files);
    std::vector<ProjectDevice> result;
    for (const config::EniSlave& slave : network->slaves) {
        const ProjectDevice* const same = find(known, slave.device.identity);
        ProjectDevice device{slave.device, {}, slave.name};
        if (same != nullptr) {
            device.device.type = same->device.type;
            device.file = same->file;
        }
        result.push_back(std::move(device));
    }
    return result;
}

bool isDrive(const wire::DeviceDescription& device) {
    if (device.findObject(cia402::ControlWord) != nullptr) return true;
    return std::any_of(device.rxPdos.begin(), device.rxPdos.end(),
                       [](const wire::PdoDescription& pdo) {
                           const std::array<const wire::PdoDescription*, 1> alone{&pdo};
                           return maps(alone, cia402::ControlWord);
                       });
}

std::string axisPdos(const wire::DeviceDescription& device, std::string_view indent) {
    const std::vector<std::uint16_t> outputs{NeededOutputs.begin(), NeededOutputs.end()};
    const std::vector<std::uint16_t> inputs{NeededInputs.begin(), NeededInputs.end()};
    std::vector<std::uint16_t> welcome = inputs;
    for (const std::uint16_t index : WelcomeInputs) {
        if (mappable(device, index, wire::PdoMappable::Transmit)) welcome.push_back(index);
    }
    return sideElement(device, {device.rxPdos, outputs, outputs}, indent) +
           sideElement(device, {device.txPdos, inputs, welcome}, indent);
}

}  // namespace takt::cli
