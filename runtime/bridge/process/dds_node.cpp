#include "dds_node.hpp"

#include <dds/dds.h>
#include <takt.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace takt::bridge {

namespace {

constexpr std::uint32_t MostCommands = 32;  ///< at once
constexpr std::int32_t CommandHistory = 64;
/// A subscriber that does not follow must not keep the others from their status for longer.
constexpr dds_duration_t MostBlocking = DDS_MSECS(10);

static_assert(static_cast<int>(MachinePhase::Over) == takt_dds_PHASE_OVER);
static_assert(static_cast<int>(NetworkState::Failed) == takt_dds_NETWORK_FAILED);
static_assert(static_cast<int>(StopCause::ProgramFault) == takt_dds_STOP_PROGRAM_FAULT);
static_assert(static_cast<int>(AxisState::ErrorStop) == takt_dds_AXIS_ERROR_STOP);
static_assert(static_cast<int>(GroupState::ErrorStop) == takt_dds_GROUP_ERROR_STOP);
static_assert(static_cast<int>(CommandOrder::ResetStop) == takt_dds_ORDER_RESET_STOP);
static_assert(static_cast<int>(ReplyKind::Failed) == takt_dds_REPLY_FAILED);

struct QosDeleter {
    void operator()(dds_qos_t* qos) const noexcept { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

Qos reliable(std::int32_t depth) {
    Qos qos{dds_create_qos()};
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, MostBlocking);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
    return qos;
}

/// Cyclone takes the first network card and multicasts on it unless it is told otherwise.
std::string configuration(std::string_view interface) {
    const bool loopback = interface == "lo";
    const std::string multicast = loopback ? R"( multicast="false")" : "";
    return R"(<CycloneDDS><Domain id="any"><General><Interfaces><NetworkInterface name=")" +
           std::string{interface} + '"' + multicast + "/></Interfaces><AllowMulticast>" +
           (loopback ? "false" : "spdp") +
           "</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
           "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
           "<LeaseDuration>5s</LeaseDuration><SPDPInterval>1s</SPDPInterval>" +
           (loopback ? R"(<Peers><Peer address="127.0.0.1"/></Peers>)" : "") +
           "</Discovery></Domain></CycloneDDS>";
}

/// \pre both have room for the same text
template <std::size_t N, std::size_t M>
void copy(const Text<N>& from, char (&to)[M]) noexcept {  // NOLINT: the generated type
    static_assert(N == M);
    std::copy(from.begin(), from.end(), to);
}
template <std::size_t N, std::size_t M>
void copy(const char (&from)[M], Text<N>& to) noexcept {  // NOLINT: the generated type
    static_assert(N == M);
    std::copy(from, from + M, to.begin());
}

template <typename To, typename From>
To as(From value) noexcept {
    return static_cast<To>(static_cast<std::underlying_type_t<From>>(value));
}

}  // namespace

DdsNode::DdsNode(const StatusHeader& header, std::span<const MemberInfo> axes,
                 std::span<const MemberInfo> groups)
    : header_{header}, axes_{axes}, groups_{groups} {
    createDomain();
    createStatusWriters();
    createEventWriter();
    if (header_.commands) createCommandDoor();
}

DdsNode::~DdsNode() {
    if (domain_ > 0) dds_delete(domain_);
}

DdsNode::Entity DdsNode::create(Entity entity, const char* what) {
    if (entity > 0) return entity;
    const std::string cause = dds_strretcode(entity);
    if (domain_ > 0) dds_delete(domain_);
    throw std::runtime_error{"DDS domain " + std::to_string(header_.domain) + " on interface '" +
                             std::string{view(header_.interface)} + "': no " + what + ": " + cause};
}

void DdsNode::createDomain() {
    const std::string text = configuration(view(header_.interface));
    domain_ = create(dds_create_domain(header_.domain, text.c_str()), "domain");
    participant_ = create(dds_create_participant(header_.domain, nullptr, nullptr), "participant");
}

void DdsNode::createStatusWriters() {
    const Qos qos{dds_create_qos()};
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
    const auto writer = [this, &qos](const dds_topic_descriptor_t& type, const char* name) {
        const Entity topic =
            create(dds_create_topic(participant_, &type, name, nullptr, nullptr), name);
        return create(dds_create_writer(participant_, topic, qos.get(), nullptr), name);
    };
    // The axes of a cycle go into few packets; flush() sends them.
    dds_write_set_batch(true);
    axisWriter_ = writer(takt_dds_AxisStatus_desc, "takt/AxisStatus");
    groupWriter_ = writer(takt_dds_GroupStatus_desc, "takt/GroupStatus");
    dds_write_set_batch(false);
    machineWriter_ = writer(takt_dds_MachineStatus_desc, "takt/MachineStatus");
}

void DdsNode::createEventWriter() {
    const char* const name = "takt/Event";
    const Entity topic =
        create(dds_create_topic(participant_, &takt_dds_Event_desc, name, nullptr, nullptr), name);
    const Qos qos = reliable(EventDepth);
    dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, EventDepth,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    eventWriter_ = create(dds_create_writer(participant_, topic, qos.get(), nullptr), name);
}

