#include "coe_server.hpp"

#include <algorithm>
#include <takt/core/cia402.hpp>
#include <takt/wire/byte_io.hpp>
#include <takt/wire/mailbox.hpp>

namespace takt::twin {

namespace abortcode = wire::abortcode;
namespace mbx = wire::mbx;

namespace {

using mbx::LastSegment;
using mbx::ToggleBit;

constexpr std::size_t DataAt = 4;  // of an expedited transfer or of the size of a normal one
constexpr std::size_t NormalDataAt = 8;
constexpr std::size_t SmallestSegment = 7;
constexpr std::uint32_t ToggleError = 0x05030000;
constexpr std::uint32_t OutOfMemory = 0x05040005;

// Client command specifiers: the top three bits of the command byte.
enum class Client : std::uint8_t {
    DownloadSegment = 0,
    Download = 1,
    Upload = 2,
    UploadSegment = 3,
    Abort = 4,
};

std::int64_t numberFrom(std::span<const std::uint8_t> data, bool isSigned) noexcept {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < data.size() && i < 8; ++i)
        value |= std::uint64_t{data[i]} << (8 * i);
    if (!isSigned || data.empty() || data.size() >= 8) return static_cast<std::int64_t>(value);
    const std::uint64_t sign = std::uint64_t{1} << (8 * data.size() - 1);
    return static_cast<std::int64_t>((value ^ sign) - sign);
}

std::size_t header(std::span<std::uint8_t> reply, std::uint8_t command, std::uint16_t index,
                   std::uint8_t subindex) noexcept {
    std::fill_n(reply.begin(), mbx::MinSdoSize, std::uint8_t{0});
    reply[0] = command;
    wire::store16(reply, 1, index);
    reply[3] = subindex;
    return mbx::MinSdoSize;
}

}  // namespace

std::size_t CoeServer::answer(std::span<const std::uint8_t> request, std::span<std::uint8_t> reply,
                              wire::AlState state) noexcept {
    switch (static_cast<Client>(request[0] >> 5)) {
        case Client::DownloadSegment:
            return continueDownload(request, reply, state);
        case Client::Download:
            return startDownload(request, reply, state);
        case Client::Upload:
            return startUpload(request, reply);
        case Client::UploadSegment:
            return continueUpload(request, reply);
        case Client::Abort:
            transfer_ = Transfer::None;
            return 0;
    }
    return abortTransfer(reply, wire::load16(request, 1), request[3], abortcode::UnknownCommand);
}

std::size_t CoeServer::abortTransfer(std::span<std::uint8_t> reply, std::uint16_t index,
                                     std::uint8_t subindex, std::uint32_t code) noexcept {
    transfer_ = Transfer::None;
    header(reply, mbx::Abort, index, subindex);
    wire::store32(reply, DataAt, code);
    return mbx::MinSdoSize;
}

std::uint32_t CoeServer::absence(std::uint16_t index) const noexcept {
    return dictionary_.contains(index) ? abortcode::NoSubindex : abortcode::NoObject;
}

std::size_t CoeServer::startDownload(std::span<const std::uint8_t> request,
                                     std::span<std::uint8_t> reply, wire::AlState state) noexcept {
    const std::uint8_t command = request[0];
    const std::uint16_t index = wire::load16(request, 1);
    const std::uint8_t subindex = request[3];
    transfer_ = Transfer::None;
    const bool whole = (command & mbx::CompleteAccess) != 0;
    if (whole && !completeAccess_) {
        return abortTransfer(reply, index, subindex, abortcode::NoCompleteAccess);
    }
    std::span<const std::uint8_t> data;
    if ((command & mbx::Expedited) != 0) {
        std::size_t size = 4;
        if ((command & mbx::SizeIndicated) != 0) {
            size -= (command >> 2) & 0x03U;
        } else if (const DictionaryEntry* entry = dictionary_.find(index, subindex)) {
            size = std::min<std::size_t>(4, entry->size);  // not told: the object's own length
        }
        data = request.subspan(DataAt, size);
    } else {
        const std::uint32_t size = wire::load32(request, DataAt);
        data = request.subspan(NormalDataAt);
        data = data.first(std::min<std::size_t>(data.size(), size));
        if (data.size() < size) {
            if (whole) return abortTransfer(reply, index, subindex, abortcode::TooLongForMailbox);
            if (size > LargestTransfer) return abortTransfer(reply, index, subindex, OutOfMemory);
            transfer_ = Transfer::Download;
            index_ = index;
            subindex_ = subindex;
            toggle_ = 0;
            size_ = size;
            done_ = data.size();
            std::copy(data.begin(), data.end(), buffer_.begin());
            return header(reply, mbx::DownloadResponse, index, subindex);
        }
    }
    const std::uint32_t code = whole ? downloadWhole(index, subindex, data, state)
                                     : download(index, subindex, data, state);
    if (code != 0) return abortTransfer(reply, index, subindex, code);
    return header(reply, mbx::DownloadResponse, index, subindex);
}

