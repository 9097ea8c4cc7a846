/// Prints the status of every axis as it comes from DDS, as CSV, and events to the standard error
/// output. A process of its own: all it knows of takt is the IDL file that is installed with it.
///
///     dds_subscriber DOMAIN [SECONDS]
///
/// SECONDS are those of the machine, counted in cycles from the first sample on; without them it
/// goes on for ever.
#include <dds/dds.h>
#include <takt.h>

#include <array>
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

namespace {

constexpr std::uint32_t MostAtOnce = 256;
constexpr double Nanoseconds = 1e9;

/// This computer only, without multicast: it works with no network at all.
constexpr const char* Loopback = R"(<CycloneDDS><Domain id="any">
 <General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
  <AllowMulticast>false</AllowMulticast></General>
 <Discovery><ParticipantIndex>auto</ParticipantIndex>
  <MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
  <Peers><Peer address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>)";

constexpr std::array<const char*, 8> StateNames{
    "Disabled",         "Standstill",         "Homing",   "DiscreteMotion",
    "ContinuousMotion", "SynchronizedMotion", "Stopping", "ErrorStop"};

dds_entity_t must(dds_entity_t entity, const char* what) {
    if (entity > 0) return entity;
    std::fprintf(stderr, "%s: %s\n", what, dds_strretcode(entity));
    std::exit(2);
}

/// Takes the samples that have come and shows each one that is whole.
template <typename Sample, typename Show>
void take(dds_entity_t reader, Show show) {
    std::array<void*, MostAtOnce> samples{};  // the first one null: they are lent
    std::array<dds_sample_info_t, MostAtOnce> infos{};
    const dds_return_t count =
        dds_take(reader, samples.data(), infos.data(), MostAtOnce, MostAtOnce);
    for (std::size_t i = 0; count > 0 && i < static_cast<std::size_t>(count); ++i) {
        if (infos[i].valid_data) show(*static_cast<const Sample*>(samples[i]));
    }
    if (count > 0) dds_return_loan(reader, samples.data(), count);
}

class Subscriber {
public:
    Subscriber(dds_domainid_t domain, double seconds) : seconds_{seconds} {
        must(dds_create_domain(domain, Loopback), "domain");
        participant_ = must(dds_create_participant(domain, nullptr, nullptr), "participant");
        dds_qos_t* const qos = dds_create_qos();
        dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, MostAtOnce);
        dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
        axes_ = reader(takt_dds_AxisStatus_desc, "takt/AxisStatus", qos);
        dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
        dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
        events_ = reader(takt_dds_Event_desc, "takt/Event", qos);
        dds_delete_qos(qos);
        waitset_ = must(dds_create_waitset(participant_), "waitset");
        for (const dds_entity_t entity : {axes_, events_}) {
            dds_set_status_mask(entity, DDS_DATA_AVAILABLE_STATUS);
            dds_waitset_attach(waitset_, entity, entity);
        }
    }
    ~Subscriber() { dds_delete(participant_); }
    Subscriber(const Subscriber&) = delete;
    Subscriber& operator=(const Subscriber&) = delete;

    void run() {
        std::puts("machine,axis,cycle,time_ns,state,set,actual,velocity,lag");
        while (!over_) {
            dds_waitset_wait(waitset_, nullptr, 0, DDS_SECS(1));
            take<takt_dds_AxisStatus>(axes_, [this](const auto& status) { show(status); });
            take<takt_dds_Event>(events_, [this](const auto& event) { show(event); });
            std::fflush(stdout);
        }
    }

private:
    dds_entity_t reader(const dds_topic_descriptor_t& type, const char* name,
                        const dds_qos_t* qos) {
        const dds_entity_t topic =
            must(dds_create_topic(participant_, &type, name, nullptr, nullptr), name);
        return must(dds_create_reader(participant_, topic, qos, nullptr), name);
    }

    void show(const takt_dds_AxisStatus& status) {
        if (first_ < 0) first_ = status.time_ns;
        const double since = static_cast<double>(status.time_ns - first_) / Nanoseconds;
        over_ = over_ || (seconds_ > 0 && since >= seconds_);
        std::printf("%s,%s,%" PRIu64 ",%" PRId64 ",%s,%.6f,%.6f,%.6f,%.6f\n", status.machine,
                    status.axis, status.cycle, status.time_ns,
                    StateNames[static_cast<std::size_t>(status.state) % StateNames.size()],
                    status.set_position, status.actual_position, status.actual_velocity,
                    status.lag);
    }

    /// A bridge that was started anew tells its events again.
    void show(const takt_dds_Event& event) {
        std::uint64_t& last = lastEvent_[event.machine];
        if (event.number <= last) return;
        last = event.number;
        std::fprintf(stderr, "%s cycle %" PRIu64 ": %s\n", event.machine, event.cycle, event.text);
    }

    double seconds_;
    dds_entity_t participant_{0};
    dds_entity_t axes_{0};
    dds_entity_t events_{0};
    dds_entity_t waitset_{0};
    std::int64_t first_{-1};
    bool over_{false};
    std::map<std::string, std::uint64_t> lastEvent_;
};

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 3) {
        std::fputs("usage: dds_subscriber DOMAIN [SECONDS]\n", stderr);
        return 2;
    }
    const double seconds = argc == 3 ? std::strtod(argv[2], nullptr) : 0.0;
    Subscriber{static_cast<dds_domainid_t>(std::strtoul(argv[1], nullptr, 10)), seconds}.run();
    return 0;
}
