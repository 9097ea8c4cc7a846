#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <takt/fieldbus/ethercat/segment_tool.hpp>
#include <takt/wire/device_description.hpp>
#include <vector>

#include "segment.hpp"

namespace takt::cli {

/// Where the bus tools look: on a network interface, on the simulated network of a machine file,
/// or, where neither is named, on the network of the machine that runs.
struct BusOptions {
    std::string verb;  ///< "slaves"; how the tool calls itself
    std::string interface;
    std::filesystem::path machine;           ///< simulated
    std::filesystem::path socket;            ///< of a running machine; empty: the only one
    std::vector<std::filesystem::path> esi;  ///< more device files to know devices by
    std::filesystem::path executableFolder;  ///< installed device files are found from there
    bool json{false};
};

/// A device of a segment, the name that a machine file gives it, and its description where one is
/// known.
struct ToolDevice {
    const fieldbus::ethercat::SegmentDevice* found{nullptr};
    std::string name;
    const wire::DeviceDescription* description{nullptr};
    std::string file;  ///< of the description

    /// The type as the device file or its EEPROM tells it; "?" when nobody does.
    [[nodiscard]] std::string type() const;
};

/// A network that has been looked at.
class ToolBus {
public:
    /// \throw std::runtime_error one line: what is missing
    explicit ToolBus(const BusOptions& options);
    ~ToolBus();
    ToolBus(const ToolBus&) = delete;
    ToolBus& operator=(const ToolBus&) = delete;

    [[nodiscard]] Segment& segment() noexcept;
    [[nodiscard]] const Segment& segment() const noexcept;
    [[nodiscard]] std::size_t size() const noexcept;
    /// \pre position < size()
    [[nodiscard]] ToolDevice device(std::size_t position) const;
    /// The device of that position or name.
    /// \throw std::runtime_error one line: there is none, and which there are
    [[nodiscard]] std::size_t find(const std::string& text) const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Runs a verb and prints what it throws as one line, "takt <verb>: …".
/// \return its exit code, or 2 when it threw
int runVerb(const char* name, const std::function<int()>& verb);

}  // namespace takt::cli
