#include "frame_set.hpp"

#include <algorithm>
#include <cassert>
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

}  // namespace

FrameSet::FrameSet(std::size_t maxFrames, std::size_t maxDatagrams)
    : frames_(maxFrames), slots_(maxFrames), slotOf_(maxFrames, NoReply), firstOf_(maxFrames + 1) {
    assert(maxFrames > 0 && maxFrames < NoReply);
    datagrams_.reserve(maxDatagrams);
}

void FrameSet::begin() noexcept {
    firstIndex_ = static_cast<std::uint8_t>(firstIndex_ + frameCount_);
    frameCount_ = 0;
    datagrams_.clear();
    writer_.reset();
    std::fill(slotOf_.begin(), slotOf_.end(), NoReply);
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
    if (!writer_ || datagrams_.size() == datagrams_.capacity()) return 0;
    return writer_->room();
}

std::uint8_t FrameSet::openIndex() const noexcept {
    return static_cast<std::uint8_t>(firstIndex_ + frameCount_ - 1);
}

DatagramId FrameSet::remember(wire::Command command, std::uint32_t address,
                              wire::DatagramPlace place) noexcept {
    const auto id = static_cast<DatagramId>(datagrams_.size());
    datagrams_.push_back({place, address, command, static_cast<std::uint8_t>(frameCount_ - 1)});
    return id;
}

DatagramId FrameSet::append(wire::Command command, std::uint16_t adp, std::uint16_t ado,
                            std::uint16_t length) noexcept {
    assert(length <= room());
    return remember(command, adp | (std::uint32_t{ado} << 16),
                    writer_->append(command, openIndex(), adp, ado, length));
}

DatagramId FrameSet::appendLogical(wire::Command command, std::uint32_t address,
                                   std::uint16_t length) noexcept {
    assert(length <= room());
    return remember(command, address,
                    writer_->appendLogical(command, openIndex(), address, length));
}

std::span<std::uint8_t> FrameSet::data(DatagramId id) noexcept {
    return writer_->data(datagrams_[id].place);
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

FrameSet::Verdict FrameSet::judge(wire::Frame& frame, std::size_t& which) const noexcept {
    wire::DatagramCursor cursor{frame.view()};
    if (cursor.malformed()) return Verdict::Foreign;
    if ((frame.bytes[6] & wire::SourceSeenBit) == 0) return Verdict::Foreign;
    if (!cursor.next()) return Verdict::Malformed;
    const std::uint8_t index = cursor.datagram().index();
    which = static_cast<std::uint8_t>(index - firstIndex_);
    if (which >= frameCount_) return Verdict::Late;
    if (slotOf_[which] != NoReply) return Verdict::Duplicate;
    const std::size_t end = firstOf_[which + 1];
    for (std::size_t i = firstOf_[which]; i < end; ++i) {
        const Sent& sent = datagrams_[i];
        const wire::DatagramView& got = cursor.datagram();
        const std::uint32_t fixed = positionCounts(sent.command) ? 0xFFFF0000U : 0xFFFFFFFFU;
        if (got.rawCommand() != static_cast<std::uint8_t>(sent.command) || got.index() != index ||
            got.data().size() != sent.place.length ||
            ((got.logicalAddress() ^ sent.address) & fixed) != 0) {
            return Verdict::Malformed;
        }
        const bool more = cursor.next();
        if (more != (i + 1 < end)) return Verdict::Malformed;
    }
    return cursor.malformed() ? Verdict::Malformed : Verdict::Accepted;
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
            slotOf_[which] = static_cast<std::uint8_t>(kept++);
        }
    }
    counters_.lost += frameCount_ - kept;
}

Reply FrameSet::reply(DatagramId id) const noexcept {
    const Sent& sent = datagrams_[id];
    const std::uint8_t slot = slotOf_[sent.frame];
    if (slot == NoReply) return {};
    const std::span<const std::uint8_t> bytes = slots_[slot].view();
    const std::size_t at = sent.place.dataOffset();
    const std::size_t end = at + sent.place.length;
    return {true, static_cast<std::uint16_t>(bytes[end] | (bytes[end + 1] << 8)),
            bytes.subspan(at, sent.place.length)};
}

}  // namespace takt::fieldbus::ethercat
