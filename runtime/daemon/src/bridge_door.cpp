#include "bridge_door.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace takt::daemon {

namespace {

using bridge::CommandOrder;

static_assert(static_cast<int>(CommandOrder::Heartbeat) == static_cast<int>(Order::Heartbeat));
static_assert(static_cast<int>(CommandOrder::Leave) == static_cast<int>(Order::Leave));
static_assert(static_cast<int>(CommandOrder::PowerOn) == static_cast<int>(Order::PowerOn));
static_assert(static_cast<int>(CommandOrder::Inch) == static_cast<int>(Order::Inch));
static_assert(static_cast<int>(CommandOrder::MachineStop) == static_cast<int>(Order::MachineStop));
static_assert(static_cast<int>(CommandOrder::ResetStop) == static_cast<int>(Order::ResetStop));
static_assert(static_cast<int>(bridge::ReplyKind::Failed) == static_cast<int>(ReplyKind::Failed));

bridge::StatusSetup setupOf(const config::MachineConfig& machine) {
    bridge::StatusSetup setup;
    setup.machine = machine.name;
    setup.cycle = machine.network.cycle;
    setup.dds = machine.bridge.dds;
    for (const axis::AxisParams& axis : machine.axes) setup.axes.push_back({axis.name, axis.unit});
    for (const axis::GroupParams& group : machine.groups)
        setup.groups.push_back({group.name, group.unit});
    return setup;
}

ControlRequest requestOf(const bridge::CommandRecord& record) {
    ControlRequest request;
    request.id = record.request;
    request.verb = name(static_cast<Order>(record.order));
    request.axis = bridge::view(record.axis);
    request.distance = record.distance;
    request.velocity = record.velocity;
    return request;
}

std::string nameOf(const bridge::CommandRecord& record) {
    const std::string_view who = bridge::view(record.who);
    return fmt::format("{} (DDS)", who.empty() ? "a client" : who);
}

}  // namespace

BridgeDoor::BridgeDoor(const config::MachineConfig& machine)
    : status_{setupOf(machine)},
      process_{bridgeExecutable(), {status_.descriptor(), commands_.descriptor()}},
      takesCommands_{machine.bridge.dds.commands},
      // A slow rate is no hanging.
      hangCycles_{std::max(static_cast<core::CycleNumber>(HangTime / machine.network.cycle),
                           core::CycleNumber{4} * machine.bridge.dds.everyCycles)} {}

std::string BridgeDoor::serve(CommandGate& gate, core::CycleNumber cycle) {
    bridge::CommandRecord record;
    for (std::size_t i = 0; i < MostCommands && commands_.next(record); ++i) take(record, gate);
    watchProgress(cycle);
    const pid_t before = process_.pid();
    switch (process_.supervise(commands_.published() > 0)) {
        case BridgeProcess::Change::None:
            return {};
        case BridgeProcess::Change::Started:
            progressCycle_ = cycle;
            return fmt::format("bridge started, process {}", process_.pid());
        case BridgeProcess::Change::Ended:
            break;
    }
    forgetAll(gate);
    commands_.reset();
    return fmt::format("bridge, process {}, {}", before, process_.lastEnd());
}

void BridgeDoor::take(const bridge::CommandRecord& record, CommandGate& gate) {
    auto remote = remotes_.find(record.writer);
    const bool known = remote != remotes_.end();
    if (record.order == CommandOrder::Leave) {
        if (!known) return;
        gate.leave(remote->second.client);
        remotes_.erase(remote);
        return;
    }
    if (record.order == CommandOrder::Heartbeat && !known) return;
    ControlReply refused{.id = record.request, .kind = ReplyKind::Refused};
    if (!takesCommands_) {
        refused.error = "commands are switched off in the machine file";
    } else if (!known && remotes_.size() >= MostClients) {
        refused.error = "too many clients";
    } else {
        if (!known) remote = remotes_.emplace(record.writer, Remote{gate.newClient(), 0}).first;
        remote->second.key = record.client;
        refused.error = gate.submit(remote->second.client, nameOf(record), requestOf(record));
    }
    if (!refused.error.empty()) reply(record.client, refused);
}

bool BridgeDoor::answer(CommandGate::Client client, const ControlReply& to) {
    const auto found = std::find_if(remotes_.begin(), remotes_.end(), [client](const auto& entry) {
        return entry.second.client == client;
    });
    if (found == remotes_.end()) return false;
    reply(found->second.key, to);
    return true;
}

void BridgeDoor::reply(std::uint64_t key, const ControlReply& reply) {
    bridge::ReplyRecord record{.client = key,
                               .request = reply.id,
                               .cycle = reply.cycle,
                               .kind = static_cast<bridge::ReplyKind>(reply.kind)};
    bridge::put(record.why, reply.error);
    status_.reply(record);
}

void BridgeDoor::tell(const EventReport& event) {
    bridge::EventRecord record{.number = event.number, .cycle = event.cycle};
    bridge::put(record.text, event.text);
    status_.event(record);
}

void BridgeDoor::watchProgress(core::CycleNumber cycle) {
    if (commands_.published() != progress_) progressCycle_ = cycle;
    progress_ = commands_.published();
    if (cycle - progressCycle_ <= hangCycles_) return;
    progressCycle_ = cycle;
    process_.abort();
}

/// With the process all that spoke through it are gone.
void BridgeDoor::forgetAll(CommandGate& gate) {
    for (const auto& [writer, remote] : remotes_) gate.leave(remote.client);
    remotes_.clear();
}

}  // namespace takt::daemon
