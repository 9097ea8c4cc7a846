#include "mailbox.hpp"

#include <algorithm>
#include <cassert>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>
#include <utility>

namespace takt::fieldbus::ethercat {

namespace {

namespace mbx = wire::mbx;

constexpr core::Duration LookGap = std::chrono::microseconds{250};
constexpr std::uint8_t RepeatTries = 100;
constexpr std::uint16_t StatusField = 5;  ///< of a SyncManager
constexpr std::uint16_t ActivateField = 6;
constexpr std::uint8_t BoxFull = 0x08;
constexpr std::uint8_t Enabled = 0x01;
constexpr std::uint8_t RepeatBit = 0x02;

std::uint16_t managerField(std::uint8_t manager, std::uint16_t field) noexcept {
    return static_cast<std::uint16_t>(wire::reg::SyncManager +
                                      manager * wire::reg::SyncManagerSize + field);
}

}  // namespace

Mailbox::Mailbox(const MailboxPlace& place)
    : place_{place}, out_(place.outSize), in_(place.inSize) {}

void Mailbox::reset() noexcept {
    phase_ = asked_ = Phase::Idle;
    posting_ = expecting_ = lookOnce_ = false;
    outTurn_ = true;
    outCounter_ = inCounter_ = toggle_ = 0;
}

std::span<std::uint8_t> Mailbox::body() noexcept {
    return std::span{out_}.subspan(mbx::HeaderSize);
}

void Mailbox::post(mbx::Type type, std::size_t length) noexcept {
    assert(!posting_ && length + mbx::HeaderSize <= out_.size());
    // 1 to 7 in turn; 0 would mean "not counted".
    outCounter_ = static_cast<std::uint8_t>(outCounter_ % 7 + 1);
    wire::store16(out_, 0, static_cast<std::uint16_t>(length));
    wire::store16(out_, 2, 0);
    out_[4] = 0;
    out_[5] = static_cast<std::uint8_t>(static_cast<unsigned>(type) | (outCounter_ << 4U));
    std::fill(out_.begin() + static_cast<std::ptrdiff_t>(mbx::HeaderSize + length), out_.end(),
              std::uint8_t{0});
    posting_ = true;
    outTurn_ = true;
}

void Mailbox::look() noexcept {
    lookOnce_ = true;
}

void Mailbox::fetch() noexcept {
    if (!fetching()) phase_ = Phase::Fetch;
}

/// Chooses what to do next, unless a message is being fetched.
void Mailbox::settle() noexcept {
    if (fetching()) return;
    if (posting_ && outTurn_) {
        phase_ = Phase::Post;
    } else {
        phase_ = posting_ || expecting_ || lookOnce_ ? Phase::Look : Phase::Idle;
    }
}

bool Mailbox::next(core::HostTime now, std::uint16_t station, Request& request) noexcept {
    settle();
    asked_ = phase_;
    const std::uint16_t status = managerField(place_.inManager, StatusField);
    switch (phase_) {
        case Phase::Idle:
            return false;
        case Phase::Post:
            request = writeRequest(station, place_.outStart, out_);
            return true;
        case Phase::Fetch:
            request = readRequest(station, place_.inStart, place_.inSize);
            return true;
        case Phase::AskRepeat:
            activate_ = static_cast<std::uint8_t>(Enabled | (toggle_ != 0 ? RepeatBit : 0));
            request = writeRequest(station, managerField(place_.inManager, ActivateField),
                                   {&activate_, 1});
            return true;
        case Phase::Look:
            if (now < lookAt_) return false;
            request = readRequest(station, status, 1);
            return true;
        case Phase::AwaitRepeat:
            if (now < lookAt_) return false;
            request = readRequest(station, status, 3);
            return true;
    }
    return false;
}

bool Mailbox::take(core::HostTime now, const Reply& reply, MailboxMessage& message) noexcept {
    switch (asked_) {
        case Phase::Idle:
            return false;
        case Phase::Post:
            // Lost: the same bytes go out again, and the slave drops a repeated counter.
            if (!reply.arrived) return false;
            if (reply.workingCounter != 0) posting_ = false;
            outTurn_ = false;
            return false;
        case Phase::Look:
            lookAt_ = now + LookGap;
            if (!reply.served()) return false;
            outTurn_ = true;
            lookOnce_ = false;
            if ((reply.data[0] & BoxFull) != 0) phase_ = Phase::Fetch;
            return false;
        case Phase::Fetch:
            return takeFetched(reply, message);
        case Phase::AskRepeat:
            if (reply.served()) phase_ = Phase::AwaitRepeat;
            return false;
        case Phase::AwaitRepeat:
            takeRepeat(now, reply);
            return false;
    }
    return false;
}

bool Mailbox::takeFetched(const Reply& reply, MailboxMessage& message) noexcept {
    if (!reply.arrived) {
        // Nobody knows whether the box was emptied: have the slave put the message out again.
        toggle_ ^= 1U;
        repeatTries_ = 0;
        phase_ = Phase::AskRepeat;
        return false;
    }
    phase_ = Phase::Idle;
    if (reply.workingCounter == 0) return false;
    std::copy(reply.data.begin(), reply.data.end(), in_.begin());
    const std::size_t length = wire::load16(in_, 0);
    const auto counter = static_cast<std::uint8_t>((in_[5] >> 4) & 7U);
    if (mbx::HeaderSize + length > in_.size()) return false;
    // A repeated message carries the counter of the one before.
    if (counter != 0 && counter == inCounter_) return false;
    inCounter_ = counter;
    message.type = static_cast<mbx::Type>(in_[5] & 0x0FU);
    message.body = std::span{std::as_const(in_)}.subspan(mbx::HeaderSize, length);
    return true;
}

void Mailbox::takeRepeat(core::HostTime now, const Reply& reply) noexcept {
    lookAt_ = now + LookGap;
    if (!reply.served()) return;
    const bool acknowledged = ((reply.data[2] & RepeatBit) != 0) == (toggle_ != 0);
    if (!acknowledged && ++repeatTries_ < RepeatTries) return;
    const bool full = (reply.data[0] & BoxFull) != 0;
    phase_ = full ? Phase::Fetch : Phase::Idle;
    lookOnce_ = !full;
}

}  // namespace takt::fieldbus::ethercat
