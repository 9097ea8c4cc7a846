#include "coe_client.hpp"

#include <algorithm>
#include <takt/wire/byte_io.hpp>

namespace takt::fieldbus::ethercat {

namespace {

namespace mbx = wire::mbx;
namespace abortcode = wire::abortcode;

constexpr std::uint8_t Tries = 3;
constexpr std::size_t ExpeditedSize = 4;
constexpr std::size_t SdoAt = mbx::CoeHeaderSize;
constexpr std::size_t DataAt = SdoAt + mbx::SdoHeaderSize;
constexpr std::size_t SegmentAt = SdoAt + 1;
constexpr std::size_t SmallestSegment = mbx::MinSdoSize - 1;

std::uint8_t expeditedDownload(std::size_t size) noexcept {
    return static_cast<std::uint8_t>(mbx::DownloadRequest | mbx::Expedited | mbx::SizeIndicated |
                                     ((ExpeditedSize - size) << 2));
}

}  // namespace

CoeClient::CoeClient(Mailbox& mailbox, core::Duration requestTimeout,
                     core::Duration responseTimeout)
    : mailbox_{mailbox}, requestTimeout_{requestTimeout}, responseTimeout_{responseTimeout} {}

void CoeClient::reset() noexcept {
    if (pending()) finish(core::ObjectState::Failed, abortcode::WrongDeviceState);
    mailbox_.reset();
}

bool CoeClient::begin(core::ObjectAddress address, bool writing) noexcept {
    if (pending()) return false;
    address_ = address;
    writing_ = writing;
    access_ = Access::OneEntry;
    reply_ = {};
    reply_.state = core::ObjectState::Pending;
    tries_ = 0;
    return true;
}

bool CoeClient::startRead(core::ObjectAddress address) noexcept {
    if (!begin(address, false)) return false;
    into_ = reply_.value.bytes;
    transmit();
    return true;
}

bool CoeClient::startRead(core::ObjectAddress address, std::span<std::uint8_t> into) noexcept {
    if (!begin(address, false)) return false;
    into_ = into;
    transmit();
    return true;
}

bool CoeClient::startWrite(core::ObjectAddress address, const core::ObjectValue& value) noexcept {
    if (!begin(address, true)) return false;
    value_ = value;
    if (value.size == 0 || value.size > value.bytes.size()) {
        finish(core::ObjectState::Failed, abortcode::LengthMismatch);
        return true;
    }
    from_ = std::span{value_.bytes}.first(value.size);
    transmit();
    return true;
}

bool CoeClient::startWrite(core::ObjectAddress address, std::span<const std::uint8_t> from,
                           Access access) noexcept {
    if (!begin(address, true)) return false;
    access_ = access;
    if (from.empty()) {
        finish(core::ObjectState::Failed, abortcode::LengthMismatch);
        return true;
    }
    from_ = from;
    transmit();
    return true;
}

void CoeClient::refuse(std::uint32_t abortCode) noexcept {
    finish(core::ObjectState::Failed, abortCode);
}

void CoeClient::transmit() noexcept {
    mailbox_.withdraw();
    const std::span<std::uint8_t> body = mailbox_.body();
    constexpr std::size_t longest = DataAt + 4 + sizeof(core::ObjectValue::bytes);
    if (body.size() < longest) {
        finish(core::ObjectState::Failed, abortcode::TooLongForMailbox);
        return;
    }
    std::fill_n(body.begin(), longest, std::uint8_t{0});
    segmented_ = false;
    toggle_ = 0;
    size_ = writing_ ? from_.size() : 0;
    done_ = 0;
    wire::store16(body, SdoAt + 1, address_.index);
    body[SdoAt + 3] = address_.subindex;
    std::size_t length = SdoAt + mbx::MinSdoSize;
    if (writing_) {
        length = fillDownload(body);
    } else {
        body[SdoAt] = mbx::UploadRequest;
    }
    ++tries_;
    send(length);
}

/// The first message of a download, with as much of the value as it holds. \return its length
std::size_t CoeClient::fillDownload(std::span<std::uint8_t> body) noexcept {
    std::size_t at = DataAt;
    if (size_ <= ExpeditedSize) {
        body[SdoAt] = expeditedDownload(size_);
        done_ = size_;
    } else {
        body[SdoAt] = mbx::DownloadRequest | mbx::SizeIndicated;
        wire::store32(body, DataAt, static_cast<std::uint32_t>(size_));
        at += 4;
        done_ = std::min(size_, body.size() - at);
    }
    if (access_ == Access::Whole) {
        body[SdoAt] = static_cast<std::uint8_t>(body[SdoAt] | mbx::CompleteAccess);
    }
    std::copy_n(from_.begin(), done_, body.begin() + static_cast<std::ptrdiff_t>(at));
    return std::max(at + done_, SdoAt + mbx::MinSdoSize);
}

void CoeClient::transmitSegment() noexcept {
    mailbox_.withdraw();
    const std::span<std::uint8_t> body = mailbox_.body();
    std::fill_n(body.begin(), SdoAt + mbx::MinSdoSize, std::uint8_t{0});
    std::size_t length = SdoAt + mbx::MinSdoSize;
    if (writing_) {
        const std::size_t part = std::min(size_ - done_, body.size() - SegmentAt);
        // Unused bytes are told in a segment of the smallest size only.
        const std::size_t unused = part < SmallestSegment ? SmallestSegment - part : 0;
        const bool last = done_ + part == size_;
        body[SdoAt] = static_cast<std::uint8_t>(mbx::DownloadSegmentRequest | toggle_ |
                                                (unused << 1U) | (last ? mbx::LastSegment : 0));
        std::copy_n(from_.begin() + static_cast<std::ptrdiff_t>(done_), part,
                    body.begin() + SegmentAt);
        done_ += part;
        length = std::max(length, SegmentAt + part);
    } else {
        body[SdoAt] = mbx::UploadSegmentRequest | toggle_;
    }
    send(length);
}

void CoeClient::send(std::size_t length) noexcept {
    wire::store16(
        mailbox_.body(), 0,
        static_cast<std::uint16_t>(static_cast<unsigned>(mbx::CoeService::SdoRequest) << 12U));
    mailbox_.post(mbx::Type::CoE, length);
    mailbox_.expect(true);
    timed_ = false;
}

void CoeClient::finish(core::ObjectState state, std::uint32_t abortCode) noexcept {
    reply_.state = state;
    reply_.abortCode = abortCode;
    mailbox_.withdraw();
    mailbox_.expect(false);
}

void CoeClient::watch(core::HostTime now) noexcept {
    if (!pending()) return;
    if (!timed_) {
        timed_ = true;
        deadline_ = now + requestTimeout_ + responseTimeout_;
    }
    if (now <= deadline_) return;
    if (tries_ < Tries) {
        transmit();
    } else {
        finish(core::ObjectState::Failed, abortcode::Timeout);
    }
}

void CoeClient::take(const MailboxMessage& message) noexcept {
    if (message.type == mbx::Type::Error) {
        // The slave could not even read the request (ETG.1000.4 table 30).
        if (pending()) finish(core::ObjectState::Failed, abortcode::General);
        return;
    }
    if (message.type != mbx::Type::CoE || message.body.size() < mbx::CoeHeaderSize) {
        ++unexpected_;
        return;
    }
    const unsigned service = wire::load16(message.body, 0) >> 12U;
    if (service == static_cast<unsigned>(mbx::CoeService::Emergency)) {
        takeEmergency(message.body.subspan(mbx::CoeHeaderSize));
        return;
    }
    // Some slaves send an abort as an SDO request.
    const bool sdo = service == static_cast<unsigned>(mbx::CoeService::SdoResponse) ||
                     service == static_cast<unsigned>(mbx::CoeService::SdoRequest);
    if (!sdo || message.body.size() < SdoAt + mbx::MinSdoSize) {
        ++unexpected_;
        return;
    }
    takeSdo(message.body.subspan(SdoAt));
}

void CoeClient::takeEmergency(std::span<const std::uint8_t> body) noexcept {
    constexpr std::size_t size = 8;
    if (body.size() < size) {
        ++unexpected_;
        return;
    }
    emergency_.errorCode = wire::load16(body, 0);
    emergency_.errorRegister = body[2];
    std::copy_n(body.begin() + 3, emergency_.deviceData.size(), emergency_.deviceData.begin());
    ++emergencies_;
}

void CoeClient::takeSdo(std::span<const std::uint8_t> sdo) noexcept {
    const auto command = static_cast<std::uint8_t>(sdo[0] & ~mbx::CompleteAccess);
    const bool mine = wire::load16(sdo, 1) == address_.index && sdo[3] == address_.subindex;
    if (pending() && segmented_ && command != mbx::Abort) return takeSegment(sdo);
    if (!pending() || !mine) {
        ++unexpected_;
        return;
    }
    if (command == mbx::Abort) {
        finish(core::ObjectState::Failed, wire::load32(sdo, 4));
    } else if (writing_ && (command & mbx::CommandMask) == mbx::DownloadResponse) {
        nextSegment();
    } else if (!writing_ && (command & mbx::CommandMask) == mbx::UploadResponse) {
        takeUpload(sdo);
    } else {
        ++unexpected_;
    }
}

void CoeClient::takeUpload(std::span<const std::uint8_t> sdo) noexcept {
    std::span<const std::uint8_t> data = sdo.subspan(mbx::SdoHeaderSize);
    if ((sdo[0] & mbx::Expedited) != 0) {
        size_ = ExpeditedSize;
        if ((sdo[0] & mbx::SizeIndicated) != 0) size_ -= (sdo[0] >> 2) & 3U;
    } else {
        size_ = wire::load32(data, 0);
        data = data.subspan(4);
    }
    if (size_ > into_.size()) {
        finish(core::ObjectState::Failed, abortcode::LengthTooHigh);
        return;
    }
    takeData(data.first(std::min(data.size(), size_)));
    nextSegment();
}

/// A segment names no object: its toggle bit tells whether it is the one that is awaited.
void CoeClient::takeSegment(std::span<const std::uint8_t> sdo) noexcept {
    const std::uint8_t awaited =
        writing_ ? mbx::DownloadSegmentResponse : mbx::UploadSegmentResponse;
    if ((sdo[0] & mbx::CommandMask) != awaited || (sdo[0] & mbx::ToggleBit) != toggle_) {
        ++unexpected_;
        return;
    }
    toggle_ ^= mbx::ToggleBit;
    if (!writing_) {
        std::span<const std::uint8_t> data = sdo.subspan(1);
        if (data.size() <= SmallestSegment) {
            data = data.first(
                std::min<std::size_t>(data.size(), SmallestSegment - ((sdo[0] >> 1U) & 7U)));
        }
        const bool last = (sdo[0] & mbx::LastSegment) != 0;
        if (data.size() > size_ - done_) {
            finish(core::ObjectState::Failed, abortcode::LengthTooHigh);
            return;
        }
        takeData(data);
        // One that brings nothing would go on for ever.
        if (done_ < size_ && (last || data.empty())) {
            finish(core::ObjectState::Failed, abortcode::LengthTooLow);
            return;
        }
    }
    nextSegment();
}

void CoeClient::takeData(std::span<const std::uint8_t> data) noexcept {
    std::copy(data.begin(), data.end(), into_.begin() + static_cast<std::ptrdiff_t>(done_));
    done_ += data.size();
}

void CoeClient::nextSegment() noexcept {
    if (done_ < size_) {
        segmented_ = true;
        transmitSegment();
        return;
    }
    if (!writing_ && into_.data() == reply_.value.bytes.data())
        reply_.value.size = static_cast<std::uint8_t>(size_);
    finish(core::ObjectState::Done, 0);
}

}  // namespace takt::fieldbus::ethercat
