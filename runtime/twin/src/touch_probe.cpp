#include "touch_probe.hpp"

namespace takt::twin {

namespace {

// 60B8h, of the first probe; the second one's bits are eight higher.
constexpr unsigned Enable = 0x01;
constexpr unsigned Continuous = 0x02;
constexpr unsigned ByIndex = 0x04;
constexpr unsigned Rising = 0x10;
constexpr unsigned Falling = 0x20;

// 60B9h
constexpr unsigned Enabled = 0x01;
constexpr unsigned RisingCaught = 0x02;
constexpr unsigned FallingCaught = 0x04;
constexpr unsigned CounterShift = 6;
constexpr unsigned CounterMask = 0x03;

}  // namespace

void TouchProbe::configure(std::uint16_t function, const ProbeSignals& signals) noexcept {
    for (std::size_t i = 0; i < Channels; ++i) {
        Channel& channel = channels_[i];
        const unsigned bits = (function >> (8 * i)) & 0xFFU;
        const bool enable = (bits & Enable) != 0;
        if (enable && !channel.enabled) {
            channel.continuous = (bits & Continuous) != 0;
            channel.byIndex = (bits & ByIndex) != 0;
            channel.wantsRising = (bits & Rising) != 0;
            channel.wantsFalling = (bits & Falling) != 0;
            channel.rising.valid = false;
            channel.falling.valid = false;
            channel.executions = 0;
            channel.last = signals.input[i];
        }
        channel.enabled = enable;
        channel.armed = enable && (channel.wantsRising || channel.wantsFalling);
    }
}

void TouchProbe::take(Catch& edge, Channel& channel, double place, std::uint32_t time) noexcept {
    // A single shot is over with the first event of its edge.
    if (edge.valid && !channel.continuous) return;
    edge.valid = true;
    edge.turns = place;
    edge.time = time;
    ++edge.count;
    if (channel.continuous) ++channel.executions;
}

void TouchProbe::step(const ProbeSignals& signals, std::uint32_t time) noexcept {
    for (std::size_t i = 0; i < Channels; ++i) {
        Channel& channel = channels_[i];
        const bool level = signals.input[i];
        const bool changed = level != channel.last;
        channel.last = level;
        if (!channel.armed) continue;
        // The index pulse has no width here: both its edges lie at one place.
        const bool rises = channel.byIndex ? signals.indexPassed : changed && level;
        const bool falls = channel.byIndex ? signals.indexPassed : changed && !level;
        const double place = channel.byIndex ? signals.indexPlace : signals.place[i];
        if (rises && channel.wantsRising) take(channel.rising, channel, place, time);
        if (falls && channel.wantsFalling) take(channel.falling, channel, place, time);
    }
}

std::uint16_t TouchProbe::status(bool counts) const noexcept {
    unsigned word = 0;
    for (std::size_t i = 0; i < Channels; ++i) {
        const Channel& channel = channels_[i];
        unsigned bits = channel.enabled ? Enabled : 0U;
        if (channel.rising.valid) bits |= RisingCaught;
        if (channel.falling.valid) bits |= FallingCaught;
        if (counts) bits |= (channel.executions & CounterMask) << CounterShift;
        word |= bits << (8 * i);
    }
    return static_cast<std::uint16_t>(word);
}

}  // namespace takt::twin
