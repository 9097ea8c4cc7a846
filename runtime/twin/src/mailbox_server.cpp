#include "mailbox_server.hpp"

#include <algorithm>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/mailbox.hpp>

namespace takt::twin {

namespace mbx = wire::mbx;

namespace {

constexpr std::uint8_t TypeMask = 0x0F;
constexpr std::uint8_t CounterMask = 0x07;
constexpr std::uint8_t LargestCounter = 7;
constexpr std::uint16_t ErrorService = 0x0004;  // ETG.1000.6 table 30: service not supported
constexpr std::size_t ErrorLength = 4;
constexpr std::size_t EmergencySize = 8;

std::uint16_t coeHeader(mbx::CoeService service) noexcept {
    return static_cast<std::uint16_t>(static_cast<unsigned>(service) << 12);
}

}  // namespace

void MailboxServer::reset() noexcept {
    lastRequest_ = 0;
    counter_ = 0;
    last_.size = 0;
    waiting_.clear();
}

void MailboxServer::serve(wire::AlState state) noexcept {
    const auto request = syncManagers_.message(outBox_);
    if (request.empty()) return;
    handle(request, state);
    syncManagers_.release(outBox_);
    post();
}

void MailboxServer::handle(std::span<const std::uint8_t> request, wire::AlState state) noexcept {
    if (request.size() < mbx::HeaderSize) return;
    const std::size_t length = wire::load16(request, 0);
    address_ = wire::load16(request, 2);
    const auto type = static_cast<mbx::Type>(request[5] & TypeMask);
    const auto counter = static_cast<std::uint8_t>((request[5] >> 4) & CounterMask);
    // A repeated counter means a repeated request: its answer is on the way already. 0 = not
    // counted.
    if (counter != 0 && counter == lastRequest_) return;
    lastRequest_ = counter;
    if (mbx::HeaderSize + length > request.size()) return replyError(mbx::ErrorInvalidSize);
    if (type == mbx::Type::Error) return;
    if (type != mbx::Type::CoE) return replyError(mbx::ErrorUnsupportedProtocol);
    handleCoe(request.subspan(mbx::HeaderSize, length), state);
}

void MailboxServer::handleCoe(std::span<const std::uint8_t> body, wire::AlState state) noexcept {
    if (body.size() < mbx::CoeHeaderSize) return replyError(mbx::ErrorTooShort);
    const auto service = static_cast<mbx::CoeService>(wire::load16(body, 0) >> 12);
    if (service != mbx::CoeService::SdoRequest) return replyError(ErrorService);
    if (body.size() < mbx::CoeHeaderSize + mbx::MinSdoSize) return replyError(mbx::ErrorTooShort);
    constexpr std::size_t overhead = mbx::HeaderSize + mbx::CoeHeaderSize;
    const std::size_t box =
        std::min<std::size_t>(syncManagers_.length(inBox_), building_.bytes.size());
    if (box < overhead + mbx::MinSdoSize) return;
    const std::span<std::uint8_t> room{building_.bytes.data() + overhead, box - overhead};
    const std::size_t size = coe_.answer(body.subspan(mbx::CoeHeaderSize), room, state);
    if (size == 0) return;
    wire::store16(building_.bytes, mbx::HeaderSize, coeHeader(mbx::CoeService::SdoResponse));
    reply(static_cast<std::uint8_t>(mbx::Type::CoE), mbx::CoeHeaderSize + size);
}

void MailboxServer::replyError(std::uint16_t detail) noexcept {
    wire::store16(building_.bytes, mbx::HeaderSize, 1);
    wire::store16(building_.bytes, mbx::HeaderSize + 2, detail);
    reply(static_cast<std::uint8_t>(mbx::Type::Error), ErrorLength);
}

void MailboxServer::reply(std::uint8_t type, std::size_t length) noexcept {
    counter_ =
        counter_ == LargestCounter ? std::uint8_t{1} : static_cast<std::uint8_t>(counter_ + 1);
    wire::store16(building_.bytes, 0, static_cast<std::uint16_t>(length));
    wire::store16(building_.bytes, 2, address_);
    building_.bytes[4] = 0;
    building_.bytes[5] = static_cast<std::uint8_t>(type | (counter_ << 4));
    building_.size = mbx::HeaderSize + length;
    static_cast<void>(waiting_.push(building_));  // full: a master that never reads loses answers
}

void MailboxServer::send(const Emergency& emergency) noexcept {
    const std::size_t at = mbx::HeaderSize + mbx::CoeHeaderSize;
    wire::store16(building_.bytes, mbx::HeaderSize, coeHeader(mbx::CoeService::Emergency));
    wire::store16(building_.bytes, at, emergency.code);
    building_.bytes[at + 2] = emergency.errorRegister;
    std::copy(emergency.data.begin(), emergency.data.end(), building_.bytes.begin() + at + 3);
    reply(static_cast<std::uint8_t>(mbx::Type::CoE), mbx::CoeHeaderSize + EmergencySize);
    post();
}

void MailboxServer::post() noexcept {
    if (waiting_.empty() || !syncManagers_.enabled(inBox_) || syncManagers_.full(inBox_)) return;
    last_ = waiting_.front();
    waiting_.popFront();
    if (last_.size > syncManagers_.length(inBox_)) return;
    syncManagers_.post(inBox_, {last_.bytes.data(), last_.size});
}

void MailboxServer::answerTaken() noexcept {
    post();
}

void MailboxServer::repeatLast() noexcept {
    if (!syncManagers_.full(inBox_) && last_.size > 0 &&
        last_.size <= syncManagers_.length(inBox_)) {
        syncManagers_.post(inBox_, {last_.bytes.data(), last_.size});
    }
    syncManagers_.acknowledgeRepeat(inBox_);
}

}  // namespace takt::twin
