#include "cycle_plan.hpp"

#include <algorithm>
#include <takt/wire/registers.hpp>

namespace takt::fieldbus::ethercat {

namespace {

using Kind = CyclicCommand::Kind;
using wire::Command;

/// Register of a datagram that is not logical: position or station below.
constexpr std::uint32_t registerOf(std::uint16_t ado) noexcept {
    return std::uint32_t{ado} << 16U;
}

// --- the master's own layout
// ----------------------------------------------------------------------

void appendGroup(CyclePlan& plan, const ProcessGroup& group, std::uint16_t number) {
    PlannedGroup planned;
    planned.first = static_cast<std::uint16_t>(plan.datagrams.size());
    PlannedDatagram datagram;
    datagram.kind = Kind::ProcessData;
    datagram.frame = datagram.group = number;
    datagram.outputAt = plan.outputBytes;
    datagram.inputAt = plan.inputBytes;
    const auto add = [&](Command command, std::uint32_t address, std::uint16_t outputs,
                         std::uint16_t inputs, std::uint16_t expected) {
        datagram.command = command;
        datagram.address = address;
        datagram.length = static_cast<std::uint16_t>(outputs + inputs);
        datagram.outputBytes = datagram.inputFrom = outputs;
        datagram.inputBytes = inputs;
        datagram.expected = expected;
        planned.expected = static_cast<std::uint16_t>(planned.expected + expected);
        plan.datagrams.push_back(datagram);
        ++planned.count;
    };
    if (group.outputBytes + group.inputBytes == 0) {
        // Nobody counts it, but whether the frame came back is seen by it.
        add(Command::Nop, 0, 0, 0, 0);
        plan.datagrams.back().length = 1;
    } else if (group.lrw) {
        add(Command::Lrw, group.logical, group.outputBytes, group.inputBytes, group.expectedLrw());
    } else {
        if (group.outputBytes != 0) {
            add(Command::Lwr, group.logical, group.outputBytes, 0, group.writers);
        }
        if (group.inputBytes != 0) {
            add(Command::Lrd, group.inputLogical(), 0, group.inputBytes, group.readers);
        }
    }
    plan.outputBytes += group.outputBytes;
    plan.inputBytes += group.inputBytes;
    plan.groups.push_back(planned);
}

CyclePlan ownPlan(const LogicalLayout& layout) {
    CyclePlan plan;
    std::vector<PlannedShare> starts;
    for (std::size_t i = 0; i < layout.groups.size(); ++i) {
        PlannedDatagram extra;
        extra.frame = static_cast<std::uint16_t>(i);
        if (i == 0) {
            extra.kind = Kind::ReferenceTime;
            extra.command = Command::Frmw;
            extra.address = registerOf(wire::reg::DcSystemTime);
            extra.length = 8;
            plan.datagrams.push_back(extra);
        }
        starts.push_back({plan.outputBytes, 0, plan.inputBytes, 0, 0, 0});
        appendGroup(plan, layout.groups[i], static_cast<std::uint16_t>(i));
        if (i != 0) continue;
        if (layout.mailboxBits != 0) {
            extra.kind = Kind::MailboxStates;
            extra.command = Command::Lrd;
            extra.address = MailboxStateBase;
            extra.length = layout.mailboxBytes();
            plan.datagrams.push_back(extra);
        }
        extra.kind = Kind::AlStatus;
        extra.command = Command::Brd;
        extra.address = registerOf(wire::reg::AlStatus);
        extra.length = 2;
        plan.datagrams.push_back(extra);
    }
    for (std::size_t i = 0; i < layout.slaves.size(); ++i) {
        const SlavePlace& place = layout.slaves[i];
        const PlannedShare& start = starts[place.group];
        plan.slaves.push_back({start.outputAt + place.outputOffset, place.outputBytes,
                               start.inputAt + place.inputOffset, place.inputBytes, place.group,
                               place.group});
        if (place.mailboxBit != NoMailboxBit) {
            plan.mailboxSlave.push_back(static_cast<std::uint16_t>(i));
        }
    }
    return plan;
}

// --- listed commands
// ------------------------------------------------------------------------------

std::uint8_t statesOf(const CyclicCommand& command) noexcept {
    return static_cast<std::uint8_t>((command.inPreOp ? SentInPreOp : 0U) |
                                     (command.inSafeOp ? SentInSafeOp : 0U) |
                                     (command.inOp ? SentInOp : 0U));
}

void appendListed(CyclePlan& plan, const CyclicCommand& command, std::uint16_t frame) {
    PlannedDatagram datagram;
    datagram.kind = command.kind;
    datagram.command = static_cast<Command>(command.command);
    datagram.address = command.address;
    datagram.length = command.length;
    datagram.frame = frame;
    datagram.states = statesOf(command);
    plan.byState = plan.byState || datagram.states != SentAlways;
    if (command.kind == Kind::ProcessData) {
        datagram.group = static_cast<std::uint16_t>(plan.groups.size());
        datagram.expected = command.workingCounter;
        if (datagram.command != Command::Lrd) {
            datagram.outputBytes = command.length;
            datagram.outputAt = command.outputOffset;
        }
        if (datagram.command != Command::Lwr) {
            datagram.inputBytes = command.length;
            datagram.inputAt = command.inputOffset;
        }
        plan.groups.push_back(
            {static_cast<std::uint16_t>(plan.datagrams.size()), 1, command.workingCounter});
    }
    plan.datagrams.push_back(datagram);
}

/// The group whose datagram carries a range of the image; the first where none does.
std::uint16_t groupOf(const CyclePlan& plan, std::uint32_t at, std::uint32_t bytes, bool outputs) {
    for (const PlannedDatagram& datagram : plan.datagrams) {
        if (datagram.kind != Kind::ProcessData || bytes == 0) continue;
        const std::uint32_t start = outputs ? datagram.outputAt : datagram.inputAt;
        const std::uint32_t size = outputs ? datagram.outputBytes : datagram.inputBytes;
        if (at >= start && at + bytes <= start + size) return datagram.group;
    }
    return 0;
}

CyclePlan listedPlan(const NetworkParams& network) {
    CyclePlan plan;
    const ListedNetwork& listed = *network.listed;
    std::uint16_t frame = 0;
    for (const auto& commands : listed.frames) {
        for (const CyclicCommand& command : commands) appendListed(plan, command, frame);
        if (!commands.empty()) ++frame;
    }
    plan.outputBytes = listed.outputBytes;
    plan.inputBytes = listed.inputBytes;
    const auto bytesOf = [](const ListedRange& range) {
        return range.bits == 0 ? 0 : (range.firstBit % 8 + range.bits + 7) / 8;
    };
    for (std::size_t i = 0; i < network.slaves.size(); ++i) {
        const ListedSlave none{};
        const ListedSlave& slave = network.slaves[i].listed ? *network.slaves[i].listed : none;
        PlannedShare share{slave.outputs.firstBit / 8,
                           bytesOf(slave.outputs),
                           slave.inputs.firstBit / 8,
                           bytesOf(slave.inputs),
                           0,
                           0};
        share.inputGroup = groupOf(plan, share.inputAt, share.inputBytes, false);
        share.outputGroup = share.outputBytes == 0
                                ? share.inputGroup
                                : groupOf(plan, share.outputAt, share.outputBytes, true);
        if (share.inputBytes == 0) share.inputGroup = share.outputGroup;
        plan.slaves.push_back(share);
        if (!slave.mailboxStateBit) continue;
        if (plan.mailboxSlave.size() <= *slave.mailboxStateBit) {
            plan.mailboxSlave.resize(*slave.mailboxStateBit + std::size_t{1}, CyclePlan::NoSlave);
        }
        plan.mailboxSlave[*slave.mailboxStateBit] = static_cast<std::uint16_t>(i);
    }
    return plan;
}

}  // namespace

std::size_t CyclePlan::bytesOf(std::size_t frame) const noexcept {
    std::size_t bytes = 0;
    for (const PlannedDatagram& datagram : datagrams) {
        if (datagram.frame == frame) bytes += wire::DatagramOverhead + datagram.length;
    }
    return bytes;
}

CyclePlan makePlan(const NetworkParams& network, const LogicalLayout& layout) {
    return network.listed ? listedPlan(network) : ownPlan(layout);
}

}  // namespace takt::fieldbus::ethercat
