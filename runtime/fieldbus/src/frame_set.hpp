#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <takt/core/time.hpp>
#include <takt/wire/frame.hpp>
#include <takt/wire/link.hpp>
#include <vector>

namespace takt::fieldbus::ethercat {

/// What was received beside the expected replies; counts since the last reset.
struct FrameCounters {
    std::uint64_t sent{0};
    std::uint64_t lost{0};        ///< no reply by the deadline
    std::uint64_t late{0};        ///< reply to a frame of an earlier cycle
    std::uint64_t duplicate{0};   ///< a second reply to the same frame
    std::uint64_t malformed{0};   ///< length, command, index or address contradict what was sent
    std::uint64_t foreign{0};     ///< not EtherCAT, or seen by no device
    std::uint64_t sendFailed{0};  ///< the link refused the frames
};

/// Number of a datagram inside its FrameSet, counted from begin().
using DatagramId = std::uint16_t;

struct Reply {
    bool arrived{false};
    std::uint16_t workingCounter{0};
    std::span<const std::uint8_t> data{};

    [[nodiscard]] bool served() const noexcept { return arrived && workingCounter != 0; }
};

/// The frames of one exchange and their replies: put together, sent with one call, received with
/// one call, checked byte by byte against what was sent. All datagrams of a frame carry the frame's
/// own index.
///
///     frames.begin(); frames.openFrame();
///     auto id = frames.append(Command::Brd, 0, reg::AlStatus, 2);
///     frames.finish();
///     frames.send(link); frames.receive(link, deadline);
///     frames.reply(id)…
///
/// Frames that are sent again and again are put together once: begin, append…, keep. From then on
/// repeat() starts an exchange, and further datagrams go behind the kept ones for that exchange
/// only.
class FrameSet {
public:
    /// Allocates everything it will ever need.
    FrameSet(std::size_t maxFrames, std::size_t maxDatagrams);

    /// rt. Forgets the frames and replies of the last exchange.
    void begin() noexcept;
    /// Keeps what has been appended since begin() for all exchanges that are started with repeat().
    void keep() noexcept;
    /// rt. Starts the next exchange with the kept frames; their data are as they were left.
    void repeat() noexcept;
    /// rt. \return false when all frames are in use
    bool openFrame() noexcept;
    /// rt. Data bytes that a further datagram may have; 0 when no datagram can be added.
    [[nodiscard]] std::size_t room() const noexcept;
    [[nodiscard]] bool empty() const noexcept { return datagrams_.empty(); }
    /// rt. No further datagram can be added, whatever room the frames have.
    [[nodiscard]] bool full() const noexcept { return datagrams_.size() == datagrams_.capacity(); }

    /// rt. Data are zeros until filled through `data`. \pre length <= room()
    DatagramId append(wire::Command command, std::uint16_t adp, std::uint16_t ado,
                      std::uint16_t length) noexcept;
    /// rt. \pre length <= room()
    DatagramId appendLogical(wire::Command command, std::uint32_t address,
                             std::uint16_t length) noexcept;
    /// rt. Data of a datagram of this exchange.
    [[nodiscard]] std::span<std::uint8_t> data(DatagramId id) noexcept {
        const Sent& sent = datagrams_[id];
        return {&frames_[sent.frame].bytes[sent.dataAt], sent.length};
    }
    /// rt. Closes the last frame.
    void finish() noexcept;

    /// rt. Sends all frames with one call.
    wire::LinkStatus send(wire::Link& link) noexcept;
    /// rt. Waits for the replies; normally one call, a bounded number more when strays arrive.
    void receive(wire::Link& link, core::HostTime deadline) noexcept;
    /// rt. The reply to a datagram; its data are valid until the next begin().
    [[nodiscard]] Reply reply(DatagramId id) const noexcept {
        const Sent& sent = datagrams_[id];
        const std::uint8_t* bytes = replyOf_[sent.frame];
        if (bytes == nullptr) return {};
        const std::uint8_t* data = bytes + sent.dataAt;
        return {true,
                static_cast<std::uint16_t>(data[sent.length] | (data[sent.length + 1] << 8)),
                {data, sent.length}};
    }

    /// When the first frame left.
    [[nodiscard]] core::HostTime sentAt() const noexcept { return frames_.front().stamp; }
    [[nodiscard]] std::size_t frameCount() const noexcept { return frameCount_; }
    [[nodiscard]] const FrameCounters& counters() const noexcept { return counters_; }
    void resetCounters() noexcept { counters_ = {}; }

private:
    struct Sent {
        std::uint64_t fixed{0};  ///< bits of the first eight header bytes that no device changes
        std::uint16_t at{0};     ///< of the header inside the frame
        std::uint16_t dataAt{0};
        std::uint16_t length{0};  ///< of the data
        std::uint8_t frame{0};

        [[nodiscard]] std::size_t end() const noexcept {
            return std::size_t{dataAt} + length + wire::WorkingCounterSize;
        }
    };
    enum class Verdict : std::uint8_t { Accepted, Late, Duplicate, Malformed, Foreign };

    DatagramId remember(wire::Command command, wire::DatagramPlace place) noexcept;
    void reopen() noexcept;
    void countUp() noexcept;
    [[nodiscard]] std::uint8_t indexOf(std::size_t frame) const noexcept {
        return static_cast<std::uint8_t>(firstIndex_ + frame);
    }
    [[nodiscard]] bool reopenable() const noexcept {
        return !writer_ && frameCount_ != 0 && frameCount_ == keptFrames_;
    }
    [[nodiscard]] Verdict judge(const wire::Frame& frame, std::size_t& which) const noexcept;
    void count(Verdict verdict) noexcept;

    std::vector<wire::Frame> frames_;
    std::vector<wire::Frame> slots_;
    std::vector<const std::uint8_t*>
        replyOf_;  ///< for each frame the bytes of its reply, or nullptr
    std::vector<std::uint16_t>
        firstOf_;  ///< for each frame its first datagram; one more at the end
    std::vector<Sent> datagrams_;
    std::optional<wire::FrameWriter> writer_;
    std::size_t frameCount_{0};
    std::size_t keptFrames_{0};
    std::size_t keptDatagrams_{0};
    bool reopened_{false};  ///< the last kept frame has more in it than is kept
    std::uint8_t firstIndex_{0};
    FrameCounters counters_;
};

}  // namespace takt::fieldbus::ethercat
