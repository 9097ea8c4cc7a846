#include "process_data.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace takt::fieldbus::ethercat {

ProcessData::ProcessData(const CyclePlan& plan)
    : plan_{plan},
      places_(plan.datagrams.size()),
      good_(plan.groups.size(), 0),
      outputs_(plan.outputBytes),
      inputs_(plan.inputBytes),
      health_(plan.slaves.size()),
      counters_(plan.groups.size()) {
    for (std::size_t i = 0; i < counters_.size(); ++i) {
        counters_[i].expected = plan.groups[i].expected;
    }
}

void ProcessData::reset() noexcept {
    std::fill(outputs_.begin(), outputs_.end(), std::uint8_t{0});
    std::fill(inputs_.begin(), inputs_.end(), std::uint8_t{0});
    std::fill(health_.begin(), health_.end(), core::DeviceHealth{});
    for (GroupCounters& counters : counters_) {
        counters.lastSeen = 0;
        counters.wrong = counters.lost = 0;
    }
    std::fill(good_.begin(), good_.end(), std::uint8_t{0});
    allGood_ = wrongCounter_ = false;
}

core::DeviceImage ProcessData::image(std::size_t slave) noexcept {
    const PlannedShare& share = plan_.slaves[slave];
    return {std::span{inputs_}.subspan(share.inputAt, share.inputBytes),
            std::span{outputs_}.subspan(share.outputAt, share.outputBytes), &health_[slave]};
}

void ProcessData::setOperational(std::size_t slave, bool operational,
                                 std::uint16_t alCode) noexcept {
    health_[slave].operational = operational;
    health_[slave].alStatusCode = alCode;
}

void ProcessData::forgetDatagrams() noexcept {
    for (Place& place : places_) place.sent = false;
}

void ProcessData::append(FrameSet& frames, std::size_t datagram) noexcept {
    const PlannedDatagram& planned = plan_.datagrams[datagram];
    places_[datagram] = {frames.appendLogical(planned.command, planned.address, planned.length),
                         true};
}

void ProcessData::fill(FrameSet& frames) noexcept {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const PlannedDatagram& planned = plan_.datagrams[i];
        if (planned.outputBytes == 0 || !places_[i].sent) continue;
        std::memcpy(frames.data(places_[i].id).data(), &outputs_[planned.outputAt],
                    planned.outputBytes);
    }
}

ProcessData::Outcome ProcessData::judge(const FrameSet& frames, std::size_t group) noexcept {
    const PlannedGroup& planned = plan_.groups[group];
    std::uint16_t seen = 0;
    bool right = true;
    for (std::size_t i = planned.first; i < std::size_t{planned.first} + planned.count; ++i) {
        if (!places_[i].sent) return Outcome::NotSent;
        const Reply reply = frames.reply(places_[i].id);
        // All datagrams of a group travel in the same frame.
        if (!reply.arrived) return Outcome::Lost;
        seen = static_cast<std::uint16_t>(seen + reply.workingCounter);
        right = right && reply.workingCounter == plan_.datagrams[i].expected;
    }
    counters_[group].lastSeen = seen;
    return right ? Outcome::Right : Outcome::Wrong;
}

void ProcessData::takeInputs(const FrameSet& frames, std::size_t group) noexcept {
    const PlannedGroup& planned = plan_.groups[group];
    for (std::size_t i = planned.first; i < std::size_t{planned.first} + planned.count; ++i) {
        const PlannedDatagram& datagram = plan_.datagrams[i];
        if (datagram.inputBytes == 0) continue;
        std::memcpy(&inputs_[datagram.inputAt],
                    frames.reply(places_[i].id).data.data() + datagram.inputFrom,
                    datagram.inputBytes);
    }
}

void ProcessData::take(const FrameSet& frames, bool supervised) noexcept {
    const bool wereGood = allGood_;
    allGood_ = true;
    wrongCounter_ = false;
    for (std::size_t i = 0; i < good_.size(); ++i) {
        const Outcome outcome = judge(frames, i);
        good_[i] = outcome == Outcome::Right ? 1 : 0;
        if (outcome == Outcome::Right) {
            takeInputs(frames, i);
            continue;
        }
        allGood_ = false;
        if (outcome == Outcome::Lost) {
            ++counters_[i].lost;
        } else if (outcome == Outcome::Wrong && supervised) {
            wrongCounter_ = true;
            ++counters_[i].wrong;
        }
    }
    if (!allGood_ || !wereGood) markSlaves();
}

void ProcessData::markSlaves() noexcept {
    for (std::size_t i = 0; i < health_.size(); ++i) {
        const PlannedShare& share = plan_.slaves[i];
        core::DeviceHealth& health = health_[i];
        health.inputsFresh = good_[share.outputGroup] != 0 && good_[share.inputGroup] != 0;
        if (health.inputsFresh) {
            health.lostInRow = 0;
        } else if (health.lostInRow != std::numeric_limits<std::uint32_t>::max()) {
            ++health.lostInRow;
        }
    }
}

}  // namespace takt::fieldbus::ethercat
