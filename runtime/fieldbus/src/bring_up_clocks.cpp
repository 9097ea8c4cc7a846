// The part of bring-up that sets the clocks of the devices and arms SYNC0.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

#include "bring_up.hpp"

namespace takt::fieldbus::ethercat {

namespace {

namespace reg = wire::reg;
using wire::Command;

constexpr core::Duration LinkGap = std::chrono::milliseconds{10};

}  // namespace

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
        const Reply reply = talk_.ask(
            readRequest(stationOf(parts_.network, i), reg::DcReceiveTimePort0, readBytes));
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
            leadReference();
        }
    }
    writeClocks(latched, local, propagationDelays(ports));
}

/// The list may have another datagram hand the time round than the master would.
void BringUp::leadReference() {
    const std::uint16_t station = stationOf(parts_.network, referenceSlave_);
    const bool wide = found_[referenceSlave_].has(reg::FeatureDc64);
    for (const PlannedDatagram& datagram : parts_.plan.datagrams) {
        if (datagram.kind != CyclicCommand::Kind::ReferenceTime) continue;
        parts_.reference.lead(station, wide, datagram);
        if (!parts_.network.listed) continue;
        const auto address = static_cast<std::uint16_t>(datagram.address);
        const bool own = datagram.command == wire::Command::Armw
                             ? static_cast<std::uint16_t>(address + referenceSlave_) == 0
                             : address == station;
        if (own) continue;
        blame(referenceSlave_,
              "is the first with distributed clocks, but the list takes the time from another "
              "device");
    }
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
        const std::uint16_t station = stationOf(parts_.network, i);
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
            followers.push_back(stationOf(parts_.network, i));
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
        if (talk_.exchange() != wire::LinkStatus::Ok) talk_.pause(LinkGap);
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

}  // namespace takt::fieldbus::ethercat