std::size_t CoeServer::continueDownload(std::span<const std::uint8_t> request,
                                        std::span<std::uint8_t> reply,
                                        wire::AlState state) noexcept {
    const std::uint8_t command = request[0];
    if (transfer_ != Transfer::Download) {
        return abortTransfer(reply, 0, 0, abortcode::UnknownCommand);
    }
    if ((command & ToggleBit) != toggle_)
        return abortTransfer(reply, index_, subindex_, ToggleError);
    std::size_t length = request.size() - 1;
    if (length <= SmallestSegment) length = SmallestSegment - ((command >> 1) & 0x07U);
    if (done_ + length > size_) {
        return abortTransfer(reply, index_, subindex_, abortcode::LengthTooHigh);
    }
    std::copy_n(request.begin() + 1, length, buffer_.begin() + static_cast<std::ptrdiff_t>(done_));
    done_ += length;
    const auto response = static_cast<std::uint8_t>(0x20 | toggle_);
    toggle_ ^= ToggleBit;
    if ((command & LastSegment) != 0) {
        if (done_ != size_) return abortTransfer(reply, index_, subindex_, abortcode::LengthTooLow);
        transfer_ = Transfer::None;
        if (const std::uint32_t code =
                download(index_, subindex_, {buffer_.data(), size_}, state)) {
            return abortTransfer(reply, index_, subindex_, code);
        }
    }
    return header(reply, response, 0, 0);
}

std::size_t CoeServer::startUpload(std::span<const std::uint8_t> request,
                                   std::span<std::uint8_t> reply) noexcept {
    const std::uint16_t index = wire::load16(request, 1);
    const std::uint8_t subindex = request[3];
    transfer_ = Transfer::None;
    if ((request[0] & mbx::CompleteAccess) != 0) {
        return abortTransfer(reply, index, subindex, abortcode::NoCompleteAccess);
    }
    const DictionaryEntry* entry = dictionary_.find(index, subindex);
    if (entry == nullptr) return abortTransfer(reply, index, subindex, absence(index));
    if (!entry->readable) return abortTransfer(reply, index, subindex, abortcode::WriteOnly);
    const auto value = dictionary_.bytes(*entry);
    if (!value.empty() && value.size() <= 4) {
        const std::size_t unused = 4 - value.size();
        header(reply, static_cast<std::uint8_t>(0x43 | (unused << 2)), index, subindex);
        std::copy(value.begin(), value.end(), reply.begin() + DataAt);
        return mbx::MinSdoSize;
    }
    if (value.size() > LargestTransfer) {
        return abortTransfer(reply, index, subindex, abortcode::TooLongForMailbox);
    }
    const std::size_t first = std::min(value.size(), reply.size() - NormalDataAt);
    header(reply, 0x41, index, subindex);
    wire::store32(reply, DataAt, static_cast<std::uint32_t>(value.size()));
    std::copy_n(value.begin(), first, reply.begin() + NormalDataAt);
    if (first < value.size()) {
        transfer_ = Transfer::Upload;
        index_ = index;
        subindex_ = subindex;
        toggle_ = 0;
        size_ = value.size();
        done_ = first;
        std::copy(value.begin(), value.end(), buffer_.begin());
    }
    return NormalDataAt + first;
}

