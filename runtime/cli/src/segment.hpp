#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <takt/core/object_access.hpp>
#include <takt/daemon/bus_end.hpp>
#include <takt/fieldbus/ethercat/segment_tool.hpp>
#include <takt/wire/al_state.hpp>
#include <vector>

namespace takt::cli {

/// The devices of one network, however they are reached. Every function throws std::runtime_error,
/// one line for people, when the network as a whole does not answer or does not allow it.
class Segment {
public:
    virtual ~Segment() = default;

    [[nodiscard]] virtual const std::vector<fieldbus::ethercat::SegmentDevice>& devices() const = 0;
    /// The name that a machine file gives a device; empty: none.
    [[nodiscard]] virtual std::string nameOf(std::size_t position) const = 0;
    /// Device files that the network is known to be described by.
    [[nodiscard]] virtual std::vector<std::filesystem::path> deviceFiles() const = 0;
    /// The machine runs on it: what only a scan can tell is not known.
    [[nodiscard]] virtual bool inOperation() const noexcept = 0;
    /// Leads a device to a state. \return true when it is there
    virtual bool toState(std::size_t position, wire::AlState target) = 0;
    virtual core::ObjectReply upload(std::size_t position, core::ObjectAddress address) = 0;
    /// \param force also while a program of a running machine might be disturbed by it
    virtual core::ObjectReply download(std::size_t position, core::ObjectAddress address,
                                       const core::ObjectValue& value, bool force) = 0;
};

/// Devices without any configuration, on a wire that nobody else uses.
class WireSegment final : public Segment {
public:
    /// Scans it. \param names of a machine file, in frame order; may be empty
    WireSegment(std::unique_ptr<daemon::BusEnd> end, std::vector<std::string> names);

    [[nodiscard]] const std::vector<fieldbus::ethercat::SegmentDevice>& devices() const override;
    [[nodiscard]] std::string nameOf(std::size_t position) const override;
    [[nodiscard]] std::vector<std::filesystem::path> deviceFiles() const override { return {}; }
    [[nodiscard]] bool inOperation() const noexcept override { return false; }
    bool toState(std::size_t position, wire::AlState target) override;
    core::ObjectReply upload(std::size_t position, core::ObjectAddress address) override;
    core::ObjectReply download(std::size_t position, core::ObjectAddress address,
                               const core::ObjectValue& value, bool force) override;

private:
    std::unique_ptr<daemon::BusEnd> end_;
    fieldbus::ethercat::SegmentTool tool_;
    std::vector<std::string> names_;
};

/// The network of the machine that runs, over its control socket.
/// \param socket empty: the only machine that runs
[[nodiscard]] std::unique_ptr<Segment> segmentOfMachine(const std::filesystem::path& socket,
                                                        const std::string& who);

}  // namespace takt::cli
