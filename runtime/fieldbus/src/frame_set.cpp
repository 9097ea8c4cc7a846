#include "frame_set.hpp"

#include <algorithm>
#include <cassert>
#include <takt/wire/byte_io.hpp>
#include <utility>

namespace takt::fieldbus::ethercat {

namespace {

constexpr std::size_t MaxStrays = 8;  ///< receive calls beyond the first; bounds a flood of strays

/// Devices count up the position in datagrams with position or broadcast addressing
/// (ETG.1000.4 5.4).
constexpr bool positionCounts(wire::Command command) noexcept {
    switch (command) {
        case wire::Command::Aprd:
        case wire::Command::Apwr:
        case wire::Command::Aprw:
        case wire::Command::Brd:
        case wire::Command::Bwr:
        case wire::Command::Brw:
        case wire::Command::Armw:
            return true;
        default:
            return false;
    }
}

// Of the first eight bytes of a datagram header (command, index, address, length) devices change
// the circulating bit and, in some commands, the position.
constexpr std::uint64_t FixedOfOthers = ~(std::uint64_t{1} << 62);
constexpr std::uint64_t FixedOfPosition = FixedOfOthers & ~std::uint64_t{0xFFFF'0000};

}  // namespace

FrameSet::FrameSet(std::size_t maxFrames, std::size_t maxDatagrams)
    : frames_(maxFrames), slots_(maxFrames), replyOf_(maxFrames, nullptr), firstOf_(maxFrames + 1) {
    assert(maxFrames > 0 && maxFrames < 256);
    datagrams_.reserve(maxDatagrams);
}

void FrameSet::countUp() noexcept {
    firstIndex_ = static_cast<std::uint8_t>(firstIndex_ + frameCount_);
    for (std::size_t i = 0; i < frameCount_; ++i) replyOf_[i] = nullptr;
}

void FrameSet::begin() noexcept {
    writer_.reset();
    countUp();
    frameCount_ = keptFrames_ = keptDatagrams_ = 0;
    reopened_ = false;
    datagrams_.clear();
}

void FrameSet::keep() noexcept {
    finish();
    keptFrames_ = frameCount_;
    keptDatagrams_ = datagrams_.size();
}

void FrameSet::repeat() noexcept {
    if (writer_) finish();
    countUp();
    frameCount_ = keptFrames_;
    if (datagrams_.size() != keptDatagrams_) datagrams_.resize(keptDatagrams_);
    for (const Sent& sent : datagrams_) {
        frames_[sent.frame].bytes[sent.at + 1U] = indexOf(sent.frame);
    }
    if (reopened_) {
        reopen();
        finish();
        reopened_ = false;
    }
    firstOf_[frameCount_] = static_cast<std::uint16_t>(keptDatagrams_);
}

void FrameSet::reopen() noexcept {
    const Sent& last = datagrams_[keptDatagrams_ - 1];
    writer_.emplace(frames_[frameCount_ - 1], wire::DatagramPlace{last.at, last.length});
    reopened_ = true;
}

bool FrameSet::openFrame() noexcept {
    if (frameCount_ == frames_.size()) return false;
    finish();
    writer_.emplace(frames_[frameCount_]);
    firstOf_[frameCount_] = static_cast<std::uint16_t>(datagrams_.size());
    ++frameCount_;
    return true;
}

std::size_t FrameSet::room() const noexcept {
    if (full()) return 0;
    if (writer_) return writer_->room();
    if (!reopenable()) return 0;
    const std::size_t used = datagrams_.back().end() + wire::DatagramOverhead;
    return used >= wire::MaxFrameSize ? 0 : wire::MaxFrameSize - used;
}

DatagramId FrameSet::remember(wire::Command command, wire::DatagramPlace place) noexcept {
    const auto id = static_cast<DatagramId>(datagrams_.size());
    const std::uint64_t fixed = positionCounts(command) ? FixedOfPosition : FixedOfOthers;
    datagrams_.push_back({fixed, place.offset, static_cast<std::uint16_t>(place.dataOffset()),
                          place.length, static_cast<std::uint8_t>(frameCount_ - 1)});
    return id;
}

DatagramId FrameSet::append(wire::Command command, std::uint16_t adp, std::uint16_t ado,
                            std::uint16_t length) noexcept {
    assert(length <= room());
    if (!writer_) reopen();
    return remember(command, writer_->append(command, indexOf(frameCount_ - 1), adp, ado, length));
}

DatagramId FrameSet::appendLogical(wire::Command command, std::uint32_t address,
                                   std::uint16_t length) noexcept {
    assert(length <= room());
    if (!writer_) reopen();
    return remember(command,
                    writer_->appendLogical(command, indexOf(frameCount_ - 1), address, length));
}

void FrameSet::finish() noexcept {
    if (writer_) writer_->finish();
    writer_.reset();
    firstOf_[frameCount_] = static_cast<std::uint16_t>(datagrams_.size());
}

wire::LinkStatus FrameSet::send(wire::Link& link) noexcept {
    const wire::LinkStatus status = link.send(std::span{frames_}.first(frameCount_));
    if (status == wire::LinkStatus::Ok) {
        counters_.sent += frameCount_;
    } else {
        ++counters_.sendFailed;
    }
    return status;
}

FrameSet::Verdict FrameSet::judge(const wire::Frame& frame, std::size_t& which) const noexcept {
    constexpr std::size_t etherTypeAt = 12;
    constexpr std::size_t firstDatagram = wire::EthernetHeaderSize + wire::EtherCatHeaderSize;
    const std::span<const std::uint8_t> got = frame.view();
    if (got.size() < firstDatagram + wire::DatagramOverhead) return Verdict::Foreign;
    if (got[etherTypeAt] != wire::EtherType >> 8 ||
        got[etherTypeAt + 1] != (wire::EtherType & 0xFF)) {
        return Verdict::Foreign;
    }
    if ((got[6] & wire::SourceSeenBit) == 0) return Verdict::Foreign;
    which = static_cast<std::uint8_t>(got[firstDatagram + 1] - firstIndex_);
    if (which >= frameCount_) return Verdict::Late;
    if (replyOf_[which] != nullptr) return Verdict::Duplicate;
    // A reply has the layout of the request, so that nothing in it needs to be trusted.
    const Sent* const first = &datagrams_[firstOf_[which]];
    const Sent* const last = &datagrams_[firstOf_[which + 1] - 1U];
    const std::span<const std::uint8_t> sent{frames_[which].bytes};
    if (got.size() < last->end() || wire::load16(got, wire::EthernetHeaderSize) !=
                                        wire::load16(sent, wire::EthernetHeaderSize)) {
        return Verdict::Malformed;
    }
    std::uint64_t different = 0;
    for (const Sent* datagram = first; datagram <= last; ++datagram) {
        different |=
            (wire::load64(got, datagram->at) ^ wire::load64(sent, datagram->at)) & datagram->fixed;
    }
    return different == 0 ? Verdict::Accepted : Verdict::Malformed;
}

void FrameSet::count(Verdict verdict) noexcept {
    switch (verdict) {
        case Verdict::Accepted:
            break;
        case Verdict::Late:
            ++counters_.late;
            break;
        case Verdict::Duplicate:
            ++counters_.duplicate;
            break;
        case Verdict::Malformed:
            ++counters_.malformed;
            break;
        case Verdict::Foreign:
            ++counters_.foreign;
            break;
    }
}

void FrameSet::receive(wire::Link& link, core::HostTime deadline) noexcept {
    std::size_t kept = 0;
    for (std::size_t round = 0; kept < frameCount_ && round <= MaxStrays; ++round) {
        const std::span<wire::Frame> free = std::span{slots_}.subspan(kept, frameCount_ - kept);
        const std::size_t got = std::min(link.receive(free, deadline), free.size());
        if (got == 0) break;
        const std::size_t end = kept + got;
        for (std::size_t i = kept; i < end; ++i) {
            std::size_t which = 0;
            const Verdict verdict = judge(slots_[i], which);
            count(verdict);
            if (verdict != Verdict::Accepted) continue;
            // Kept replies stay in front, so that the free slots are one span.
            if (i != kept) std::swap(slots_[i], slots_[kept]);
            replyOf_[which] = slots_[kept++].bytes.data();
        }
    }
    counters_.lost += frameCount_ - kept;
}

}  // namespace takt::fieldbus::ethercat
