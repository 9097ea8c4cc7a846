#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>
#include <takt/fieldbus/ethercat/segment_tool.hpp>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/mailbox.hpp>
#include <takt/wire/registers.hpp>

#include "bring_up.hpp"
#include "conversation.hpp"
#include "device_scan.hpp"
#include "sii_reader.hpp"
#include "slave_agent.hpp"
#include "slave_script.hpp"

namespace takt::fieldbus::ethercat {

namespace {

namespace reg = wire::reg;
using wire::AlState;
using wire::Command;

constexpr std::size_t MostDatagrams = 128;
constexpr int CountTries = 20;
constexpr core::Duration CountGap = std::chrono::milliseconds{10};
constexpr std::uint16_t ProtocolCoe = 0x0004;
// Mailbox, one buffer; written by the master or read by it, with the event to the device's
// processor.
constexpr std::uint8_t ControlMailboxOut = 0x26;
constexpr std::uint8_t ControlMailboxIn = 0x22;

/// What the EEPROM says of a device, as far as its mailbox needs it.
SlaveParams paramsOf(const ScannedDevice& found) {
    auto device = std::make_shared<wire::DeviceDescription>();
    device->identity = found.identity;
    if (found.mailboxOut.size != 0 && found.mailboxIn.size != 0) {
        const auto box = [](wire::SyncManagerUse use, const MailboxWords& words,
                            std::uint8_t control) {
            return wire::SyncManagerDescription{use,        words.start, words.size, words.size,
                                                words.size, control,     true};
        };
        device->syncManagers = {
            box(wire::SyncManagerUse::MailboxOut, found.mailboxOut, ControlMailboxOut),
            box(wire::SyncManagerUse::MailboxIn, found.mailboxIn, ControlMailboxIn)};
        device->mailbox.emplace().coe = (found.protocols & ProtocolCoe) != 0;
    }
    SlaveParams params;
    params.device = std::move(device);
    return params;
}

/// A device and the state machines that talk to it.
struct Node {
    Node(const ScannedDevice& found, std::uint16_t station)
        : params{paramsOf(found)}, agent{params, station, slice.work(), 0}, machines{&agent} {}

    SlaveParams params;
    AcyclicSlice slice{1};
    SlaveAgent agent;
    std::array<AcyclicMachine*, 1> machines;
    Script script;  ///< outlives its run
};

constexpr std::array Ladder{AlState::Init, AlState::PreOp, AlState::SafeOp, AlState::Op};

std::size_t rung(AlState state) noexcept {
    const auto at = std::find(Ladder.begin(), Ladder.end(), state);
    return at == Ladder.end() ? 0 : static_cast<std::size_t>(at - Ladder.begin());
}

core::Duration timeoutFor(const wire::StateTimeouts& timeouts, AlState target) noexcept {
    return target == AlState::SafeOp || target == AlState::Op ? timeouts.safeOpOp
           : target == AlState::PreOp                         ? timeouts.preOp
                                                              : timeouts.backToInit;
}

}  // namespace

struct SegmentTool::Parts {
    Parts(wire::Link& link, core::ClockSource& clock)
        : frames{2, MostDatagrams}, talk{frames, link, clock} {}

    [[nodiscard]] std::size_t count();
    void address(std::size_t position);
    void identify(std::size_t position);
    void run(Node& node) { talk.run(node.slice, node.machines); }
    void readState(std::size_t position);
    void climb(Script& script, Node& node, std::size_t from, std::size_t to);
    bool startMailbox(std::size_t position);
    core::ObjectReply await(std::size_t position);
    core::ObjectReply ask(std::size_t position, const std::function<bool(CoeClient&)>& start);

