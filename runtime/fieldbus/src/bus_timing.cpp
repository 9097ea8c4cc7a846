#include <algorithm>
#include <takt/fieldbus/bus_timing.hpp>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/device_description.hpp>
#include <takt/wire/frame.hpp>

#include "cycle_plan.hpp"
#include "logical_layout.hpp"

namespace takt::fieldbus {

namespace {

using core::Duration;

constexpr Duration WireByte{80};
constexpr Duration RoundTripPerDevice{1000};
constexpr Duration ReceiveMargin = std::chrono::microseconds{50};
/// Copy time of a device that does not tell it in 1C32h:06.
constexpr Duration UsualCopyTime = std::chrono::microseconds{25};

Duration copyTime(const wire::DeviceDescription& device) noexcept {
    const wire::ObjectDescription* object = device.findObject(0x1C32);
    if (object == nullptr) return UsualCopyTime;
    for (const wire::ObjectEntryDescription& entry : object->entries) {
        if (entry.subindex == 6 && entry.defaultValue.size() == 4) {
            return Duration{wire::load32(entry.defaultValue, 0)};
        }
    }
    return UsualCopyTime;
}

Duration longestCopyTime(const NetworkParams& network) noexcept {
    Duration longest{0};
    for (const SlaveParams& slave : network.slaves) {
        if (slave.device) longest = std::max(longest, copyTime(*slave.device));
    }
    return longest;
}

struct Load {
    std::size_t frames{0};
    std::size_t frameBytes{0};
    std::size_t wireBytes{0};

    void addFrame(std::size_t datagramBytes) noexcept {
        const std::size_t size =
            std::max(wire::MinFrameSize,
                     wire::EthernetHeaderSize + wire::EtherCatHeaderSize + datagramBytes);
        ++frames;
        frameBytes += size;
        wireBytes += wire::wireBytes(size);
    }
};

Load countFrames(const ethercat::CyclePlan& plan, std::size_t sliceBytes) noexcept {
    Load load;
    for (std::size_t i = 0; i < plan.frames(); ++i) {
        const std::size_t bytes = plan.bytesOf(i);
        const bool last = i + 1 == plan.frames();
        // The slice rides in the last frame when there is room, else in a frame of its own.
        const bool ownFrame = last && bytes + sliceBytes > ethercat::FrameCapacity;
        load.addFrame(last && !ownFrame ? bytes + sliceBytes : bytes);
        if (ownFrame) load.addFrame(sliceBytes);
    }
    return load;
}

}  // namespace

std::size_t acyclicSliceBytes(const NetworkParams& network) noexcept {
    constexpr std::size_t alStatusRead = wire::DatagramOverhead + 6;
    std::size_t bytes = network.slaves.size() * alStatusRead;
    for (const SlaveParams& slave : network.slaves) {
        if (!slave.device || !slave.device->mailbox) continue;
        for (const wire::SyncManagerDescription& manager : slave.device->syncManagers) {
            if (manager.use != wire::SyncManagerUse::MailboxOut &&
                manager.use != wire::SyncManagerUse::MailboxIn) {
                continue;
            }
            bytes = std::max(bytes, manager.defaultSize + wire::DatagramOverhead);
        }
    }
    return std::min(bytes, ethercat::FrameCapacity);
}

BusTiming computeTiming(const NetworkParams& network) {
    const ethercat::CyclePlan plan = ethercat::makePlan(network, ethercat::makeLayout(network));
    BusTiming timing;
    timing.acyclicBytes = acyclicSliceBytes(network);
    const Load load = countFrames(plan, timing.acyclicBytes);
    timing.frames = load.frames;
    timing.frameBytes = load.frameBytes;
    timing.wireTime = WireByte * static_cast<std::int64_t>(load.wireBytes);
    const Duration through = RoundTripPerDevice * static_cast<std::int64_t>(network.slaves.size());
    timing.roundTrip = timing.wireTime + through;

    const Duration receiveNeed = timing.roundTrip + network.sendJitter + ReceiveMargin;
    timing.receiveDeadline = std::max(network.cycle * 3 / 10, receiveNeed);
    const Duration syncNeed =
        timing.wireTime + through / 2 + network.sendJitter + longestCopyTime(network);
    timing.sync0AfterSend = std::max(network.cycle / 4, syncNeed);
    if (network.cycle.count() > 0) {
        timing.load = static_cast<double>(std::max(receiveNeed, syncNeed).count()) /
                      static_cast<double>(network.cycle.count());
    }
    return timing;
}

}  // namespace takt::fieldbus
