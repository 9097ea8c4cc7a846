#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>
#include <takt/bridge/status_memory.hpp>
#include <utility>

namespace takt::bridge {

namespace {

using namespace std::chrono_literals;

/// So long may the bridge be kept from running without losing a sample.
constexpr core::Duration SampleMemory = 2s;
constexpr std::uint32_t FewestSamples = 16;
constexpr std::uint32_t MostSamples = 2048;

constexpr std::size_t aligned(std::size_t offset) noexcept {
    constexpr std::size_t line = 64;
    return (offset + line - 1) / line * line;
}

std::uint32_t samplesFor(const StatusSetup& setup) {
    const core::Duration period = setup.cycle * static_cast<std::int64_t>(setup.dds.everyCycles);
    const auto wanted = static_cast<std::uint32_t>(SampleMemory / period);
    return std::clamp(wanted, FewestSamples, MostSamples);
}

template <typename T>
std::vector<RingWriter<T>> makeRings(std::byte* at, std::size_t count, std::size_t depth) {
    std::vector<RingWriter<T>> rings;
    for (std::size_t i = 0; i < count; ++i) {
        rings.emplace_back(at + i * RingLayout<T>::bytes(depth), depth);
    }
    return rings;
}

template <typename T>
std::vector<RingReader<T>> readRings(const std::byte* at, std::size_t count, std::size_t depth) {
    std::vector<RingReader<T>> rings;
    for (std::size_t i = 0; i < count; ++i) {
        rings.emplace_back(at + i * RingLayout<T>::bytes(depth), depth,
                           RingReader<T>::From::Newest);
    }
    return rings;
}

StatusHeader headerOf(const StatusSetup& setup, std::uint32_t samples) {
    StatusHeader header;
    header.axes = static_cast<std::uint32_t>(setup.axes.size());
    header.groups = static_cast<std::uint32_t>(setup.groups.size());
    header.samples = samples;
    header.everyCycles = setup.dds.everyCycles;
    header.domain = setup.dds.domain;
    header.cycleNs = setup.cycle.count();
    header.commands = setup.dds.commands;
    put(header.machine, setup.machine);
    put(header.interface, setup.dds.interface);
    return header;
}

void writeMembers(std::byte* at, const std::vector<MemberNames>& members) {
    for (std::size_t i = 0; i < members.size(); ++i) {
        MemberInfo info;
        put(info.name, members[i].name);
        put(info.unit, members[i].unit);
        std::memcpy(at + i * sizeof info, &info, sizeof info);
    }
}

std::vector<MemberInfo> readMembers(const std::byte* at, std::size_t count) {
    std::vector<MemberInfo> members(count);
    if (count > 0) std::memcpy(members.data(), at, count * sizeof(MemberInfo));
    return members;
}

StatusHeader readHeader(const SharedMemory& memory) {
    StatusHeader header;
    if (memory.size() < sizeof header) throw std::runtime_error{"status memory: too small"};
    std::memcpy(&header, memory.data(), sizeof header);
    if (header.magic != ProtocolMagic) throw std::runtime_error{"status memory: of something else"};
    if (header.version != ProtocolVersion) {
        throw std::runtime_error{"status memory: version " + std::to_string(header.version) +
                                 ", this bridge knows " + std::to_string(ProtocolVersion) +
                                 "; do: install bridge and takt of one version"};
    }
    const bool sane = header.axes <= MostMembers && header.groups <= MostMembers &&
                      header.samples >= FewestSamples && header.samples <= MostSamples &&
                      header.everyCycles > 0 && header.cycleNs > 0;
    if (!sane) throw std::runtime_error{"status memory: its counts are out of range"};
    const StatusLayout layout{header.axes, header.groups, header.samples};
    if (memory.size() < layout.end) throw std::runtime_error{"status memory: too small"};
    return header;
}

}  // namespace

StatusLayout::StatusLayout(std::uint32_t axisCount, std::uint32_t groupCount,
                           std::uint32_t samples) noexcept {
    members = aligned(sizeof(StatusHeader));
    machine = aligned(members + (axisCount + groupCount) * sizeof(MemberInfo));
    axes = machine + RingLayout<MachineSample>::bytes(samples);
    groups = axes + axisCount * RingLayout<AxisSample>::bytes(samples);
    events = groups + groupCount * RingLayout<GroupSample>::bytes(samples);
    replies = events + RingLayout<EventRecord>::bytes(EventDepth);
    end = replies + RingLayout<ReplyRecord>::bytes(ReplyDepth);
}

StatusWriter::StatusWriter(const StatusSetup& setup)
    : StatusWriter{setup,
                   {static_cast<std::uint32_t>(setup.axes.size()),
                    static_cast<std::uint32_t>(setup.groups.size()), samplesFor(setup)},
                   samplesFor(setup)} {}

StatusWriter::StatusWriter(const StatusSetup& setup, const StatusLayout& layout,
                           std::uint32_t samples)
    : memory_{SharedMemory::create("takt-status", layout.end, SharedMemory::Others::Read)},
      everyCycles_{setup.dds.everyCycles},
      machine_{memory_.data() + layout.machine, samples},
      events_{memory_.data() + layout.events, EventDepth},
      replies_{memory_.data() + layout.replies, ReplyDepth},
      axes_{makeRings<AxisSample>(memory_.data() + layout.axes, setup.axes.size(), samples)},
      groups_{
          makeRings<GroupSample>(memory_.data() + layout.groups, setup.groups.size(), samples)} {
    const StatusHeader header = headerOf(setup, samples);
    std::memcpy(memory_.data(), &header, sizeof header);
    std::byte* const members = memory_.data() + layout.members;
    writeMembers(members, setup.axes);
    writeMembers(members + setup.axes.size() * sizeof(MemberInfo), setup.groups);
}

StatusReader::StatusReader(int descriptor)
    : StatusReader{SharedMemory::attach(descriptor, SharedMemory::Others::Read)} {}

StatusReader::StatusReader(SharedMemory memory) : StatusReader{memory, readHeader(memory)} {}

StatusReader::StatusReader(SharedMemory& memory, const StatusHeader& header)
    : StatusReader{memory, header, {header.axes, header.groups, header.samples}} {}

StatusReader::StatusReader(SharedMemory& memory, const StatusHeader& header,
                           const StatusLayout& layout)
    : memory_{std::move(memory)},
      header_{header},
      axisNames_{readMembers(memory_.data() + layout.members, header.axes)},
      groupNames_{readMembers(memory_.data() + layout.members + header.axes * sizeof(MemberInfo),
                              header.groups)},
      machine_{memory_.data() + layout.machine, header.samples,
               RingReader<MachineSample>::From::Newest},
      events_{memory_.data() + layout.events, EventDepth, RingReader<EventRecord>::From::Oldest},
      replies_{memory_.data() + layout.replies, ReplyDepth, RingReader<ReplyRecord>::From::Next},
      axes_{readRings<AxisSample>(memory_.data() + layout.axes, header.axes, header.samples)},
      groups_{
          readRings<GroupSample>(memory_.data() + layout.groups, header.groups, header.samples)} {}

}  // namespace takt::bridge
