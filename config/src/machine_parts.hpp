#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <takt/config/load_machine.hpp>
#include <takt/config/machine_config.hpp>
#include <vector>

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
    bool hasAxis{false};
};

struct NetworkPart {
    NetworkPart(ElementReader elementReader) : reader{std::move(elementReader)} {}

    ElementReader reader;
    fieldbus::NetworkParams params;  ///< without its slaves
    std::vector<SlavePart> slaves;

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

/// Reads and checks the <Pdo> children of a slave, or takes the defaults of its device.
void readPdos(SlavePart& slave);
/// A cyclic synchronous position drive needs these entries.
void checkCyclicPositionEntries(const SlavePart& slave);

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
[[nodiscard]] twin::TwinParams readTwin(ElementReader reader, const NetworkPart& network,
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
