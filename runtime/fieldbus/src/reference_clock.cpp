#include "reference_clock.hpp"

#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

namespace takt::fieldbus::ethercat {

namespace {

constexpr std::uint16_t WideBytes = 8;

}  // namespace

const PlannedDatagram& ReferenceClock::standard() noexcept {
    static constexpr PlannedDatagram frmw{.kind = CyclicCommand::Kind::ReferenceTime,
                                          .command = wire::Command::Frmw,
                                          .length = WideBytes};
    return frmw;
}

void ReferenceClock::lead(std::uint16_t station, bool wide,
                          const PlannedDatagram& datagram) noexcept {
    station_ = station;
    command_ = datagram.command;
    address_ =
        command_ == wire::Command::Armw ? static_cast<std::uint16_t>(datagram.address) : station;
    length_ = datagram.length;
    wide_ = wide && length_ >= WideBytes;
    sample_ = {};
}

void ReferenceClock::forget() noexcept {
    station_ = 0;
    sample_ = {};
    dcMinusHost_ = DcEpoch;
}

void ReferenceClock::append(FrameSet& frames) noexcept {
    datagram_ = frames.append(command_, address_, wire::reg::DcSystemTime, length_);
    fill(frames);
}

void ReferenceClock::fill(FrameSet& frames) const noexcept {
    const core::DcTime guess = sample_.referenceTime + cycle_;
    const auto time = static_cast<std::uint64_t>(guess.time_since_epoch().count());
    const std::span<std::uint8_t> data = frames.data(datagram_);
    if (length_ >= WideBytes) {
        wire::store64(data, 0, time);
    } else {
        wire::store32(data, 0, static_cast<std::uint32_t>(time));
    }
}

void ReferenceClock::take(const FrameSet& frames) noexcept {
    const Reply reply = frames.reply(datagram_);
    sample_.valid = reply.served();
    if (!sample_.valid) return;
    sample_.sent = frames.sentAt();
    std::uint64_t time = length_ >= WideBytes ? wire::load64(reply.data, 0)
                                              : std::uint64_t{wire::load32(reply.data, 0)};
    if (!wide_) {
        const auto guess =
            static_cast<std::uint64_t>(at(frames.sentAt()).time_since_epoch().count());
        const auto behind = static_cast<std::int32_t>(static_cast<std::uint32_t>(time) -
                                                      static_cast<std::uint32_t>(guess));
        time = guess + static_cast<std::uint64_t>(static_cast<std::int64_t>(behind));
    }
    sample_.referenceTime = core::DcTime{core::Duration{static_cast<std::int64_t>(time)}};
    sample_.phaseError = phaseError(sample_.referenceTime, sync0AfterSend_, cycle_);
    dcMinusHost_ = sample_.referenceTime.time_since_epoch() - frames.sentAt().time_since_epoch();
}

core::DcTime ReferenceClock::at(core::HostTime host) const noexcept {
    return core::DcTime{host.time_since_epoch() + dcMinusHost_};
}

core::HostTime ReferenceClock::gridSend(core::HostTime notBefore) const noexcept {
    const core::Duration shift = present() ? dcMinusHost_ + sync0AfterSend_ : core::Duration{0};
    const core::DcTime onGrid =
        gridAtOrAfter(core::DcTime{notBefore.time_since_epoch() + shift}, cycle_);
    return core::HostTime{onGrid.time_since_epoch() - shift};
}

}  // namespace takt::fieldbus::ethercat
