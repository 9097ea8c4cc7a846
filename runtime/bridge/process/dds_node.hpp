#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <takt/bridge/protocol.hpp>
#include <vector>

namespace takt::bridge {

/// The machine's participant in a DDS domain, with its topics (idl/takt.idl). The only place that
/// knows DDS.
class DdsNode {
public:
    /// Nothing is sent beyond this computer unless the header names another interface than "lo";
    /// the surroundings of the process (CYCLONEDDS_URI) have no say.
    /// \throw std::runtime_error with the cause
    DdsNode(const StatusHeader& header, std::span<const MemberInfo> axes,
            std::span<const MemberInfo> groups);
    ~DdsNode();
    DdsNode(const DdsNode&) = delete;
    DdsNode& operator=(const DdsNode&) = delete;

    void publish(const MachineSample& sample);
    void publishAxis(std::size_t index, const AxisSample& sample);
    void publishGroup(std::size_t index, const GroupSample& sample);
    /// Sends what was published; before, it waits to share packets.
    void flush();
    /// \return false when a reliable subscriber cannot follow now: try again later
    [[nodiscard]] bool publish(const EventRecord& event);
    [[nodiscard]] bool publish(const ReplyRecord& reply);

    /// The commands that have come for this machine, a bounded number of them. A writer that went
    /// away has left.
    [[nodiscard]] std::span<const CommandRecord> takeCommands();

private:
    using Entity = std::int32_t;

    Entity create(Entity entity, const char* what);
    void createDomain();
    void createStatusWriters();
    void createEventWriter();
    void createCommandDoor();
    [[nodiscard]] std::int64_t timeOf(std::uint64_t cycle) const noexcept {
        return static_cast<std::int64_t>(cycle) * header_.cycleNs;
    }

    StatusHeader header_;
    std::span<const MemberInfo> axes_;
    std::span<const MemberInfo> groups_;
    Entity domain_{0};
    Entity participant_{0};
    Entity machineWriter_{0};
    Entity axisWriter_{0};
    Entity groupWriter_{0};
    Entity eventWriter_{0};
    Entity replyWriter_{0};
    Entity commandReader_{0};  ///< 0: commands are switched off
    std::vector<CommandRecord> commands_;
};

}  // namespace takt::bridge
