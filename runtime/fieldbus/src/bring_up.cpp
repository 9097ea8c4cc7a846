#include "bring_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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
    blame(slave, text, parts_.network.slaves[slave].origin);
}

void BringUp::blame(std::size_t slave, std::string_view text, const std::string& origin) {
    problems_.push_back({parts_.network.slaves[slave].name,
                         fmt::format("{}: {}", slaveLabel(parts_.network, slave), text), origin});
}

std::vector<BringUpProblem> BringUp::run() {
    using Stage = void (BringUp::*)();
    constexpr std::array<Stage, 10> worked{&BringUp::checkParams,    &BringUp::countDevices,
                                           &BringUp::resetDevices,   &BringUp::scan,
                                           &BringUp::compareDevices, &BringUp::measureClocks,
                                           &BringUp::configure,      &BringUp::writeObjects,
                                           &BringUp::settleClocks,   &BringUp::armSync};
    // A list clears the clocks of all devices on the way to PREOP, so they are measured behind it.
    constexpr std::array<Stage, 10> listed{&BringUp::checkParams,    &BringUp::countDevices,
                                           &BringUp::resetDevices,   &BringUp::scan,
                                           &BringUp::compareDevices, &BringUp::configure,
                                           &BringUp::measureClocks,  &BringUp::writeObjects,
                                           &BringUp::settleClocks,   &BringUp::armSync};
    for (const Stage stage : parts_.network.listed ? listed : worked) {
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
    for (std::size_t i = 0; i < network.slaves.size(); ++i) checkSlave(i);
}

void BringUp::checkSlave(std::size_t i) {
    const SlaveParams& slave = parts_.network.slaves[i];
    if (!slave.device) {
        blame(i, "has no device description");
        return;
    }
    if (parts_.network.listed && !slave.listed) {
        blame(i, "has no list of commands, as the other devices have");
        return;
    }
    if (slave.position != i) {
        blame(i, fmt::format("is configured for position {}; devices must be listed in frame "
                             "order",
                             slave.position));
    }
    for (const StartupObject& object : slave.startup) {
        if (!object.data.empty() && object.data.size() <= sizeof(core::ObjectValue::bytes))
            continue;
        blame(i, fmt::format("start-up object {:04X}h:{:02X} ({}) has {} bytes, allowed are 1 to 8",
                             object.index, object.subindex, object.origin, object.data.size()));
    }
    if (slave.watchdog.count() <= 0) {
        blame(i,
              "the process-data watchdog must not be off: outputs would stay on when the "
              "controller dies");
    }
    const bool objects = !slave.startup.empty() || !makePdoScript(slave).empty() ||
                         (slave.listed && !slave.listed->objects.empty());
    if (objects && !(slave.device->mailbox && slave.device->mailbox->coe)) {
        blame(i, "start-up objects or PDOs are to be written, but the device has no CoE mailbox");
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
        wire::store16(data, 0, stationOf(parts_.network, i));
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
        machines.push_back(&scans.emplace_back(stationOf(parts_.network, i)));
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

// --- PREOP
// -----------------------------------------------------------------------------------------------

void BringUp::configure() {
    constexpr auto up = static_cast<std::size_t>(Transition::InitToPreOp);
    say("configuring devices");
    for (const auto& agent : parts_.agents) agent->reset();
    parts_.everyone.reset();
    runCommon(parts_.common.before[up]);
    if (problems_.empty()) runScript(&SlaveScripts::toPreOp);
    if (problems_.empty()) runCommon(parts_.common.after[up]);
    if (problems_.empty()) say("all devices are in PREOP");
}

void BringUp::writeObjects() {
    runCommon(parts_.common.before[static_cast<std::size_t>(Transition::PreOpToSafeOp)]);
    if (problems_.empty()) runScript(&SlaveScripts::inPreOp);
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
        const Step* const step = agent.failedStep();
        if (step == nullptr) continue;
        const auto* const listed = std::get_if<CommandStep>(step);
        blame(i, describe(agent.failure(), *step),
              listed != nullptr ? listed->command.origin : parts_.network.slaves[i].origin);
    }
}

void BringUp::runCommon(const Script& script) {
    if (script.empty()) return;
    parts_.everyone.run(script);
    talk_.run(parts_.slice, parts_.machines);
    const Step* const step = parts_.everyone.failedStep();
    if (step == nullptr) return;
    problems_.push_back({{},
                         fmt::format("network: {}", describe(parts_.everyone.failure(), *step)),
                         std::get<CommandStep>(*step).command.origin});
}

}  // namespace takt::fieldbus::ethercat