    FrameSet frames;
    Conversation talk;
    std::vector<std::unique_ptr<Node>> nodes;
    std::vector<SegmentDevice> devices;
};

std::size_t SegmentTool::Parts::count() {
    std::size_t found = 0;
    std::size_t before = 0;
    for (int i = 0; i < CountTries; ++i) {
        found = talk.ask({Command::Brd, 0, reg::AlStatus, 2, {}}).workingCounter;
        if (found != 0 && found == before) return found;
        before = found;
        talk.pause(CountGap);
    }
    if (talk.linkStatus() != wire::LinkStatus::Ok) {
        throw std::runtime_error{"the link is down; check the interface and the cable"};
    }
    if (found == 0)
        throw std::runtime_error{
            "no device answers; check power and the cable to the first device"};
    throw std::runtime_error{"the number of devices changes from frame to frame; check the cables"};
}

/// The addresses that takt gives when it runs a machine, so that looking changes nothing.
void SegmentTool::Parts::address(std::size_t position) {
    const auto adp = static_cast<std::uint16_t>(0U - position);
    std::array<std::uint8_t, 2> station{};
    wire::store16(station, 0, stationOf(position));
    if (talk.ask({Command::Apwr, adp, reg::StationAddress, 2, station}).workingCounter != 1) {
        throw std::runtime_error{
            fmt::format("device {} does not take a station address", position)};
    }
}

void SegmentTool::Parts::identify(std::size_t position) {
    const std::uint16_t station = stationOf(position);
    // The EEPROM is lent from the device's processor and given back.
    const Reply owner = talk.ask(readRequest(station, reg::EepromConfiguration, 1));
    const std::array<std::uint8_t, 1> before{owner.served() ? owner.data[0] : std::uint8_t{0}};
    constexpr std::array<std::uint8_t, 1> force{2};
    constexpr std::array<std::uint8_t, 1> take{0};
    talk.ask(writeRequest(station, reg::EepromConfiguration, force));
    talk.ask(writeRequest(station, reg::EepromConfiguration, take));

    DeviceScan scan{station, DeviceScan::From::AnyState};
    std::array<AcyclicMachine*, 1> machines{&scan};
    AcyclicSlice slice{1};
    talk.run(slice, machines);
    if (scan.result() != DeviceScan::Result::Done) {
        throw std::runtime_error{fmt::format("device {} {}", position,
                                             scan.result() == DeviceScan::Result::EepromFailed
                                                 ? "has an EEPROM that cannot be read"
                                                 : "does not answer; check cable and power")};
    }
    const SiiNames names = SiiReader{talk, station}.names();
    const Reply alias = talk.ask(readRequest(station, reg::StationAlias, 2));
    const std::uint16_t aliasNumber =
        alias.served() ? wire::load16(alias.data, 0) : std::uint16_t{0};
    if ((before[0] & 1U) != 0) talk.ask(writeRequest(station, reg::EepromConfiguration, before));

    const ScannedDevice& found = scan.device();
    SegmentDevice device;
    device.position = static_cast<std::uint16_t>(position);
    device.station = station;
    device.alias = aliasNumber;
    device.identity = found.identity;
    device.order = names.order;
    device.name = names.name;
    device.clock = found.has(reg::FeatureDc);
    device.coe = (found.protocols & ProtocolCoe) != 0;
    device.openPorts = found.openPorts();
    device.mailboxOut = found.mailboxOut.size;
    device.mailboxIn = found.mailboxIn.size;
    devices.push_back(std::move(device));
    nodes.push_back(std::make_unique<Node>(found, station));
}

void SegmentTool::Parts::readState(std::size_t position) {
    Node& node = *nodes[position];
    node.agent.wantStatus();
    run(node);
    const AlReading& al = node.agent.al();
    SegmentDevice& device = devices[position];
    device.state = node.agent.answers() ? al.state : AlState::None;
    device.stateError = al.error;
    device.alStatusCode = al.code;
}

/// The way up: from one rung of the ladder to another one; the mailbox is set up on the way out of
/// INIT.
void SegmentTool::Parts::climb(Script& script, Node& node, std::size_t from, std::size_t to) {
    for (std::size_t i = from + 1; i <= to; ++i) {
        if (Ladder[i] == AlState::PreOp) {
            Script mailbox = makeMailboxScript(node.params);
            std::move(mailbox.begin(), mailbox.end(), std::back_inserter(script));
            script.emplace_back(RegisterStep{reg::EepromConfiguration, {1}, false});
        }
        script.emplace_back(
            StateStep{Ladder[i], timeoutFor(node.params.device->timeouts, Ladder[i])});
    }
}

bool SegmentTool::Parts::startMailbox(std::size_t position) {
    Node& node = *nodes[position];
    readState(position);
    if (rung(devices[position].state) > rung(AlState::PreOp)) return true;
    // Through INIT, so that the counters of both ends of the mailbox begin anew.
    node.script = {StateStep{AlState::Init, node.params.device->timeouts.backToInit}};
    climb(node.script, node, rung(AlState::Init), rung(AlState::PreOp));
    node.agent.run(node.script);
    run(node);
    const bool there = node.agent.scriptState() == SlaveAgent::ScriptState::Done;
    readState(position);
    return there;
}

core::ObjectReply SegmentTool::Parts::await(std::size_t position) {
    Node& node = *nodes[position];
    run(node);
    return node.agent.objects(ObjectUser::Operator).reply();
}

core::ObjectReply SegmentTool::Parts::ask(std::size_t position,
                                          const std::function<bool(CoeClient&)>& start) {
    Node& node = *nodes[position];
    CoeClient* const client = node.agent.objectsDirectly();
    if (client == nullptr || !startMailbox(position) || !start(*client)) {
        return {core::ObjectState::Failed, {}, wire::abortcode::WrongDeviceState};
    }
    node.slice.work().set(0);
    run(node);
    return client->reply();
}

SegmentTool::SegmentTool(wire::Link& link, core::ClockSource& clock)
    : parts_{std::make_unique<Parts>(link, clock)} {}

SegmentTool::~SegmentTool() = default;

const std::vector<SegmentDevice>& SegmentTool::scan() {
    parts_->nodes.clear();
    parts_->devices.clear();
    const std::size_t count = parts_->count();
    for (std::size_t i = 0; i < count; ++i) parts_->address(i);
    for (std::size_t i = 0; i < count; ++i) parts_->identify(i);
    return readStates();
}

const std::vector<SegmentDevice>& SegmentTool::readStates() {
    for (std::size_t i = 0; i < parts_->devices.size(); ++i) parts_->readState(i);
    return parts_->devices;
}

bool SegmentTool::toState(std::size_t position, wire::AlState target) {
    Node& node = *parts_->nodes[position];
    parts_->readState(position);
    const std::size_t from = rung(parts_->devices[position].state);
    const std::size_t to = rung(target);
    node.script.clear();
    if (to <= from) {
        node.script.emplace_back(
            StateStep{target, timeoutFor(node.params.device->timeouts, target)});
    } else {
        parts_->climb(node.script, node, from, to);
    }
    node.agent.run(node.script);
    parts_->run(node);
    const bool there = node.agent.scriptState() == SlaveAgent::ScriptState::Done;
    parts_->readState(position);
    return there;
}

core::ObjectReply SegmentTool::upload(std::size_t position, core::ObjectAddress address) {
    core::ObjectAccess& objects = parts_->nodes[position]->agent.objects(ObjectUser::Operator);
    if (!parts_->startMailbox(position) || !objects.startRead(address)) {
        return {core::ObjectState::Failed, {}, wire::abortcode::WrongDeviceState};
    }
    return parts_->await(position);
}

core::ObjectReply SegmentTool::download(std::size_t position, core::ObjectAddress address,
                                        const core::ObjectValue& value) {
    core::ObjectAccess& objects = parts_->nodes[position]->agent.objects(ObjectUser::Operator);
    if (!parts_->startMailbox(position) || !objects.startWrite(address, value)) {
        return {core::ObjectState::Failed, {}, wire::abortcode::WrongDeviceState};
    }
    return parts_->await(position);
}

core::ObjectReply SegmentTool::uploadLong(std::size_t position, core::ObjectAddress address,
                                          std::vector<std::uint8_t>& value) {
    std::vector<std::uint8_t> room(MostBytes);
    const core::ObjectReply reply =
        parts_->ask(position, [&](CoeClient& client) { return client.startRead(address, room); });
    if (reply.state != core::ObjectState::Done) return reply;
    room.resize(parts_->nodes[position]->agent.objectsDirectly()->length());
    value = std::move(room);
    return reply;
}

core::ObjectReply SegmentTool::downloadLong(std::size_t position, core::ObjectAddress address,
                                            std::span<const std::uint8_t> value) {
    return parts_->ask(position,
                       [&](CoeClient& client) { return client.startWrite(address, value); });
}

const std::vector<SegmentDevice>& SegmentTool::devices() const noexcept {
    return parts_->devices;
}

}  // namespace takt::fieldbus::ethercat
