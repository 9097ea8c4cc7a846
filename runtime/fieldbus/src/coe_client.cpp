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

bool CoeClient::begin(core::ObjectAddress address) noexcept {
    if (pending()) return false;
    address_ = address;
    reply_ = {};
    reply_.state = core::ObjectState::Pending;
    tries_ = 0;
    return true;
}

bool CoeClient::startRead(core::ObjectAddress address) noexcept {
    if (!begin(address)) return false;
    writing_ = false;
    transmit();
    return true;
}

bool CoeClient::startWrite(core::ObjectAddress address, const core::ObjectValue& value) noexcept {
    if (pending()) return false;
    value_ = value;
    const std::size_t size = value.size <= value.bytes.size() ? value.size : 0;
    return startWrite(address, std::span{value_.bytes}.first(size), false);
}

bool CoeClient::startWrite(core::ObjectAddress address, std::span<const std::uint8_t> data,
                           bool completeAccess) noexcept {
    if (!begin(address)) return false;
    writing_ = true;
    data_ = data;
    completeAccess_ = completeAccess;
    if (data.empty()) {
        finish(core::ObjectState::Failed, abortcode::LengthMismatch);
    } else {
        transmit();
    }
    return true;
}

void CoeClient::refuse(std::uint32_t abortCode) noexcept {
    finish(core::ObjectState::Failed, abortCode);
}

void CoeClient::transmit() noexcept {
    mailbox_.withdraw();
    const std::span<std::uint8_t> body = mailbox_.body();
    const std::size_t longest =
        DataAt + 4 + std::max(writing_ ? data_.size() : 0, sizeof(core::ObjectValue::bytes));
    if (body.size() < longest) {
        finish(core::ObjectState::Failed, abortcode::TooLongForMailbox);
        return;
    }
    std::fill_n(body.begin(), longest, std::uint8_t{0});
    wire::store16(
        body, 0,
        static_cast<std::uint16_t>(static_cast<unsigned>(mbx::CoeService::SdoRequest) << 12U));
    wire::store16(body, SdoAt + 1, address_.index);
    body[SdoAt + 3] = address_.subindex;
    std::size_t length = SdoAt + mbx::MinSdoSize;
    if (!writing_) {
        body[SdoAt] = mbx::UploadRequest;
    } else {
        std::size_t at = DataAt;
        if (data_.size() <= ExpeditedSize) {
            body[SdoAt] = expeditedDownload(data_.size());
        } else {
            body[SdoAt] = mbx::DownloadRequest | mbx::SizeIndicated;
            wire::store32(body, DataAt, static_cast<std::uint32_t>(data_.size()));
            at += 4;
            length = at + data_.size();
        }
        if (completeAccess_) {
            body[SdoAt] = static_cast<std::uint8_t>(body[SdoAt] | mbx::CompleteAccess);
        }
        std::copy(data_.begin(), data_.end(), body.begin() + static_cast<std::ptrdiff_t>(at));
    }
    mailbox_.post(mbx::Type::CoE, length);
    mailbox_.expect(true);
    timed_ = false;
    ++tries_;
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
    if (!pending() || !mine) {
        ++unexpected_;
        return;
    }
    if (command == mbx::Abort) {
        finish(core::ObjectState::Failed, wire::load32(sdo, 4));
    } else if (writing_ && (command & mbx::CommandMask) == mbx::DownloadResponse) {
        finish(core::ObjectState::Done, 0);
    } else if (!writing_ && (command & mbx::CommandMask) == mbx::UploadResponse) {
        takeUpload(sdo);
    } else {
        ++unexpected_;
    }
}

void CoeClient::takeUpload(std::span<const std::uint8_t> sdo) noexcept {
    std::span<const std::uint8_t> data = sdo.subspan(mbx::SdoHeaderSize);
    std::size_t size = 0;
    if ((sdo[0] & mbx::Expedited) != 0) {
        size = ExpeditedSize;
        if ((sdo[0] & mbx::SizeIndicated) != 0) size -= (sdo[0] >> 2) & 3U;
    } else {
        size = wire::load32(data, 0);
        data = data.subspan(4);
        // The rest would come in segments, which one value of eight bytes never needs.
        if (size > data.size() && size <= reply_.value.bytes.size()) size = data.size();
    }
    if (size > reply_.value.bytes.size()) {
        finish(core::ObjectState::Failed, abortcode::LengthTooHigh);
        return;
    }
    std::copy_n(data.begin(), size, reply_.value.bytes.begin());
    reply_.value.size = static_cast<std::uint8_t>(size);
    finish(core::ObjectState::Done, 0);
}

}  // namespace takt::fieldbus::ethercat
