#include <algorithm>
#include <optional>
#include <takt/fieldbus/ethercat/master.hpp>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

#include "bring_up.hpp"
#include "cycle_plan.hpp"
#include "listed_script.hpp"
#include "messages.hpp"
#include "network_walk.hpp"

namespace takt::fieldbus::ethercat {

namespace {

constexpr std::size_t MostDatagramsInFrame = 128;
constexpr std::uint64_t MailboxLookGap = 8;  ///< cycles, for slaves without a mailbox state FMMU

}  // namespace

struct Master::Parts {
    Parts(const NetworkParams& params, wire::Link& wireLink, core::ClockSource& clockSource);

    void exchange(core::CycleNumber cycle) noexcept;
    void compose() noexcept;
    void append(std::size_t datagram) noexcept;
    [[nodiscard]] std::uint8_t sendState() const noexcept;
    void prepare() noexcept;
    void takeBus() noexcept;
    void takeMailboxStates() noexcept;
    void fetchMail(std::span<const std::uint8_t> states) noexcept;
    void lookIntoMailboxes() noexcept;
    [[nodiscard]] bool mapped() const noexcept;

    NetworkParams network;
    wire::Link& link;
    core::ClockSource& clock;
    BusTiming timing;
    LogicalLayout layout;
    CyclePlan plan;
    CommonScripts common;
    FrameSet frames;
    AcyclicSlice slice;
    SlaveParams nobody;  ///< in the place of a slave for commands to all
    SlaveAgent everyone;
    std::vector<std::unique_ptr<SlaveAgent>> agents;
    std::vector<AcyclicMachine*> machines;
    std::vector<SlaveScripts> scripts;
    std::vector<std::uint16_t> unmappedMailboxes;
    ProcessData data;
    ReferenceClock reference;
    NetworkWalk walk;