void DdsNode::createCommandDoor() {
    const Entity commands = create(dds_create_topic(participant_, &takt_dds_AxisCommand_desc,
                                                    "takt/AxisCommand", nullptr, nullptr),
                                   "takt/AxisCommand");
    const Entity replies = create(dds_create_topic(participant_, &takt_dds_CommandReply_desc,
                                                   "takt/CommandReply", nullptr, nullptr),
                                  "takt/CommandReply");
    const Qos qos = reliable(CommandHistory);
    replyWriter_ =
        create(dds_create_writer(participant_, replies, qos.get(), nullptr), "takt/CommandReply");
    commandReader_ =
        create(dds_create_reader(participant_, commands, qos.get(), nullptr), "takt/AxisCommand");
}

void DdsNode::publish(const MachineSample& sample) {
    takt_dds_MachineStatus status{};
    copy(header_.machine, status.machine);
    status.cycle = sample.cycle;
    status.time_ns = timeOf(sample.cycle);
    status.cycle_ns = header_.cycleNs;
    status.period_cycles = header_.everyCycles;
    status.phase = as<takt_dds_MachinePhase>(sample.phase);
    status.network = as<takt_dds_NetworkState>(sample.network);
    status.stop = as<takt_dds_StopCause>(sample.stop);
    status.commands = header_.commands;
    status.axes = header_.axes;
    status.groups = header_.groups;
    status.frames_sent = sample.framesSent;
    status.frames_lost = sample.framesLost;
    status.frames_late = sample.framesLate;
    status.working_counter_errors = sample.workingCounterErrors;
    dds_write(machineWriter_, &status);
}

void DdsNode::publishAxis(std::size_t index, const AxisSample& sample) {
    takt_dds_AxisStatus status{};
    copy(header_.machine, status.machine);
    copy(axes_[index].name, status.axis);
    copy(axes_[index].unit, status.unit);
    status.cycle = sample.cycle;
    status.time_ns = timeOf(sample.cycle);
    status.state = as<takt_dds_AxisState>(sample.state);
    status.powered = sample.powered;
    status.homed = sample.homed;
    status.set_position = sample.set;
    status.set_velocity = sample.setVelocity;
    status.set_acceleration = sample.setAcceleration;
    status.actual_position = sample.actual;
    status.actual_velocity = sample.actualVelocity;
    status.lag = sample.lag;
    status.error = sample.error;
    status.drive_error = sample.driveError;
    status.controlword = sample.controlword;
    status.statusword = sample.statusword;
    status.mode =
        static_cast<std::int16_t>(sample.mode);  // NOLINT(bugprone-signed-char-misuse): a number
    dds_write(axisWriter_, &status);
}

void DdsNode::publishGroup(std::size_t index, const GroupSample& sample) {
    takt_dds_GroupStatus status{};
    copy(header_.machine, status.machine);
    copy(groups_[index].name, status.group);
    copy(groups_[index].unit, status.unit);
    status.cycle = sample.cycle;
    status.time_ns = timeOf(sample.cycle);
    status.state = as<takt_dds_GroupState>(sample.state);
    status.path_velocity = sample.pathVelocity;
    status.error = sample.error;
    dds_write(groupWriter_, &status);
}

void DdsNode::flush() {
    dds_write_flush(axisWriter_);
    dds_write_flush(groupWriter_);
}

bool DdsNode::publish(const EventRecord& event) {
    takt_dds_Event sample{};
    copy(header_.machine, sample.machine);
    copy(event.text, sample.text);
    sample.number = event.number;
    sample.cycle = event.cycle;
    sample.time_ns = timeOf(event.cycle);
    return dds_write(eventWriter_, &sample) != DDS_RETCODE_TIMEOUT;
}

bool DdsNode::publish(const ReplyRecord& reply) {
    takt_dds_CommandReply sample{};
    copy(header_.machine, sample.machine);
    copy(reply.why, sample.why);
    sample.client = reply.client;
    sample.request = reply.request;
    sample.cycle = reply.cycle;
    sample.kind = as<takt_dds_ReplyKind>(reply.kind);
    return dds_write(replyWriter_, &sample) != DDS_RETCODE_TIMEOUT;
}

std::span<const CommandRecord> DdsNode::takeCommands() {
    commands_.clear();
    if (commandReader_ == 0) return commands_;
    std::array<void*, MostCommands> samples{};  // the first one null: Cyclone lends its own
    std::array<dds_sample_info_t, MostCommands> infos{};
    const dds_return_t count =
        dds_take(commandReader_, samples.data(), infos.data(), MostCommands, MostCommands);
    for (std::size_t i = 0; count > 0 && i < static_cast<std::size_t>(count); ++i) {
        const auto& from = *static_cast<const takt_dds_AxisCommand*>(samples[i]);
        // The key is there even when only the end of a writer is told.
        Name machine;
        copy(from.machine, machine);
        if (view(machine) != view(header_.machine)) continue;
        CommandRecord command;
        command.writer = infos[i].publication_handle;
        command.client = from.client;
        if (infos[i].valid_data) {
            command.request = from.request;
            command.order = static_cast<CommandOrder>(from.order);
            command.distance = from.distance;
            command.velocity = from.velocity;
            copy(from.axis, command.axis);
            copy(from.who, command.who);
        } else {
            command.order = CommandOrder::Leave;
        }
        commands_.push_back(command);
    }
    if (count > 0) dds_return_loan(commandReader_, samples.data(), count);
    return commands_;
}

}  // namespace takt::bridge
