// Digital inputs: limit and home switches, the virtual ones of a drive that takes them from the
// bus, and the touch probes.

#include <cmath>

#include "drive.hpp"

namespace takt::twin {

namespace {

// 60FDh, CiA 402 bits; the inputs themselves from bit 16.
constexpr std::uint32_t NegativeLimitInput = 0x1;
constexpr std::uint32_t PositiveLimitInput = 0x2;
constexpr std::uint32_t HomeInput = 0x4;
constexpr unsigned FirstInputBit = 16;

// Where the switches of the machine are wired to a drive with functions in 2402h.
constexpr std::size_t PositiveLimitPin = 2;  // DI3
constexpr std::size_t NegativeLimitPin = 3;  // DI4
constexpr std::size_t HomePin = 4;           // DI5
constexpr std::uint64_t FirstProbeFunction = 28;

// Functions in 2500h to 2503h: digits 1 and 0; digit 2 inverts, digit 3 is the source.
constexpr std::size_t VirtualInputs = 4;
constexpr std::uint16_t ServoOn = 0x00;
constexpr std::uint16_t ForwardInhibit = 0x02;
constexpr std::uint16_t ReverseInhibit = 0x03;
constexpr std::uint16_t HomeSwitch = 0x15;
constexpr std::uint16_t FirstProbe = 0x31;
constexpr std::uint16_t TwoEnables = 0x190;  // enabled by an input and over the bus

constexpr std::uint16_t ProbesEnabled = 0x0101;

double nearEdge(const std::optional<SwitchParams>& zone, double position) noexcept {
    if (!zone) return position;
    const double toFrom = std::abs(zone->fromTurns - position);
    return toFrom < std::abs(zone->toTurns - position) ? zone->fromTurns : zone->toTurns;
}

}  // namespace

bool Drive::virtualInput(std::uint16_t function) const noexcept {
    const std::uint64_t mask = dictionary_.getUnsigned(objects_.virtualMask);
    const std::uint64_t levels = dictionary_.getUnsigned(objects_.virtualInputs) & mask;
    for (std::size_t i = 0; i < VirtualInputs; ++i) {
        const auto setting =
            static_cast<std::uint16_t>(dictionary_.getUnsigned(objects_.inputFunction[i]));
        // Only an input that the controller feeds is judged here; a pin has its own wire.
        if ((setting & 0xFFU) != function || (mask >> (FirstInputBit + i) & 1U) == 0) continue;
        const unsigned source = setting >> 12U;
        const bool inverted = (setting >> 8U & 0xFU) != 0;
        const bool pin = (levels >> (FirstInputBit + i) & 1U) != 0;
        const bool level = source == 1 || (source == 0 && pin);
        if (level != inverted) return true;
    }
    return false;
}

void Drive::readInputs() noexcept {
    const auto function =
        static_cast<std::uint16_t>(dictionary_.getUnsigned(objects_.probeFunction));
    if (traits_.virtualInputs && dictionary_.getUnsigned(objects_.virtualMask) != 0) {
        forced_ = {virtualInput(HomeSwitch), virtualInput(ForwardInhibit),
                   virtualInput(ReverseInhibit)};
        probeInput_ = {virtualInput(FirstProbe), virtualInput(FirstProbe + 1)};
        if (powered_ && virtualInput(ServoOn)) raiseAlarm(TwoEnables);
    } else {
        forced_ = {};
        probeInput_ = {};
    }
    homing_.force(forced_);
    probe_.configure(function, (function & ProbesEnabled) != 0 ? probeSignals(motor_.position())
                                                               : ProbeSignals{});
}

std::uint32_t Drive::digitalInputs() const noexcept {
    const bool home = motor_.homeSwitch() || forced_.home;
    std::uint32_t word = (negativeLimit() ? NegativeLimitInput : 0U) |
                         (positiveLimit() ? PositiveLimitInput : 0U) | (home ? HomeInput : 0U);
    if (traits_.virtualInputs) {
        const std::uint64_t fed = dictionary_.getUnsigned(objects_.virtualInputs) &
                                  dictionary_.getUnsigned(objects_.virtualMask);
        word |= static_cast<std::uint32_t>(fed) & (0xFU << FirstInputBit);
    } else {
        word |= (motor_.positiveLimit() ? 1U : 0U) << (FirstInputBit + PositiveLimitPin);
        word |= (motor_.negativeLimit() ? 1U : 0U) << (FirstInputBit + NegativeLimitPin);
        word |= (motor_.homeSwitch() ? 1U : 0U) << (FirstInputBit + HomePin);
    }
    return word;
}

ProbeSignals Drive::probeSignals(double before) const noexcept {
    ProbeSignals signals;
    const MechanicsParams& parts = motor_.params();
    const double now = motor_.position();
    signals.place = {now, now};
    signals.input = probeInput_;
    if (!traits_.virtualInputs) {
        for (std::size_t i = 0; i < TouchProbe::Channels; ++i) {
            const auto wired = [&](std::size_t pin, bool level,
                                   const std::optional<SwitchParams>& zone) {
                if (dictionary_.getUnsigned(objects_.inputFunction[pin]) != FirstProbeFunction + i)
                    return;
                signals.input[i] = level;
                signals.place[i] = nearEdge(zone, now);
            };
            wired(PositiveLimitPin, motor_.positiveLimit(), parts.positiveLimit);
            wired(NegativeLimitPin, motor_.negativeLimit(), parts.negativeLimit);
            wired(HomePin, motor_.homeSwitch(), parts.homeSwitch);
        }
    }
    const double first = std::floor(before - parts.indexTurns);
    const double last = std::floor(now - parts.indexTurns);
    signals.indexPassed = first != last;
    signals.indexPlace = (first < last ? last : first) + parts.indexTurns;
    return signals;
}

void Drive::reportProbes() noexcept {
    dictionary_.set(objects_.probeStatus, probe_.status(traits_.probeCountsInStatus));
    if (!probe_.armed()) return;
    for (std::size_t i = 0; i < objects_.probePosition.size(); ++i) {
        const TouchProbe::Catch& caught = probe_.caught(i / 2, i % 2 == 0);
        if (!caught.valid) continue;
        dictionary_.set(objects_.probePosition[i], userPosition(caught.turns));
        dictionary_.set(objects_.probeTime[i], caught.time);
        dictionary_.set(objects_.probeCount[i], caught.count);
    }
}

}  // namespace takt::twin
