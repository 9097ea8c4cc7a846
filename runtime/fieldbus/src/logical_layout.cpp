#include "logical_layout.hpp"

#include <algorithm>
#include <takt/fieldbus/pdo_layout.hpp>
#include <takt/wire/device_description.hpp>

namespace takt::fieldbus::ethercat {

namespace {

constexpr std::size_t ReferenceTimeBytes = 8;
constexpr std::size_t AlStatusBytes = 2;

/// Bytes of the first frame beside its process data: reference time, mailbox states, AL status.
std::size_t extraBytesFor(std::size_t mailboxBytes) noexcept {
    const std::size_t mailbox = mailboxBytes == 0 ? 0 : wire::DatagramOverhead + mailboxBytes;
    return wire::DatagramOverhead + ReferenceTimeBytes + wire::DatagramOverhead + AlStatusBytes +
           mailbox;
}

bool hasMailboxFmmu(const SlaveParams& slave) noexcept {
    if (!slave.device || !slave.device->mailbox) return false;
    const auto& fmmus = slave.device->fmmus;
    return std::find(fmmus.begin(), fmmus.end(), wire::FmmuUse::MailboxState) != fmmus.end();
}

void enter(ProcessGroup& group, SlavePlace& place, const SlaveParams& slave) noexcept {
    place.outputOffset = group.outputBytes;
    place.inputOffset = group.inputBytes;
    group.outputBytes = static_cast<std::uint16_t>(group.outputBytes + place.outputBytes);
    group.inputBytes = static_cast<std::uint16_t>(group.inputBytes + place.inputBytes);
    if (place.outputBytes != 0) ++group.writers;
    if (place.inputBytes != 0) ++group.readers;
    ++group.slaveCount;
    if (slave.device && !slave.device->lrwSupported) group.lrw = false;
}

}  // namespace

LogicalLayout makeLayout(const NetworkParams& network) {
    LogicalLayout layout;
    layout.groups.emplace_back();
    for (const SlaveParams& slave : network.slaves) {
        if (hasMailboxFmmu(slave)) ++layout.mailboxBits;
    }
    std::size_t capacity =
        FrameCapacity - 2 * wire::DatagramOverhead - extraBytesFor(layout.mailboxBytes());
    std::uint16_t mailboxBit = 0;
    for (std::size_t i = 0; i < network.slaves.size(); ++i) {
        const SlaveParams& slave = network.slaves[i];
        const std::uint32_t outputs = processDataBytes(slave, Direction::Outputs);
        const std::uint32_t inputs = processDataBytes(slave, Direction::Inputs);
        if (outputs + inputs > capacity) layout.fits = false;
        const ProcessGroup& open = layout.groups.back();
        if (open.slaveCount != 0 &&
            open.outputBytes + open.inputBytes + outputs + inputs > capacity) {
            ProcessGroup next;
            next.logical = open.logical + LogicalGroupStep;
            next.firstSlave = static_cast<std::uint16_t>(i);
            layout.groups.push_back(next);
            capacity = FrameCapacity - 2 * wire::DatagramOverhead;
        }
        SlavePlace place;
        place.group = static_cast<std::uint16_t>(layout.groups.size() - 1);
        place.outputBytes = static_cast<std::uint16_t>(outputs);
        place.inputBytes = static_cast<std::uint16_t>(inputs);
        if (hasMailboxFmmu(slave)) place.mailboxBit = mailboxBit++;
        enter(layout.groups.back(), place, slave);
        layout.slaves.push_back(place);
    }
    return layout;
}

}  // namespace takt::fieldbus::ethercat