    BusReading reading{};
    bool referenceSent{false};
    std::optional<DatagramId> statusRead;
    std::optional<DatagramId> mailboxRead;
    std::uint8_t composedFor{0};
    core::HostTime now{};
    std::uint64_t cycles{0};
    bool prepared{false};
};

Master::Parts::Parts(const NetworkParams& params, wire::Link& wireLink,
                     core::ClockSource& clockSource)
    : network{params},
      link{wireLink},
      clock{clockSource},
      timing{computeTiming(network)},
      layout{makeLayout(network)},
      plan{makePlan(network, layout)},
      common{makeCommonScripts(network)},
      frames{plan.frames() + 1, plan.datagrams.size() + MostDatagramsInFrame},
      slice{network.slaves.size() + 1},
      everyone{nobody, 0, slice.work(), network.slaves.size()},
      data{plan},
      reference{network.cycle, timing.sync0AfterSend},
      walk{network, agents, scripts, everyone, common, data} {
    for (std::size_t i = 0; i < network.slaves.size(); ++i) {
        agents.push_back(std::make_unique<SlaveAgent>(network.slaves[i], stationOf(network, i),
                                                      slice.work(), i));
        machines.push_back(agents.back().get());
        scripts.push_back(makeScripts(network, i, layout));
        const auto number = static_cast<std::uint16_t>(i);
        const bool mapped = std::find(plan.mailboxSlave.begin(), plan.mailboxSlave.end(), number) !=
                            plan.mailboxSlave.end();
        if (!mapped && mailboxPlace(network.slaves[i])) unmappedMailboxes.push_back(number);
    }
    machines.push_back(&everyone);
}

/// FMMUs and process data SyncManagers are set up.
bool Master::Parts::mapped() const noexcept {
    return walk.state() != NetworkState::Off && walk.state() != NetworkState::Init;
}

/// The state by which listed datagrams are sent or not; on the way down it stays what it was.
std::uint8_t Master::Parts::sendState() const noexcept {
    switch (walk.state()) {
        case NetworkState::Off:
        case NetworkState::PreOp:
        case NetworkState::Init:
            return SentInPreOp;
        case NetworkState::GoingSafeOp:
        case NetworkState::SafeOp:
            return SentInSafeOp;
        case NetworkState::GoingOp:
        case NetworkState::Op:
            return SentInOp;
        case NetworkState::GoingDown:
        case NetworkState::Failed:
            return composedFor;
    }
    return composedFor;
}

/// Puts together once what goes out in every cycle, or again when another state wants other
/// datagrams.
void Master::Parts::compose() noexcept {
    composedFor = sendState();
    frames.begin();
    data.forgetDatagrams();
    referenceSent = false;
    statusRead.reset();
    mailboxRead.reset();
    std::uint32_t open = 0;  // frames opened so far
    for (std::size_t i = 0; i < plan.datagrams.size(); ++i) {
        const PlannedDatagram& datagram = plan.datagrams[i];
        if ((datagram.states & composedFor) == 0) continue;
        if (datagram.kind == CyclicCommand::Kind::ReferenceTime && !reference.present()) continue;
        if (open <= datagram.frame) {
            frames.openFrame();
            open = datagram.frame + 1U;
        }
        append(i);
    }
    frames.keep();
}

void Master::Parts::append(std::size_t datagram) noexcept {
    const PlannedDatagram& planned = plan.datagrams[datagram];
    const auto plain = [&] {
        return frames.appendLogical(planned.command, planned.address, planned.length);
    };
    switch (planned.kind) {
        case CyclicCommand::Kind::ReferenceTime:
            reference.append(frames);
            referenceSent = true;
            break;
        case CyclicCommand::Kind::ProcessData:
            data.append(frames, datagram);
            break;
        case CyclicCommand::Kind::MailboxStates:
            mailboxRead = plain();
            break;
        case CyclicCommand::Kind::AlStatus:
            statusRead = plain();
            break;
        case CyclicCommand::Kind::Other:
            plain();
            break;
    }
}

void Master::Parts::prepare() noexcept {
    if (plan.byState && sendState() != composedFor) {
        compose();
    } else {
        frames.repeat();
    }
    if (referenceSent) reference.fill(frames);
    data.fill(frames);
    if (!slice.idle()) slice.fill(frames, machines, timing.acyclicBytes, now);
    frames.finish();
    prepared = true;
}

void Master::Parts::exchange(core::CycleNumber cycle) noexcept {
    if (!prepared) prepare();
    prepared = false;
    ++cycles;
    const wire::LinkStatus status = frames.send(link);
    now = clock.now();
    if (status == wire::LinkStatus::Ok) frames.receive(link, now + timing.receiveDeadline);
    if (referenceSent) reference.take(frames);
    data.take(frames, walk.supervised());
    takeBus();
    if (!slice.idle()) slice.deliver(frames, machines, now);
    takeMailboxStates();
    walk.step(cycle, now, reading);
}

void Master::Parts::takeBus() noexcept {
    const Reply reply = statusRead ? frames.reply(*statusRead) : Reply{};
    reading.statusArrived = reply.arrived;
    reading.hasReference = reference.present();
    if (!reply.arrived) return;
    reading.status = wire::load16(reply.data, 0);
    reading.statusCounter = reply.workingCounter;
}

void Master::Parts::takeMailboxStates() noexcept {
    if (!mapped()) return;
    if (!unmappedMailboxes.empty()) lookIntoMailboxes();
    if (!mailboxRead) return;
    const Reply reply = frames.reply(*mailboxRead);
    if (!reply.served()) return;
    unsigned any = 0;
    for (const std::uint8_t byte : reply.data) any |= byte;
    if (any != 0) fetchMail(reply.data);
}

void Master::Parts::fetchMail(std::span<const std::uint8_t> states) noexcept {
    const std::size_t bits = std::min(plan.mailboxSlave.size(), 8 * states.size());
    for (std::size_t bit = 0; bit < bits; ++bit) {
        if ((states[bit / 8] >> (bit % 8) & 1U) == 0) continue;
        const std::uint16_t slave = plan.mailboxSlave[bit];
        if (slave != CyclePlan::NoSlave) agents[slave]->mailboxFull();
    }
}

void Master::Parts::lookIntoMailboxes() noexcept {
    for (std::size_t i = cycles % MailboxLookGap; i < unmappedMailboxes.size();
         i += MailboxLookGap) {
        agents[unmappedMailboxes[i]]->lookIntoMailbox();
    }
}

Master::Master(const NetworkParams& network, wire::Link& link, core::ClockSource& clock)
    : parts_{std::make_unique<Parts>(network, link, clock)} {}

Master::~Master() = default;

std::vector<BringUpProblem> Master::bringUp(const std::function<void(std::string_view)>& progress,
                                            const std::function<bool()>& goOn) {
    Parts& parts = *parts_;
    parts.walk.off();
    parts.prepared = false;
    parts.data.reset();
    Conversation talk{parts.frames, parts.link, parts.clock};
    BringUp bringUp{{parts.network, parts.layout, parts.plan, parts.slice, parts.machines,
                     parts.agents, parts.scripts, parts.everyone, parts.common, parts.reference},
                    talk,
                    progress,
                    goOn};
    std::vector<BringUpProblem> problems = bringUp.run();
    if (!problems.empty()) return problems;
    parts.walk.begin(bringUp.referenceSlave());
    parts.reading = {};
    parts.cycles = 0;
    parts.now = parts.clock.now();
    parts.compose();
    parts.prepare();
    parts.frames.resetCounters();
    return problems;
}

core::HostTime Master::firstSend(core::HostTime notBefore) const noexcept {
    return parts_->reference.gridSend(notBefore);
}

void Master::exchange(core::CycleNumber cycle) noexcept {
    // Without a configured network there is nothing that could be sent.
    if (state() != NetworkState::Off) parts_->exchange(cycle);
}
void Master::prepare() noexcept {
    if (state() != NetworkState::Off) parts_->prepare();
}
void Master::requestOp() noexcept {
    parts_->walk.requestOp();
}
void Master::requestInit() noexcept {
    parts_->walk.requestInit();
}
void Master::setClockLocked(bool locked) noexcept {
    parts_->reading.clockLocked = locked;
}
NetworkState Master::state() const noexcept {
    return parts_->walk.state();
}
const DcSample& Master::dcSample() const noexcept {
    return parts_->reference.sample();
}
const BusTiming& Master::timing() const noexcept {
    return parts_->timing;
}
core::DeviceImage Master::image(std::size_t slave) noexcept {
    return parts_->data.image(slave);
}
core::ObjectAccess& Master::objects(std::size_t slave, ObjectUser user) noexcept {
    return parts_->agents[slave]->objects(user);
}

DeviceState Master::deviceState(std::size_t slave) const noexcept {
    const SlaveAgent& agent = *parts_->agents[slave];
    const AlReading& al = agent.al();
    return {agent.answers(), al.state, al.error, al.code, agent.station()};
}

const EmergencyRecord& Master::lastEmergency(std::size_t slave) const noexcept {
    return parts_->agents[slave]->lastEmergency();
}

std::uint32_t Master::emergencies(std::size_t slave) const noexcept {
    return parts_->agents[slave]->emergencies();
}

CycleCounters Master::counters() const noexcept {
    const FrameCounters& frames = parts_->frames.counters();
    CycleCounters all;
    all.cycles = parts_->cycles;
    all.framesSent = frames.sent;
    all.framesLost = frames.lost;
    all.framesLate = frames.late;
    all.framesDuplicate = frames.duplicate;
    all.framesMalformed = frames.malformed;
    all.framesForeign = frames.foreign;
    all.sendFailures = frames.sendFailed;
    for (const GroupCounters& group : parts_->data.groups())
        all.workingCounterErrors += group.wrong;
    for (const auto& agent : parts_->agents) all.emergencies += agent->emergencies();
    return all;
}

std::span<const GroupCounters> Master::groups() const noexcept {
    return parts_->data.groups();
}

std::size_t Master::groupOf(std::size_t slave) const noexcept {
    return parts_->layout.slaves[slave].group;
}

std::uint16_t Master::expectedWorkingCounter() const noexcept {
    std::uint16_t sum = 0;
    for (const GroupCounters& group : parts_->data.groups()) {
        sum = static_cast<std::uint16_t>(sum + group.expected);
    }
    return sum;
}

const NetworkProblem& Master::problemRecord() const noexcept {
    return parts_->walk.problem();
}

std::string Master::problem() const {
    return explain(parts_->network, parts_->walk.problem());
}

std::string Master::explain(const NetworkParams& network, const NetworkProblem& problem) {
    return describe(network, problem);
}

}  // namespace takt::fieldbus::ethercat
