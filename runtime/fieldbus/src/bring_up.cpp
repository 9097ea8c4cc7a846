#include "bring_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <takt/wire/al_state.hpp>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/device_description.hpp>
#include <takt/wire/registers.hpp>

#include "messages.hpp"

namespace takt::fieldbus::ethercat {

namespace {

namespace reg = wire::reg;
using wire::Command;

constexpr core::Duration CountGap = std::chrono::milliseconds{10};
constexpr int CountTries = 20;

Request broadcastWrite(std::uint16_t address, std::span<const std::uint8_t> data) noexcept {
    return {Command::Bwr, 0, address, static_cast<std::uint16_t>(data.size()), data};
}

struct ResetWrite {
    std::uint16_t address;
    std::uint16_t length;
    std::uint16_t value;  ///< of the first two bytes; zeros follow
};

// Filter depths before the speed counter start: writing that one resets the control loop.
constexpr std::array ResetWrites{
    ResetWrite{reg::AlControl, 2, 0x0011},
    ResetWrite{reg::StationAddress, 2, 0},
    ResetWrite{reg::RxErrorCounter, 8, 0},
    ResetWrite{reg::LostLinkCounter, 4, 0},
    ResetWrite{reg::Fmmu, 256, 0},
    ResetWrite{reg::SyncManager, 128, 0},
    ResetWrite{reg::DcActivation, 1, 0},
    ResetWrite{reg::DcSystemTime, 32, 0},
    ResetWrite{reg::DcFilterDepth, 2, 0x0C00},
    ResetWrite{reg::DcSpeedCounterStart, 2, 0x1000},
    ResetWrite{reg::DlControl + 3, 1, 0},
    ResetWrite{reg::DlControl + 1, 1, 0},
    ResetWrite{reg::EcatEventMask, 2, 0x0004},
    ResetWrite{reg::EepromConfiguration, 1, 2},
    ResetWrite{reg::EepromConfiguration, 1, 0},
};

}  // namespace

BringUp::BringUp(const Parts& parts, Conversation& talk, const Progress& progress,
                 const std::function<bool()>& goOn)
    : parts_{parts}, talk_{talk}, progress_{progress}, goOn_{goOn} {}

void BringUp::say(std::string_view text) const {
    if (progress_) progress_(text);
}

void BringUp::blameNetwork(std::string text) {
    problems_.push_back({{}, std::move(text), {}});
}

void BringUp::blame(std::size_t slave, std::string_view text) {
    const SlaveParams& params = parts_.network.slaves[slave];
    problems_.push_back({params.name,
                         fmt::format("{}: {}", slaveLabel(parts_.network, slave), text),
                         params.origin});
}

std::vector<BringUpProblem> BringUp::run() {
    using Stage = void (BringUp::*)();
    constexpr std::array<Stage, 9> stages{
        &BringUp::checkParams, &BringUp::countDevices,   &BringUp::resetDevices,
        &BringUp::scan,        &BringUp::compareDevices, &BringUp::measureClocks,
        &BringUp::configure,   &BringUp::settleClocks,   &BringUp::armSync};
    for (const Stage stage : stages) {
        (this->*stage)();
        if (!problems_.empty()) break;
        if (!brokenOff()) continue;
        breakOff();
        break;
    }
    return std::move(problems_);
}

/// What has been set up so far is forgotten in INIT.
void BringUp::breakOff() {
    std::array<std::uint8_t, 2> init{};
    wire::store16(init, 0, static_cast<std::uint16_t>(wire::AlState::Init) | wire::AlErrorBit);
    talk_.ask(broadcastWrite(reg::AlControl, init));
    blameNetwork("network: the bring-up was broken off; all devices were sent to INIT");
}

void BringUp::checkParams() {
    const NetworkParams& network = parts_.network;
    if (network.slaves.empty()) blameNetwork("network: no devices are configured");
    if (network.cycle.count() <= 0) blameNetwork("network: the cycle time must be positive");
    if (!parts_.layout.fits) {
        blameNetwork(
            fmt::format("network: the process data of a device exceed one frame of {} "
                        "bytes; map fewer objects",
                        wire::MaxFrameSize));
    }
    for (std::size_t i = 0; i < network.slaves.size(); ++i) {
        const SlaveParams& slave = network.slaves[i];
        if (!slave.device) {
            blame(i, "has no device description");
            continue;
        }
        if (slave.position != i) {
            blame(i, fmt::format("is configured for position {}; devices must be listed in frame "
                                 "order",
                                 slave.position));
        }
        for (const StartupObject& object : slave.startup) {
            if (!object.data.empty() && object.data.size() <= sizeof(core::ObjectValue::bytes))
                continue;
            blame(i, fmt::format(
                         "start-up object {:04X}h:{:02X} ({}) has {} bytes, allowed are 1 to 8",
                         object.index, object.subindex, object.origin, object.data.size()));
        }
        if (slave.watchdog.count() <= 0) {
            blame(i,
                  "the process-data watchdog must not be off: outputs would stay on when the "
                  "controller dies");
        }
        const bool objects = !slave.startup.empty() || !makePdoScript(slave).empty();
        if (objects && !(slave.device->mailbox && slave.device->mailbox->coe)) {
            blame(i,
                  "start-up objects or PDOs are to be written, but the device has no CoE mailbox");
        }
    }
}

void BringUp::countDevices() {
    say("looking for devices");
    std::size_t before = 0;
    for (int i = 0; i < CountTries; ++i) {
        const Reply reply = talk_.ask({Command::Brd, 0, reg::AlStatus, 2, {}});
        count_ = reply.workingCounter;
        if (count_ != 0 && count_ == before) break;
        before = count_;
        talk_.pause(CountGap);
    }
    if (talk_.linkStatus() != wire::LinkStatus::Ok) {
        blameNetwork("network: the link is down; check the interface and the cable");
    } else if (count_ == 0) {
        blameNetwork("network: no device answers; check power and the cable to the first device");
    } else if (count_ != before) {
        blameNetwork(
            "network: the number of devices changes from frame to frame; check the cables");
    } else {
        say(fmt::format("{} devices answer", count_));
    }
}

void BringUp::resetDevices() {
    std::array<std::uint8_t, 256> data{};
    for (const ResetWrite& write : ResetWrites) {
        data.fill(0);
        wire::store16(data, 0, write.value);
        // A register that some device does not have is no reason to stop.
        talk_.ask(broadcastWrite(write.address, std::span{data}.first(write.length)));
    }
    assignAddresses();
}

void BringUp::assignAddresses() {
    for (std::size_t i = 0; i < count_; ++i) {
        std::array<std::uint8_t, 2> data{};
        wire::store16(data, 0, stationOf(i));
        const auto position = static_cast<std::uint16_t>(0U - i);
        const Reply reply = talk_.ask({Command::Apwr, position, reg::StationAddress, 2, data});
        if (reply.workingCounter != 1) {
            blameNetwork(
                fmt::format("{} does not take a station address", slaveLabel(parts_.network, i)));
        }
    }
}

void BringUp::scan() {
    std::vector<DeviceScan> scans;
    scans.reserve(count_);
    std::vector<AcyclicMachine*> machines;
    for (std::size_t i = 0; i < count_; ++i) {
        machines.push_back(&scans.emplace_back(stationOf(i)));
    }
    AcyclicSlice slice{count_};
    talk_.run(slice, machines);
    found_.clear();
    for (std::size_t i = 0; i < count_; ++i) {
        const std::string who = slaveLabel(parts_.network, i);
        switch (scans[i].result()) {
            case DeviceScan::Result::Done:
                break;
            case DeviceScan::Result::Busy:
            case DeviceScan::Result::Silent:
                blameNetwork(fmt::format("{} does not answer; check cable and power", who));
                break;
            case DeviceScan::Result::NotInInit:
                blameNetwork(fmt::format("{} does not go to INIT", who));
                break;
            case DeviceScan::Result::EepromFailed:
                blameNetwork(fmt::format("{}: its EEPROM cannot be read", who));
                break;
        }
        found_.push_back(scans[i].device());
    }
}

void BringUp::compareDevices() {
    const NetworkParams& network = parts_.network;
    const std::size_t expected = network.slaves.size();
    if (count_ != expected) {
        blameNetwork(fmt::format("network: expected {} devices, found {}", expected, count_));
    }
    for (std::size_t i = 0; i < std::max(expected, count_); ++i) {
        if (i >= count_) {
            blame(i, fmt::format("expected {}, found nothing",
                                 describe(network.slaves[i].device->identity)));
        } else if (i >= expected) {
            blameNetwork(fmt::format("slave {}: expected nothing, found {}", i,
                                     describe(found_[i].identity)));
        } else {
            for (const std::string& line : compare(network.slaves[i], found_[i])) blame(i, line);
        }
    }
    if (problems_.empty()) say("all devices are the configured ones");
}

// --- clocks
// ----------------------------------------------------------------------------------------------

bool BringUp::dcWanted() const {
    const auto& slaves = parts_.network.slaves;
    return std::any_of(slaves.begin(), slaves.end(),
                       [](const SlaveParams& slave) { return slave.dc.enabled; });
}

void BringUp::measureClocks() {
    parts_.reference.forget();
    if (!dcWanted()) return;
    constexpr std::uint16_t readBytes = 32;  // 0x0900 to 0x091F
    constexpr std::size_t unitTimeAt = reg::DcReceiveTimeUnit - reg::DcReceiveTimePort0;
    talk_.ask({Command::Bwr, 0, reg::DcReceiveTimePort0, 4, {}});
    const core::HostTime latched = talk_.frames().sentAt();
    std::vector<PortTimes> ports(count_);
    std::vector<std::uint64_t> local(count_, 0);
    for (std::size_t i = 0; i < count_; ++i) {
        ports[i].openPorts = found_[i].openPorts();
        ports[i].dc = found_[i].has(reg::FeatureDc);
        if (!ports[i].dc) continue;
        const Reply reply =
            talk_.ask(readRequest(stationOf(i), reg::DcReceiveTimePort0, readBytes));
        if (!reply.served()) {
            blame(i, "its receive times cannot be read");
            return;
        }
        for (std::size_t port = 0; port < 4; ++port)
            ports[i].at[port] = wire::load32(reply.data, 4 * port);
        local[i] = found_[i].has(reg::FeatureDc64)
                       ? wire::load64(reply.data, unitTimeAt)
                       : std::uint64_t{wire::load32(reply.data, unitTimeAt)};
        if (!parts_.reference.present()) {
            referenceSlave_ = i;
            parts_.reference.lead(stationOf(i), found_[i].has(reg::FeatureDc64));
        }
    }
    writeClocks(latched, local, propagationDelays(ports));
}

void BringUp::writeClocks(core::HostTime latched, std::span<const std::uint64_t> local,
                          std::span<const std::uint32_t> delays) {
    const auto reference =
        static_cast<std::uint64_t>((latched.time_since_epoch() + DcEpoch).count());
    for (std::size_t i = 0; i < count_; ++i) {
        if (!found_[i].has(reg::FeatureDc)) continue;
        // Offset and delay lie side by side: 0x0920 with eight, 0x0928 with four bytes.
        std::array<std::uint8_t, 12> data{};
        std::uint64_t offset = reference + delays[i] - local[i];
        if (!found_[i].has(reg::FeatureDc64)) offset &= 0xFFFF'FFFFU;
        wire::store64(data, 0, offset);
        wire::store32(data, 8, delays[i]);
        std::array<std::uint8_t, 2> speed{};
        wire::store16(speed, 0, 0x1000);
        const std::uint16_t station = stationOf(i);
        const bool written =
            talk_.ask(writeRequest(station, reg::DcSystemTimeOffset, data)).served() &&
            talk_.ask(writeRequest(station, reg::DcSpeedCounterStart, speed)).served();
        if (!written) blame(i, "does not take its clock offset");
    }
}

/// Hands the reference time round until all clocks follow it. Clocks that do not settle are no
/// problem yet: OP waits for them.
void BringUp::settleClocks() {
    if (!parts_.reference.present()) return;
    constexpr std::size_t atOnce = 64;
    constexpr std::uint32_t quietFrames = 100;
    std::vector<std::uint16_t> followers;
    for (std::size_t i = 0; i < count_; ++i) {
        if (found_[i].has(reg::FeatureDc) && i != referenceSlave_)
            followers.push_back(stationOf(i));
    }
    FrameSet& frames = talk_.frames();
    std::vector<DatagramId> reads;
    const std::size_t rounds = std::max<std::size_t>(1, (followers.size() + atOnce - 1) / atOnce);
    std::size_t quiet = 0;
    std::uint32_t sent = 0;
    for (; sent < parts_.network.dcDriftFrames && quiet < quietFrames * rounds; ++sent) {
        if (brokenOff()) return;
        frames.begin();
        frames.openFrame();
        parts_.reference.append(frames);
        reads.clear();
        const std::size_t from = sent % rounds * atOnce;
        for (std::size_t i = from; i < std::min(from + atOnce, followers.size()); ++i) {
            reads.push_back(
                frames.append(Command::Fprd, followers[i], reg::DcSystemTimeDifference, 4));
        }
        if (talk_.exchange() != wire::LinkStatus::Ok) talk_.pause(CountGap);
        parts_.reference.take(frames);
        const bool below = std::all_of(reads.begin(), reads.end(), [&](DatagramId id) {
            const Reply reply = frames.reply(id);
            return reply.served() && core::Duration{wire::load32(reply.data, 0) & 0x7FFF'FFFFU} <
                                         parts_.network.dcLimit;
        });
        quiet = below && parts_.reference.sample().valid ? quiet + 1 : 0;
    }
    say(fmt::format("clocks: {} drift frames{}", sent,
                    quiet < quietFrames * rounds ? ", not settled yet" : ""));
    // Where the host stands against the reference is needed even when no drift frames are wanted.
    for (int i = 0; i < 10 && !parts_.reference.sample().valid; ++i) {
        frames.begin();
        frames.openFrame();
        parts_.reference.append(frames);
        talk_.exchange();
        parts_.reference.take(frames);
    }
    if (!parts_.reference.sample().valid) blame(referenceSlave_, "its clock cannot be read");
}

void BringUp::armSync() {
    if (!parts_.reference.present()) return;
    constexpr core::Duration lead = std::chrono::milliseconds{100};
    const NetworkParams& network = parts_.network;
    std::int64_t grid = network.cycle.count();
    for (const SlaveParams& slave : network.slaves) {
        if (slave.dc.enabled) grid = std::lcm(grid, sync0Cycle(network, slave).count());
    }
    const core::DcTime now = parts_.reference.sample().referenceTime;
    const core::DcTime start = gridAtOrAfter(now + lead, core::Duration{grid});
    for (std::size_t i = 0; i < parts_.scripts.size(); ++i) {
        setSyncStart(parts_.scripts[i].armSync, network.slaves[i], start);
    }
    runScript(&SlaveScripts::armSync);
}

// --- PREOP
// -----------------------------------------------------------------------------------------------

void BringUp::configure() {
    say("configuring devices");
    for (const auto& agent : parts_.agents) agent->reset();
    runScript(&SlaveScripts::toPreOp);
    if (problems_.empty()) say("all devices are in PREOP");
}

void BringUp::runScript(Script SlaveScripts::*script) {
    for (std::size_t i = 0; i < parts_.agents.size(); ++i) {
        parts_.agents[i]->run(parts_.scripts[i].*script);
    }
    talk_.run(parts_.slice, parts_.machines);
    for (std::size_t i = 0; i < parts_.agents.size(); ++i) {
        const SlaveAgent& agent = *parts_.agents[i];
        for (const ScriptNote& note : agent.notes()) {
            say(fmt::format("{}: {}", slaveLabel(parts_.network, i), describe(note)));
        }
        if (const Step* step = agent.failedStep()) blame(i, describe(agent.failure(), *step));
    }
}

}  // namespace takt::fieldbus::ethercat
