#include "dc_unit.hpp"

#include <algorithm>
#include <cstdlib>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

namespace takt::twin {

namespace reg = wire::reg;
using wire::load16;
using wire::load32;
using wire::load64;
using wire::load8;
using wire::store16;
using wire::store32;
using wire::store64;
using wire::store8;

namespace {

constexpr std::int64_t LargestError = std::int64_t{1} << 22;  // ns that enter the loop, about 4 ms
constexpr std::int64_t ShortestInterval = 1'000;              // ns
constexpr std::int64_t LongestInterval = 16'000'000;          // ns
constexpr ClockRate SlewLimit = ClockRate{1} << 30;           // 977 ppm
constexpr ClockRate TrimLimit = ClockRate{1} << 28;           // 244 ppm
constexpr int FilterBits = 16;
constexpr std::uint8_t CyclicAndSync0 = 0x03;
constexpr std::uint8_t FirstPulsePending = 0x01;
constexpr std::uint8_t StartNotInFuture = 0x04;

bool overlaps(std::uint16_t address, std::size_t length, std::uint16_t start,
              std::uint16_t size) noexcept {
    return address < start + size && start < address + length;
}

}  // namespace

DcUnit::DcUnit(std::span<std::uint8_t> registers, double ppm, core::Duration start,
               EventPort events)
    : registers_{registers}, events_{events}, clock_{ppm, start.count()} {
    store16(registers_, reg::DcSpeedCounterStart, 0x1000);
    store8(registers_, reg::DcFilterDepth, 4);
    store8(registers_, reg::DcFilterDepth + 1U, 12);
}

void DcUnit::refreshSystemTime(core::TrueTime now) noexcept {
    store64(registers_, reg::DcSystemTime, static_cast<std::uint64_t>(syncTime(now) - delay_));
}

void DcUnit::latchArrival(core::TrueTime now, bool everyPort) noexcept {
    arrival_ = clock_.at(now);
    arrivalPending_ = true;
    arrivalEveryPort_ = everyPort;
}

void DcUnit::latchReturn(core::TrueTime now, std::size_t port) noexcept {
    store32(registers_, reg::DcReceiveTimePort0 + 4 * port,
            static_cast<std::uint32_t>(clock_.at(now)));
}

void DcUnit::receiveSystemTime(core::TrueTime now, std::uint32_t received) noexcept {
    // Only the low halves are compared, so the difference is right as long as it is below 2 s.
    const auto copy = static_cast<std::uint32_t>(syncTime(now) - delay_);
    difference_ = static_cast<std::int32_t>(copy - received);
    comparePending_ = true;
}

void DcUnit::commit(core::TrueTime now) noexcept {
    if (arrivalPending_) {
        arrivalPending_ = false;
        store64(registers_, reg::DcReceiveTimeUnit, static_cast<std::uint64_t>(arrival_));
        if (arrivalEveryPort_) {
            store32(registers_, reg::DcReceiveTimePort0, static_cast<std::uint32_t>(arrival_));
        }
    }
    if (comparePending_) {
        comparePending_ = false;
        followReference(now);
    }
}

/// A PI controller on the clock's speed, stepped once per received system time. The proportional
/// part is a slew that lasts one interval, so that nothing but the learned speed remains when
/// frames stop; the integral part learns the speed. Gains follow 0x0930: 256/start of the phase
/// error is removed per frame, damping 1. Ringing for frames of uneven spacing is avoided by using
/// the longer interval.
void DcUnit::followReference(core::TrueTime now) noexcept {
    const std::int64_t local = clock_.at(now);
    const std::int64_t last = lastCompare_;
    lastCompare_ = local;
    const int depth = load8(registers_, reg::DcFilterDepth) & 0x0F;
    filtered_ +=
        ((std::int64_t{difference_} * (std::int64_t{1} << FilterBits)) - filtered_) >> depth;
    showDifference();
    if (last < 0) return;

    const std::int64_t interval = std::clamp(local - last, ShortestInterval, LongestInterval);
    const std::int64_t longer = std::max(interval, lastInterval_);
    lastInterval_ = interval;
    const std::int64_t error = std::clamp<std::int64_t>(difference_, -LargestError, LargestError) *
                               (std::int64_t{1} << ClockRateBits);
    const std::int64_t start =
        std::clamp<std::int64_t>(load16(registers_, reg::DcSpeedCounterStart), 0x0400, 0x3FFF);

    ClockRate slew = -(error / interval * 256 / start);
    ClockRate trim = clock_.trim();
    if (std::abs(slew) > SlewLimit) {
        slew = slew < 0 ? -SlewLimit : SlewLimit;  // no learning from a step in phase
    } else {
        const ClockRate learned = -(error / longer * 256 / start) * 64 / start;
        trim = std::clamp(trim + learned, -TrimLimit, TrimLimit);
    }
    clock_.adjust(now, trim, slew, core::Duration{interval});
    store16(registers_, reg::DcSpeedCounterDifference, static_cast<std::uint16_t>(trim >> 20));
    planSync0();
}

void DcUnit::showDifference() noexcept {
    const std::int64_t nanoseconds = filtered_ / (std::int64_t{1} << FilterBits);
    const auto magnitude =
        static_cast<std::uint32_t>(std::min<std::int64_t>(std::abs(nanoseconds), 0x7FFFFFFF));
    const std::uint32_t sign = filtered_ >= 0 ? 0x80000000U : 0U;
    store32(registers_, reg::DcSystemTimeDifference, magnitude | sign);
}

void DcUnit::resetLoop(core::TrueTime now) noexcept {
    clock_.adjust(now, 0, 0, core::Duration{0});
    filtered_ = 0;
    lastCompare_ = -1;
    lastInterval_ = 0;
    store32(registers_, reg::DcSystemTimeDifference, 0);
    store16(registers_, reg::DcSpeedCounterDifference, 0);
    planSync0();
}

void DcUnit::written(std::uint16_t address, std::size_t length, core::TrueTime now) noexcept {
    if (overlaps(address, length, reg::DcSystemTimeOffset, 8)) {
        offset_ = static_cast<std::int64_t>(load64(registers_, reg::DcSystemTimeOffset));
        planSync0();
    }
    if (overlaps(address, length, reg::DcSystemTimeDelay, 4)) {
        delay_ = load32(registers_, reg::DcSystemTimeDelay);
    }
    if (overlaps(address, length, reg::DcSpeedCounterStart, 2)) resetLoop(now);
    if (overlaps(address, length, reg::DcFilterDepth, 1)) {
        filtered_ = 0;
        store32(registers_, reg::DcSystemTimeDifference, 0);
    }
    if (overlaps(address, length, reg::DcActivation, 1)) activate(now);
}

void DcUnit::activate(core::TrueTime now) noexcept {
    const bool wanted = (load8(registers_, reg::DcActivation) & CyclicAndSync0) == CyclicAndSync0;
    if (wanted == active_) return;
    active_ = wanted;
    running_ = false;
    if (!active_) {
        events_.cancel(EventKind::Sync0);
        store8(registers_, reg::DcActivationStatus, 0);
        return;
    }
    nextSync0_ = static_cast<std::int64_t>(load64(registers_, reg::DcStartTime));
    std::uint8_t status = FirstPulsePending;
    if (nextSync0_ <= syncTime(now)) status |= StartNotInFuture;
    store8(registers_, reg::DcActivationStatus, status);
    planSync0();
}

void DcUnit::planSync0() noexcept {
    if (!active_) return;
    // A start that had passed at activation comes true only when the 64-bit counter wraps.
    if ((load8(registers_, reg::DcActivationStatus) & StartNotInFuture) != 0) return;
    events_.schedule(EventKind::Sync0, clock_.whenReaching(nextSync0_ - offset_));
}

void DcUnit::fireSync0(core::TrueTime) noexcept {
    running_ = true;
    store8(registers_, reg::DcActivationStatus, 0);
    const std::int64_t cycle = sync0Cycle().count();
    if (cycle == 0) return;  // single pulse
    nextSync0_ += cycle;
    store64(registers_, reg::DcStartTime, static_cast<std::uint64_t>(nextSync0_));
    planSync0();
}

core::Duration DcUnit::sync0Cycle() const noexcept {
    return core::Duration{load32(registers_, reg::DcSync0Cycle)};
}

}  // namespace takt::twin
