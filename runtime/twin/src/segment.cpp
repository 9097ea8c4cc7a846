#include "segment.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace takt::twin {

namespace {

constexpr std::int64_t NanosecondsPerByte = 80;  // 100 Mbit/s

// First bit of the preamble to last bit of the check sequence; then the gap until the next frame
// may start.
core::Duration wireTime(std::size_t frameSize) noexcept {
    constexpr std::size_t gap = 12;
    return core::Duration{static_cast<std::int64_t>(wire::wireBytes(frameSize) - gap) *
                          NanosecondsPerByte};
}
constexpr core::Duration InterFrameGap{12 * NanosecondsPerByte};

}  // namespace

Segment::Segment(const TwinParams& params,
                 std::vector<std::shared_ptr<const wire::DeviceDescription>> devices,
                 core::Duration cycle)
    : events_{params.devices.size()}, descriptions_{std::move(devices)}, frames_(MaxFrames) {
    journeys_.reserve(MaxFrames);
    arrivals_.reserve(MaxFrames);
    if (descriptions_.size() != params.devices.size()) {
        throw std::invalid_argument("twin: " + std::to_string(params.devices.size()) +
                                    " devices but " + std::to_string(descriptions_.size()) +
                                    " descriptions");
    }
    if (cycle <= core::Duration{0}) throw std::invalid_argument("twin: the cycle must be positive");
    for (std::size_t i = 0; i < params.devices.size(); ++i) {
        const TwinDeviceParams& device = params.devices[i];
        if (descriptions_[i] == nullptr) {
            throw std::invalid_argument("twin: device \"" + device.slave + "\" has no description");
        }
        if (device.countsPerTurn <= 0) {
            throw std::invalid_argument("twin: device \"" + device.slave +
                                        "\" needs a positive number of counts per turn");
        }
        devices_.push_back(std::make_unique<SimulatedDevice>(*descriptions_[i], device,
                                                             i + 1 < params.devices.size(), cycle,
                                                             EventPort{events_, i}));
    }
    layOut(params);
}

void Segment::layOut(const TwinParams& params) {
    const std::size_t count = params.devices.size();
    core::Duration way{0};
    for (const TwinDeviceParams& device : params.devices) {
        way += device.cableDelay;
        inbound_.push_back(way);
        way += device.forwardDelay;
    }
    // The last device turns the frame round; each one before it forwards it once more.
    outbound_.resize(count);
    for (std::size_t i = count; i-- > 0;) {
        if (i + 1 < count) {
            outbound_[i] = way;
            way += params.devices[i].forwardDelay;
        }
        way += params.devices[i].cableDelay;
    }
    roundTrip_ = way;
}

std::size_t Segment::freeSlot() noexcept {
    const auto found = std::find(used_.begin(), used_.end(), false);
    if (found != used_.end()) return static_cast<std::size_t>(found - used_.begin());
    if (arrivals_.empty()) return MaxFrames;
    // Nobody fetches what comes back: the oldest frame is overrun, as in a network card.
    const std::size_t slot = arrivals_.front().slot;
    arrivals_.erase(arrivals_.begin());
    return slot;
}

bool Segment::launch(const wire::Frame& frame) noexcept {
    if (cut_ || devices_.empty()) return true;  // sent into the void
    const std::size_t slot = freeSlot();
    if (slot == MaxFrames) return false;
    used_[slot] = true;
    FrameInFlight& flight = frames_[slot];
    std::copy_n(frame.bytes.begin(), frame.size, flight.frame.bytes.begin());
    flight.frame.size = frame.size;
    Journey journey;
    journey.slot = slot;
    journey.start = std::max(now_, wireFree_);
    journey.length = wireTime(frame.size);
    wireFree_ = journey.start + journey.length + InterFrameGap;
    const bool sound = flight.decode();
    for (std::size_t i = 0; i < flight.count; ++i) {
        const Datagram& datagram = flight.datagrams[i];
        const auto command = static_cast<wire::Command>(datagram.command);
        const bool latching = command == wire::Command::Bwr || command == wire::Command::Fpwr;
        if (latching && datagram.ado <= wire::reg::DcReceiveTimePort0 &&
            datagram.ado + datagram.data.size() > wire::reg::DcReceiveTimePort0) {
            flight.latchesTimes = true;
        }
    }
    journey.returning = flight.latchesTimes ? devices_.size() - 1 : 0;
    if (!sound) {
        // The first controller destroys what is not a sound EtherCAT frame, and counts it.
        devices_[0]->controller.countProcessingError();
        used_[slot] = false;
        return true;
    }
    planNext(journey);
    journeys_.push_back(journey);  // never allocates: no more journeys than slots
    return true;
}

