#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <takt/config/eni_reader.hpp>
#include <takt/config/load_machine.hpp>
#include <takt/config/machine_config.hpp>
#include <vector>

#include "device_catalogue.hpp"
#include "drive_profile.hpp"
#include "element_reader.hpp"

/// The parts of a machine file while it is being read: the parameters so far, with what is needed
/// to name file and line when a rule that joins several of them is broken.
namespace takt::config {

struct SlavePart {
    SlavePart(ElementReader elementReader) : reader{std::move(elementReader)} {}

    ElementReader reader;
    fieldbus::SlaveParams params;
    const DriveProfile* profile{nullptr};
    /// What stands there when the machine is simulated; nullptr: what is configured.
    std::shared_ptr<const wire::DeviceDescription> twinDevice;
    bool hasAxis{false};
};

struct NetworkPart {
    NetworkPart(ElementReader elementReader) : reader{std::move(elementReader)} {}

    ElementReader reader;
    fieldbus::NetworkParams params;  ///< without its slaves
    std::vector<SlavePart> slaves;
    Catalogue catalogue;
    std::optional<EniNetwork> eni;
    bool slavesKnown{true};  ///< false: a network file that could not be read, which was told

    [[nodiscard]] SlavePart* find(std::string_view name) noexcept {
        for (SlavePart& slave : slaves) {
            if (slave.params.name == name) return &slave;
        }
        return nullptr;
    }
};

struct AxisPart {
    AxisPart(ElementReader elementReader) : reader{std::move(elementReader)} {}

    ElementReader reader;
    axis::AxisParams params;
    bool complete{false};  ///< enough was readable to check the rest against the network
};

/// Reads <Network>: ESI files, slaves with their PDOs, DC, watchdog and start-up objects.
[[nodiscard]] NetworkPart readNetwork(ElementReader reader, const std::filesystem::path& folder);

/// Takes the slaves of a network file (ENI) in the place of <Slave> elements. `cycle`: as the
/// machine file has it.
void readListedSlaves(NetworkPart& network, const std::filesystem::path& file,
                      std::optional<core::Duration> cycle);
/// Reads <Bind>: variables of the process image in the place of objects.
[[nodiscard]] axis::DriveBindings readBind(ElementReader reader, const NetworkPart& network,
                                           const SlavePart* slave);

/// Reads and checks the <Pdo> children of a slave, or takes the defaults of its device.
void readPdos(SlavePart& slave);
/// A cyclic synchronous position drive needs these entries, mapped or bound to variables.
void checkCyclicPositionEntries(const SlavePart& slave, const axis::DriveBindings& bound);

/// Reads the <Startup> children of a slave.
void readStartup(SlavePart& slave);
/// Adds what the drive of an axis needs to have written at every start, unless the user writes it.
void addDriveObjects(SlavePart& slave, const AxisPart& axis, std::uint32_t lostLimit);

/// Reads an <Axis> and ties it to its slave.
[[nodiscard]] AxisPart readAxis(ElementReader reader, NetworkPart& network);

/// Reads a <Group> of the axes.
[[nodiscard]] axis::GroupParams readGroup(ElementReader reader, const std::vector<AxisPart>& axes);

/// Reads the <Obstacles> of a group.
/// \return nothing when it is of no group
[[nodiscard]] std::optional<planner::roadmap::ObstacleParams> readObstacles(
    ElementReader reader, const std::vector<AxisPart>& axes,
    const std::vector<axis::GroupParams>& groups);

/// Reads <Twin>; there is one device for each slave, whatever the file says.
[[nodiscard]] twin::TwinParams readTwin(ElementReader reader, NetworkPart& network,
                                        const std::vector<AxisPart>& axes);

/// Reads <MachineStop> and ties its inputs to mapped entries.
[[nodiscard]] axis::MachineStopParams readMachineStop(ElementReader reader, NetworkPart& network,
                                                      const std::vector<AxisPart>& axes);

/// Reads a <Program>; its library is looked for in `folders`, in order.
[[nodiscard]] program::ProgramParams readProgram(ElementReader reader,
                                                 const std::vector<std::filesystem::path>& folders,
                                                 ProgramLibraries libraries);

/// Reads <Realtime>: how the cycle runs on a real network.
void readRealtime(ElementReader reader, scheduler::SchedulerParams& params);

/// Reads <Bridge>: the doors to other processes.
[[nodiscard]] bridge::BridgeParams readBridge(ElementReader reader, core::Duration cycle);

/// Position, velocity, acceleration and jerk in the user unit of an axis.
struct UnitDimensions {
    Dimension position{Dimension::Length};
    Dimension velocity{Dimension::LinearVelocity};
    Dimension acceleration{Dimension::LinearAcceleration};
    Dimension jerk{Dimension::LinearJerk};
};
/// \param unit "mm" or "deg"
[[nodiscard]] UnitDimensions dimensionsOf(std::string_view unit) noexcept;

/// Motor turns for one user unit; negative when the axis is reversed.
[[nodiscard]] double turnsPerUnit(const axis::ScalingParams& scaling) noexcept;

}  // namespace takt::config
