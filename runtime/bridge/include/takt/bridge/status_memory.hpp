#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <takt/bridge/bridge_params.hpp>
#include <takt/bridge/broadcast_ring.hpp>
#include <takt/bridge/protocol.hpp>
#include <takt/bridge/shared_memory.hpp>
#include <takt/core/time.hpp>
#include <vector>

namespace takt::bridge {

struct MemberNames {
    std::string name;
    std::string unit;
};

/// What the bridge has to know of a machine before its first cycle.
struct StatusSetup {
    std::string machine;
    core::Duration cycle{};
    DdsParams dds;
    std::vector<MemberNames> axes;
    std::vector<MemberNames> groups;
};

/// Where everything lies in the status memory, computed the same way at both ends.
struct StatusLayout {
    StatusLayout(std::uint32_t axisCount, std::uint32_t groupCount, std::uint32_t samples) noexcept;

    std::size_t members;  ///< MemberInfo of each axis, then of each group
    std::size_t machine;
    std::size_t axes;
    std::size_t groups;
    std::size_t events;
    std::size_t replies;
    std::size_t end;
};

/// The daemon's end of the status: samples of every n-th cycle, events and replies, in memory that
/// the bridge can only read. Everything is touched at the start: no page of it is new in the cycle.
class StatusWriter {
public:
    /// \throw std::runtime_error when there is no memory to be had
    explicit StatusWriter(const StatusSetup& setup);

    /// rt. This cycle is to be published.
    [[nodiscard]] bool due(core::CycleNumber cycle) const noexcept {
        return cycle % everyCycles_ == 0;
    }
    // rt. The thread of the cycle; the machine last, it completes the cycle's samples.
    void axis(std::size_t index, const AxisSample& sample) noexcept { axes_[index].push(sample); }
    void group(std::size_t index, const GroupSample& sample) noexcept {
        groups_[index].push(sample);
    }
    void machine(const MachineSample& sample) noexcept { machine_.push(sample); }
    // One thread, outside the cycle.
    void event(const EventRecord& event) noexcept { events_.push(event); }
    void reply(const ReplyRecord& reply) noexcept { replies_.push(reply); }

    [[nodiscard]] int descriptor() const noexcept { return memory_.descriptor(); }

private:
    StatusWriter(const StatusSetup& setup, const StatusLayout& layout, std::uint32_t samples);

    SharedMemory memory_;
    std::uint32_t everyCycles_;
    RingWriter<MachineSample> machine_;
    RingWriter<EventRecord> events_;
    RingWriter<ReplyRecord> replies_;
    std::vector<RingWriter<AxisSample>> axes_;
    std::vector<RingWriter<GroupSample>> groups_;
};

/// The bridge's end: begins with the samples of now, all events that are kept, and no reply to what
/// was asked of another bridge.
class StatusReader {
public:
    /// \throw std::runtime_error when this is not the status memory of a daemon of this version
    explicit StatusReader(int descriptor);

    [[nodiscard]] const StatusHeader& header() const noexcept { return header_; }
    [[nodiscard]] std::span<const MemberInfo> axisNames() const noexcept { return axisNames_; }
    [[nodiscard]] std::span<const MemberInfo> groupNames() const noexcept { return groupNames_; }

    [[nodiscard]] bool machine(MachineSample& sample) noexcept { return machine_.next(sample); }
    [[nodiscard]] bool axis(std::size_t index, AxisSample& sample) noexcept {
        return axes_[index].next(sample);
    }
    [[nodiscard]] bool group(std::size_t index, GroupSample& sample) noexcept {
        return groups_[index].next(sample);
    }
    [[nodiscard]] bool event(EventRecord& event) noexcept { return events_.next(event); }
    [[nodiscard]] bool reply(ReplyRecord& reply) noexcept { return replies_.next(reply); }

private:
    explicit StatusReader(SharedMemory memory);
    StatusReader(SharedMemory& memory, const StatusHeader& header);
    StatusReader(SharedMemory& memory, const StatusHeader& header, const StatusLayout& layout);

    SharedMemory memory_;
    StatusHeader header_;
    std::vector<MemberInfo> axisNames_;
    std::vector<MemberInfo> groupNames_;
    RingReader<MachineSample> machine_;
    RingReader<EventRecord> events_;
    RingReader<ReplyRecord> replies_;
    std::vector<RingReader<AxisSample>> axes_;
    std::vector<RingReader<GroupSample>> groups_;
};

}  // namespace takt::bridge
