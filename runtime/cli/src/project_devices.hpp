#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <takt/wire/device_description.hpp>
#include <vector>

namespace takt::cli {

/// A device of a new project and the file that describes it.
struct ProjectDevice {
    wire::DeviceDescription device;
    std::filesystem::path file;  ///< empty: nothing but the network file describes it
    std::string slave;           ///< as a network file names it; empty: it gets a name
};

/// The devices of the files that are wanted, in order: of each file those of the given types, or
/// its only one. Of several revisions the highest counts. \throw std::runtime_error one line: the
/// file cannot be read, or the choice is not clear
[[nodiscard]] std::vector<ProjectDevice> chooseDevices(
    const std::vector<std::filesystem::path>& files, const std::vector<std::string>& types);

/// The description of each device that a scan found, in frame order.
/// \throw std::runtime_error one line: a device is in no file, with its identity
[[nodiscard]] std::vector<ProjectDevice> findDevices(
    const std::vector<std::filesystem::path>& files, const std::vector<wire::Identity>& found);

/// The slaves of a network file (ENI), in frame order; `files`: device files that may describe
/// them. \throw std::runtime_error one line: the first thing that is wrong with the network file
[[nodiscard]] std::vector<ProjectDevice> devicesOfNetwork(
    const std::filesystem::path& eni, const std::vector<std::filesystem::path>& files);

/// A device with a controlword is a CiA 402 drive.
[[nodiscard]] bool isDrive(const wire::DeviceDescription& device);

/// The <Pdo> elements that a machine file needs for an axis on this drive; empty when its defaults
/// do. \throw std::runtime_error the drive has no PDO that can carry what an axis needs
[[nodiscard]] std::string axisPdos(const wire::DeviceDescription& device, std::string_view indent);

}  // namespace takt::cli