std::size_t CoeServer::continueUpload(std::span<const std::uint8_t> request,
                                      std::span<std::uint8_t> reply) noexcept {
    if (transfer_ != Transfer::Upload) {
        return abortTransfer(reply, 0, 0, abortcode::UnknownCommand);
    }
    if ((request[0] & ToggleBit) != toggle_) {
        return abortTransfer(reply, index_, subindex_, ToggleError);
    }
    const std::size_t length = std::min(size_ - done_, reply.size() - 1);
    const bool last = done_ + length == size_;
    std::fill_n(reply.begin(), mbx::MinSdoSize, std::uint8_t{0});
    // The unused-bytes field counts only in a segment of the smallest size.
    const std::size_t unused = length < SmallestSegment ? SmallestSegment - length : 0;
    reply[0] = static_cast<std::uint8_t>(toggle_ | (unused << 1) | (last ? LastSegment : 0));
    std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(done_), length, reply.begin() + 1);
    done_ += length;
    toggle_ ^= ToggleBit;
    if (last) transfer_ = Transfer::None;
    return std::max(mbx::MinSdoSize, length + 1);
}

std::uint32_t CoeServer::checkValue(const DictionaryEntry& entry,
                                    std::span<const std::uint8_t> data) const noexcept {
    const std::int64_t value = numberFrom(data, entry.isSigned());
    if (entry.maximum && value > *entry.maximum) {
        return traits_.detailedRangeAborts ? abortcode::ValueTooHigh : abortcode::OutOfRange;
    }
    if (entry.minimum && value < *entry.minimum) {
        return traits_.detailedRangeAborts ? abortcode::ValueTooLow : abortcode::OutOfRange;
    }
    if (entry.index == core::cia402::ModesOfOperation && value != 0 &&
        !traits_.supportsMode(static_cast<std::int8_t>(value))) {
        return abortcode::OutOfRange;
    }
    if (entry.index == core::cia402::HomingMethod &&
        !traits_.supportsHoming(static_cast<std::int8_t>(value))) {
        return abortcode::OutOfRange;
    }
    return 0;
}

std::uint32_t CoeServer::download(std::uint16_t index, std::uint8_t subindex,
                                  std::span<const std::uint8_t> data,
                                  wire::AlState state) noexcept {
    const DictionaryEntry* entry = dictionary_.find(index, subindex);
    if (entry == nullptr) return absence(index);
    if (!entry->writable) return abortcode::ReadOnly;
    if (entry->isNumber() ? data.size() != entry->size : data.size() > entry->size) {
        return abortcode::LengthMismatch;
    }
    const bool inPreOp = state == wire::AlState::PreOp;
    if (PdoConfiguration::governs(index)) {
        return pdos_.write(index, subindex, static_cast<std::uint32_t>(numberFrom(data, false)),
                           inPreOp);
    }
    if (entry->onlyInPreOp && !inPreOp) return abortcode::WrongDeviceState;
    if (entry->isNumber()) {
        if (const std::uint32_t code = checkValue(*entry, data)) return code;
    }
    const auto value = dictionary_.bytes(*entry);
    const auto end = std::copy(data.begin(), data.end(), value.begin());
    std::fill(end, value.end(), std::uint8_t{0});
    return 0;
}

std::uint32_t CoeServer::downloadWhole(std::uint16_t index, std::uint8_t first,
                                       std::span<const std::uint8_t> data,
                                       wire::AlState state) noexcept {
    constexpr std::size_t countBytes = 2;  // sub-index 0 and what fills it up
    if (first > 1) return abortcode::NoSubindex;
    if (first == 0 && data.size() < countBytes) return abortcode::LengthTooLow;
    const bool governed = PdoConfiguration::governs(index);
    const auto count = first == 0 ? data.first(1) : std::span<const std::uint8_t>{};
    // Entries of PDOs may change only while their count is zero.
    constexpr std::array<std::uint8_t, 1> none{0};
    if (governed && !count.empty()) {
        if (const std::uint32_t code = download(index, 0, none, state)) return code;
    }
    std::size_t at = first == 0 ? countBytes : 0;
    for (unsigned sub = 1; sub <= 0xFF && at < data.size(); ++sub) {
        const auto subindex = static_cast<std::uint8_t>(sub);
        const DictionaryEntry* const entry = dictionary_.find(index, subindex);
        if (entry == nullptr || entry->size == 0) break;
        if (at + entry->size > data.size()) return abortcode::LengthTooLow;
        const auto value = data.subspan(at, entry->size);
        if (const std::uint32_t code = download(index, subindex, value, state)) return code;
        at += entry->size;
    }
    if (at < data.size()) return abortcode::LengthTooHigh;
    const DictionaryEntry* const counter = dictionary_.find(index, 0);
    const bool counted = !count.empty() && counter != nullptr && counter->writable;
    return counted ? download(index, 0, count, state) : 0;
}

}  // namespace takt::twin
