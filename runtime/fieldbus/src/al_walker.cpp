#include "al_walker.hpp"

#include <takt/wire/byte_io.hpp>
#include <takt/wire/registers.hpp>

namespace takt::fieldbus::ethercat {

namespace {

constexpr core::Duration LookGap = std::chrono::microseconds{250};
constexpr std::uint8_t SilentLimit = 10;

}  // namespace

AlReading decodeAlStatus(std::span<const std::uint8_t> data) noexcept {
    const std::uint16_t status = wire::load16(data, 0);
    return {static_cast<wire::AlState>(status & wire::AlStateMask),
            (status & wire::AlErrorBit) != 0, wire::load16(data, 4)};
}

void AlWalker::start(wire::AlState target, core::Duration timeout) noexcept {
    target_ = target;
    timeout_ = timeout;
    deadline_.reset();
    lookAt_ = {};
    phase_ = Phase::Look;
    result_ = Result::Busy;
    silent_ = 0;
}

bool AlWalker::next(core::HostTime now, std::uint16_t station, Request& request) noexcept {
    if (result_ != Result::Busy) return false;
    if (!deadline_) deadline_ = now + timeout_;
    if (now > *deadline_) {
        result_ = Result::TimedOut;
        return false;
    }
    switch (phase_) {
        case Phase::Acknowledge:
        case Phase::Ask: {
            const auto state = static_cast<std::uint16_t>(
                phase_ == Phase::Ask ? static_cast<unsigned>(target_)
                                     : static_cast<unsigned>(seen_.state) | wire::AlErrorBit);
            wire::store16(control_, 0, state);
            request = writeRequest(station, wire::reg::AlControl, control_);
            return true;
        }
        case Phase::Look:
        case Phase::AwaitAcknowledge:
        case Phase::Await:
            break;
    }
    if (now < lookAt_) return false;
    request = readRequest(station, wire::reg::AlStatus, AlReadingBytes);
    return true;
}

void AlWalker::take(core::HostTime now, const Reply& reply) noexcept {
    if (result_ != Result::Busy || !reply.arrived) return;
    if (reply.workingCounter != 1) {
        if (++silent_ >= SilentLimit) result_ = Result::Silent;
        return;
    }
    silent_ = 0;
    switch (phase_) {
        case Phase::Acknowledge:
            phase_ = Phase::AwaitAcknowledge;
            return;
        case Phase::Ask:
            phase_ = Phase::Await;
            return;
        case Phase::Look:
        case Phase::AwaitAcknowledge:
        case Phase::Await:
            break;
    }
    seen_ = decodeAlStatus(reply.data);
    takeStatus(now);
}

void AlWalker::takeStatus(core::HostTime now) noexcept {
    if (phase_ == Phase::Look) {
        if (seen_.state == target_ && !seen_.error) {
            result_ = Result::Reached;
        } else {
            phase_ = seen_.error ? Phase::Acknowledge : Phase::Ask;
        }
        return;
    }
    if (phase_ == Phase::AwaitAcknowledge) {
        // A device without a processor of its own mirrors the acknowledge bit and has no code.
        if (!seen_.error || seen_.code == 0) {
            // The acknowledgement names the state it is in: there is nothing left to ask for.
            const bool there = seen_.state == target_ && !seen_.error;
            phase_ = Phase::Ask;
            if (there) result_ = Result::Reached;
            return;
        }
    } else if (seen_.error) {
        result_ = Result::Refused;
    } else if (seen_.state == target_) {
        result_ = Result::Reached;
    }
    lookAt_ = now + LookGap;
}

}  // namespace takt::fieldbus::ethercat
