#include "messages.hpp"

#include <fmt/format.h>

#include <takt/wire/al_state.hpp>
#include <takt/wire/device_description.hpp>
#include <takt/wire/registers.hpp>

namespace takt::fieldbus::ethercat {

namespace {

using Lines = std::vector<std::string>;

void compareNumber(Lines& lines, const SlaveParams& slave, const char* what, std::uint32_t expected,
                   std::uint32_t found) {
    if (expected == found) return;
    lines.push_back(fmt::format(
        "expected {} {:#010x}, found {:#010x}; check the {} file or the order of the devices", what,
        expected, found, slave.listed ? "network" : "ESI"));
}

void compareRevision(Lines& lines, const SlaveParams& expected, std::uint32_t found) {
    const std::uint32_t wanted = expected.device->identity.revision;
    switch (expected.revisionRule) {
        case RevisionRule::Ignore:
            return;
        case RevisionRule::Equal:
            compareNumber(lines, expected, "revision", wanted, found);
            return;
        case RevisionRule::EqualOrGreater:
            if (found >= wanted) return;
            lines.push_back(fmt::format(
                "expected revision {:#010x} or greater, found {:#010x}; use the ESI file of this "
                "revision or allow any with the revision rule",
                wanted, found));
            return;
    }
}

void compareBox(Lines& lines, const char* what, const MailboxWords& found, std::uint16_t start,
                std::uint16_t size) {
    if (found.start == start && found.size == size) return;
    lines.push_back(fmt::format(
        "expected {} mailbox at {:#06x} with {} bytes, found {:#06x} with {} bytes; the ESI file "
        "does not belong to this device",
        what, start, size, found.start, found.size));
}

void compareAbilities(Lines& lines, const SlaveParams& expected, const ScannedDevice& found) {
    const wire::DeviceDescription& device = *expected.device;
    if (found.fmmus < device.fmmus.size()) {
        lines.push_back(
            fmt::format("expected {} FMMUs, found {}", device.fmmus.size(), found.fmmus));
    }
    if (found.syncManagers < device.syncManagers.size()) {
        lines.push_back(fmt::format("expected {} SyncManagers, found {}",
                                    device.syncManagers.size(), found.syncManagers));
    }
    if (expected.dc.enabled && !found.has(wire::reg::FeatureDc)) {
        lines.emplace_back(
            "expected distributed clocks, but the device has none; "
            "choose an operating mode without DC");
    }
    if (device.lrwSupported && found.has(wire::reg::FeatureNoLrw)) {
        lines.emplace_back(
            "the device does not know LRW, but its ESI file does not say so "
            "(UseLrdLwr)");
    }
}

std::string abortWords(std::uint32_t code) {
    return fmt::format("abort {:#010x}: {}", code, wire::explainAbort(code));
}

std::string objectName(std::uint16_t index, std::uint8_t subindex) {
    return fmt::format("{:04X}h:{:02X}", index, subindex);
}

/// "init command 'check vendor id'"
std::string commandName(const ListedCommand& command) {
    return command.comment.empty() ? fmt::format("init command at register {:#06x}", command.ado)
                                   : fmt::format("init command '{}'", command.comment);
}

std::string unanswered(const ListedCommand& command, std::int64_t counter) {
    return fmt::format("the {} came back with working counter {}, expected {}",
                       commandName(command), counter, command.workingCounter.value_or(0));
}

std::string mismatch(const ListedCommand& command, std::int64_t seen) {
    std::uint32_t wanted = 0;
    if (command.validation) {
        const auto& data = command.validation->data;
        for (std::size_t i = 0; i < data.size() && i < 4; ++i) {
            wanted |= std::uint32_t{data[i]} << (8U * i);
        }
    }
    return fmt::format("the {} reads {:#x}, expected {:#x}", commandName(command), seen, wanted);
}

std::string alWords(std::uint16_t code) {
    return fmt::format("AL status code {:#06x}: {}", code, wire::explainAlStatus(code));
}

/// The listed command that a problem speaks of; nullptr: of none.
const ListedCommand* listedCommand(const NetworkParams& network, const NetworkProblem& problem) {
    const std::vector<ListedCommand>* commands = nullptr;
    if (problem.slave < network.slaves.size() && network.slaves[problem.slave].listed) {
        commands = &network.slaves[problem.slave].listed->commands;
    } else if (problem.slave == NetworkProblem::NoSlave && network.listed) {
        commands = &network.listed->commands;
    }
    return commands != nullptr && problem.item < commands->size() ? &(*commands)[problem.item]
                                                                  : nullptr;
}

}  // namespace

std::string slaveLabel(const NetworkParams& network, std::size_t slave) {
    if (slave >= network.slaves.size()) return fmt::format("slave {}", slave);
    return fmt::format("slave {} '{}'", slave, network.slaves[slave].name);
}

std::string describe(const wire::Identity& identity) {
    return fmt::format("vendor {:#010x}, product {:#010x}, revision {:#010x}", identity.vendor,
                       identity.product, identity.revision);
}

std::vector<std::string> compare(const SlaveParams& expected, const ScannedDevice& found) {
    Lines lines;
    const wire::Identity& wanted = expected.device->identity;
    compareNumber(lines, expected, "vendor", wanted.vendor, found.identity.vendor);
    compareNumber(lines, expected, "product", wanted.product, found.identity.product);
    compareRevision(lines, expected, found.identity.revision);
    if (!lines.empty()) return lines;  // another device: what it can do means nothing here
    // A list sets the mailbox up as it likes, within what the device takes.
    if (const auto place = mailboxPlace(expected); place && !expected.listed) {
        compareBox(lines, "receive", found.mailboxOut, place->outStart, place->outSize);
        compareBox(lines, "send", found.mailboxIn, place->inStart, place->inSize);
    }
    compareAbilities(lines, expected, found);
    return lines;
}

std::string describe(const ScriptFailure& failure, const Step& step) {
    switch (failure.kind) {
        case ScriptFailure::Kind::None:
            return "no error";
        case ScriptFailure::Kind::RegisterSilent:
            return fmt::format("does not take register {:#06x}; check cable and power",
                               failure.address);
        case ScriptFailure::Kind::ObjectAborted: {
            const auto* object = std::get_if<ObjectStep>(&step);
            const std::string origin = object != nullptr && !object->origin.empty()
                                           ? fmt::format(" ({})", object->origin)
                                           : std::string{};
            return fmt::format("refuses object {}{} with {}",
                               objectName(failure.address, failure.subindex), origin,
                               abortWords(failure.abortCode));
        }
        case ScriptFailure::Kind::StateRefused:
            return fmt::format("refuses {} and stays in {}, {}", wire::name(failure.target),
                               wire::name(failure.seen.state), alWords(failure.seen.code));
        case ScriptFailure::Kind::StateTimedOut:
            return fmt::format("does not reach {} in time and is in {}", wire::name(failure.target),
                               wire::name(failure.seen.state));
        case ScriptFailure::Kind::StateSilent:
            return fmt::format("does not answer on the way to {}; check cable and power",
                               wire::name(failure.target));
        case ScriptFailure::Kind::CommandUnanswered:
            return unanswered(std::get<CommandStep>(step).command, failure.number);
        case ScriptFailure::Kind::CommandMismatch:
            return mismatch(std::get<CommandStep>(step).command, failure.number);
    }
    return {};
}

std::string describe(const ScriptNote& note) {
    return fmt::format("optional object {} refused with {}",
                       objectName(note.address.index, note.address.subindex),
                       abortWords(note.abortCode));
}

std::string describe(const NetworkParams& network, const NetworkProblem& problem) {
    const std::string who = problem.slave == NetworkProblem::NoSlave
                                ? std::string{"network"}
                                : slaveLabel(network, problem.slave);
    const ListedCommand* const command = listedCommand(network, problem);
    switch (problem.kind) {
        case NetworkProblem::Kind::ObjectRefused:
            return fmt::format("{} refuses object {:04X}h with {}", who, problem.item,
                               abortWords(static_cast<std::uint32_t>(problem.number)));
        case NetworkProblem::Kind::CommandUnanswered:
            return command == nullptr
                       ? std::string{}
                       : fmt::format("{}: {} ({})", who, unanswered(*command, problem.number),
                                     command->origin);
        case NetworkProblem::Kind::CommandMismatch:
            return command == nullptr
                       ? std::string{}
                       : fmt::format("{}: {} ({})", who, mismatch(*command, problem.number),
                                     command->origin);
        case NetworkProblem::Kind::None:
            return {};
        case NetworkProblem::Kind::StateRefused:
            return fmt::format("{} refuses {} and is in {}, {}", who, wire::name(problem.wanted),
                               wire::name(problem.seen), alWords(problem.alStatusCode));
        case NetworkProblem::Kind::StateTimedOut:
            return fmt::format("{} does not reach {} in time and is in {}", who,
                               wire::name(problem.wanted), wire::name(problem.seen));
        case NetworkProblem::Kind::Silent:
            return fmt::format("{} does not answer; check cable and power", who);
        case NetworkProblem::Kind::FellBack:
            return fmt::format("{} left {} in cycle {} and is in {}, {}", who,
                               wire::name(problem.wanted), problem.cycle, wire::name(problem.seen),
                               alWords(problem.alStatusCode));
        case NetworkProblem::Kind::WorkingCounter:
            return "process data do not come back with the expected working counter";
        case NetworkProblem::Kind::ClockNotLocked:
            return "the cycle does not settle on the SYNC0 grid";
        case NetworkProblem::Kind::DeviceClock:
            return fmt::format("{}: its clock is {} ns away from the reference, allowed are {} ns",
                               who, problem.number, network.dcLimit.count());
    }
    return {};
}

}  // namespace takt::fieldbus::ethercat
