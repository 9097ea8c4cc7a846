#include "dds_client.hpp"

#include <dds/dds.h>
#include <takt.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "bridged_takt.hpp"

namespace takt::test {

namespace {

constexpr std::uint32_t MostAtOnce = 64;
constexpr const char* Loopback = R"(<CycloneDDS><Domain id="any">
 <General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
  <AllowMulticast>false</AllowMulticast></General>
 <Discovery><ParticipantIndex>auto</ParticipantIndex>
  <MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
  <Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>)";

constexpr std::array<const char*, 10> Orders{"heartbeat", "leave",     "power-on", "power-off",
                                             "reset",     "home",      "inch",     "halt",
                                             "stop",      "reset-stop"};
constexpr std::array<const char*, 5> Kinds{"accepted", "refused", "done", "aborted", "failed"};
constexpr std::array<const char*, 8> States{
    "Disabled",         "Standstill",         "Homing",   "DiscreteMotion",
    "ContinuousMotion", "SynchronizedMotion", "Stopping", "ErrorStop"};

dds_entity_t must(dds_entity_t entity) {
    if (entity <= 0) throw std::runtime_error{dds_strretcode(entity)};
    return entity;
}

template <std::size_t N>
void put(char (&to)[N], const std::string& text) {
    std::strncpy(to, text.c_str(), N - 1);
}

}  // namespace

DdsClient::DdsClient(unsigned domain, std::string machine, std::uint64_t number)
    : machine_{std::move(machine)}, number_{number} {
    // One domain serves all clients of the process.
    domain_ = dds_create_domain(domain, Loopback);
    participant_ = must(dds_create_participant(domain, nullptr, nullptr));
    createReaders();
    createCommandDoor();
}

DdsClient::~DdsClient() {
    dds_delete(participant_);
    if (domain_ > 0) dds_delete(domain_);
}

void DdsClient::createReaders() {
    dds_qos_t* const qos = dds_create_qos();
    const auto reader = [this, qos](const dds_topic_descriptor_t& type, const char* name) {
        const Entity topic = must(dds_create_topic(participant_, &type, name, nullptr, nullptr));
        return must(dds_create_reader(participant_, topic, qos, nullptr));
    };
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, MostAtOnce);
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
    machineReader_ = reader(takt_dds_MachineStatus_desc, "takt/MachineStatus");
    axisReader_ = reader(takt_dds_AxisStatus_desc, "takt/AxisStatus");
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    replyReader_ = reader(takt_dds_CommandReply_desc, "takt/CommandReply");
    dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
    eventReader_ = reader(takt_dds_Event_desc, "takt/Event");
    dds_delete_qos(qos);
}

void DdsClient::createCommandDoor() {
    dds_qos_t* const qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
    const Entity topic = must(dds_create_topic(participant_, &takt_dds_AxisCommand_desc,
                                               "takt/AxisCommand", nullptr, nullptr));
    commandWriter_ = must(dds_create_writer(participant_, topic, qos, nullptr));
    dds_delete_qos(qos);
}

template <typename Sample, typename Take>
void DdsClient::take(Entity reader, Take take) {
    std::array<void*, MostAtOnce> samples{};
    std::array<dds_sample_info_t, MostAtOnce> infos{};
    for (dds_return_t count = 1; count > 0;) {
        samples[0] = nullptr;
        count = dds_take(reader, samples.data(), infos.data(), MostAtOnce, MostAtOnce);
        for (std::size_t i = 0; count > 0 && i < static_cast<std::size_t>(count); ++i) {
            const auto& sample = *static_cast<const Sample*>(samples[i]);
            if (infos[i].valid_data && sample.machine == machine_) take(sample, infos[i]);
        }
        if (count > 0) dds_return_loan(reader, samples.data(), count);
    }
}

void DdsClient::listen() {
    take<takt_dds_MachineStatus>(machineReader_, [this](const auto& status, const auto& info) {
        ++machineSamples_;
        lastWriter_ = info.publication_handle;
        operating_ = status.phase == takt_dds_PHASE_OPERATING;
    });
    take<takt_dds_AxisStatus>(axisReader_, [this](const auto& status, const auto&) {
        axes_[status.axis] = {status.cycle, States.at(static_cast<std::size_t>(status.state)),
                              status.actual_position, status.powered};
    });
    take<takt_dds_Event>(eventReader_, [this](const auto& event, const auto&) {
        events_[event.number] = event.text;
    });
    take<takt_dds_CommandReply>(replyReader_, [this](const auto& reply, const auto&) {
        if (reply.client != number_) return;
        replies_[reply.request].push_back(
            {Kinds.at(static_cast<std::size_t>(reply.kind)), reply.why});
    });
}

bool DdsClient::heardOf(const std::string& text) const {
    return std::any_of(events_.begin(), events_.end(), [&text](const auto& event) {
        return event.second.find(text) != std::string::npos;
    });
}

bool DdsClient::mayCommand() const {
    dds_publication_matched_status_t commands{};
    dds_subscription_matched_status_t replies{};
    dds_get_publication_matched_status(commandWriter_, &commands);
    dds_get_subscription_matched_status(replyReader_, &replies);
    return commands.current_count > 0 && replies.current_count > 0;
}

std::uint64_t DdsClient::send(const std::string& order, const std::string& axis, double distance,
                              double velocity) {
    takt_dds_AxisCommand command{};
    put(command.machine, machine_);
    put(command.axis, axis);
    put(command.who, "client " + std::to_string(number_));
    command.client = number_;
    command.request = ++lastRequest_;
    const auto found = std::find(Orders.begin(), Orders.end(), order);
    command.order = static_cast<takt_dds_CommandOrder>(found - Orders.begin());
    command.distance = distance;
    command.velocity = velocity;
    must(dds_write(commandWriter_, &command) == DDS_RETCODE_OK ? 1 : DDS_RETCODE_ERROR);
    return command.request;
}

std::vector<SeenReply> DdsClient::replies(std::uint64_t request) const {
    const auto found = replies_.find(request);
    return found == replies_.end() ? std::vector<SeenReply>{} : found->second;
}

std::optional<SeenReply> DdsClient::answer(std::uint64_t request, bool alive) {
    constexpr double longest = 5.0;
    std::optional<SeenReply> end;
    waitFor(
        [&] {
            if (alive) send("heartbeat");
            listen();
            const auto all = replies(request);
            if (!all.empty() && all.back().kind != "accepted") end = all.back();
            return end.has_value();
        },
        longest);
    return end;
}

}  // namespace takt::test