void Segment::planNext(Journey& journey) const noexcept {
    const std::size_t count = devices_.size();
    core::TrueTime next = journey.start + roundTrip_ + journey.length;
    if (journey.entered < count) next = std::min(next, journey.start + inbound_[journey.entered]);
    if (journey.passed < count) {
        next = std::min(next, journey.start + inbound_[journey.passed] + journey.length);
    }
    if (journey.returning > 0) {
        next = std::min(next, journey.start + outbound_[journey.returning - 1]);
    }
    journey.next = next;
}

void Segment::run(core::TrueTime until, bool stopAtArrival) noexcept {
    for (;;) {
        if (stopAtArrival && hasArrival()) return;
        std::size_t first = journeys_.size();
        core::TrueTime time = core::TrueTime::max();
        for (std::size_t i = 0; i < journeys_.size(); ++i) {
            if (journeys_[i].next >= time) continue;
            time = journeys_[i].next;
            first = i;
        }
        const core::TrueTime event = events_.nextTime();
        if (std::min(time, event) > until) break;
        if (time <= event) {
            now_ = std::max(now_, time);
            step(first);
        } else {
            now_ = std::max(now_, event);
            fire();
        }
    }
    now_ = std::max(now_, until);
}

core::TrueTime Segment::lastReturn() const noexcept {
    core::TrueTime last = now_;
    for (const Journey& journey : journeys_) {
        last = std::max(last, journey.start + roundTrip_ + journey.length);
    }
    return last;
}

void Segment::step(std::size_t which) noexcept {
    Journey& journey = journeys_[which];
    const std::size_t count = devices_.size();
    // Of the same instant: an end before an arrival, so that a frame's writes hold for the next
    // one.
    if (journey.passed < count &&
        journey.next == journey.start + inbound_[journey.passed] + journey.length) {
        SimulatedDevice& device = *devices_[journey.passed++];
        const FrameEvents happened = device.controller.commit(now_);
        device.application.onFrame(happened, now_);
    } else if (journey.entered < count &&
               journey.next == journey.start + inbound_[journey.entered]) {
        enter(journey);
    } else if (journey.returning > 0 &&
               journey.next == journey.start + outbound_[journey.returning - 1]) {
        devices_[--journey.returning]->controller.latchReturn(now_);
    } else {
        finish(which);
        return;
    }
    planNext(journey);
}

void Segment::enter(Journey& journey) noexcept {
    FrameInFlight& flight = frames_[journey.slot];
    SlaveController& controller = devices_[journey.entered++]->controller;
    flight.frame.bytes[6] |= wire::SourceSeenBit;
    for (std::size_t i = 0; i < flight.count; ++i) controller.process(flight.datagrams[i], now_);
}

void Segment::finish(std::size_t which) noexcept {
    const Journey journey = journeys_[which];
    journeys_.erase(journeys_.begin() + static_cast<std::ptrdiff_t>(which));
    if (cut_) {
        used_[journey.slot] = false;
        return;
    }
    frames_[journey.slot].encode();
    arrivals_.push_back({journey.slot, now_});
}

void Segment::fire() noexcept {
    const EventQueue::Event event = events_.begin();
    SimulatedDevice& device = *devices_[event.device];
    if (event.kind == EventKind::Sync0) {
        device.controller.dc()->fireSync0(now_);
        if (sync0Observer_) sync0Observer_(event.device, now_);
    }
    device.application.onEvent(event.kind, now_);
    events_.done();
}

core::TrueTime Segment::take(wire::Frame& to) noexcept {
    const Arrival arrival = arrivals_.front();
    arrivals_.erase(arrivals_.begin());
    const wire::Frame& from = frames_[arrival.slot].frame;
    std::copy_n(from.bytes.begin(), from.size, to.bytes.begin());
    to.size = from.size;
    used_[arrival.slot] = false;
    return arrival.at;
}

}  // namespace takt::twin
